#include "devices/mouse/pointer.h"

#include <algorithm>

namespace passung::mouse {

Vec3 shortened(const Vec3& v, double longest) noexcept {
    const double length = v.norm();
    return length > longest ? Vec3((longest / length) * v) : v;
}

void Pointer::place(const Pose& X_W) {
    const std::lock_guard lock(mutex_);
    X_W_ = X_W;
    box_.put(X_W_);
}

void Pointer::move(const Vec3& way, const Vec3& turn) {
    const std::lock_guard lock(mutex_);
    X_W_.p += way;
    X_W_.q = (rotationFromVector(turn) * X_W_.q).normalized();
    box_.put(X_W_);
}

void Pointer::drive(const Vec3& speed, const Vec3& spin) {
    const std::lock_guard lock(mutex_);
    speed_ = speed;
    spin_ = spin;
    held_ = speed.isZero(0.0) && spin.isZero(0.0) ? 0.0 : kHeld;
}

void Pointer::pass(double seconds) {
    const std::lock_guard lock(mutex_);
    const double moved = std::min(seconds, held_);
    if (!(moved > 0.0)) return;
    held_ -= moved;
    X_W_.p += moved * speed_;
    X_W_.q = (rotationFromVector(moved * spin_) * X_W_.q).normalized();
    box_.put(X_W_);
}

void Pointer::keepNear(const Pose& X_W, double reach, double swing) {
    const std::lock_guard lock(mutex_);
    const Vec3 away = X_W_.p - X_W.p;
    const Vec3 turned = rotationVector(X_W_.q * X_W.q.conjugate());
    if (away.norm() <= reach && turned.norm() <= swing) return;
    X_W_.p = X_W.p + shortened(away, reach);
    X_W_.q = (rotationFromVector(shortened(turned, swing)) * X_W.q).normalized();
    box_.put(X_W_);
}

}  // namespace passung::mouse
