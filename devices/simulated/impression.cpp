#include "devices/simulated/impression.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

constexpr double kFeltForce = 0.5;  // [N] from which on a contact is judged; proposed here
constexpr double kSettling = 0.5;   // [s] in which the hand gives way to a force; proposed here
constexpr std::int64_t kSettlingTicks = static_cast<std::int64_t>(kSettling / kTickSeconds + 0.5);
constexpr std::int64_t kWaveTicks = static_cast<std::int64_t>(1.0 / (kShakes * kTickSeconds) + 0.5);
constexpr double kOmega = 2.0 * std::numbers::pi * kShakes;  // [rad/s]

}  // namespace

void Impression::learn(const Vec3& p, const Vec3& force) noexcept {
    switch (quantity_) {
        case Quantity::Stiffness:
        case Quantity::Roughness:
            learnContact(-p.z(), force);
            break;
        case Quantity::Force:
            if (ticks_ >= kSettlingTicks) {
                force_sum_ += force;
                count_ += 1.0;
            }
            break;
        case Quantity::Viscosity:
            learnWave(p.z(), force.z());
            break;
        case Quantity::Inertia:
            learnWave(p.x(), force.x());
            break;
        case Quantity::Position:
            break;
    }
    ++ticks_;
}

void Impression::learnContact(double depth, const Vec3& force) noexcept {
    if (force.z() < kFeltForce) return;
    count_ += 1.0;
    way_ += depth;
    force_ += force.z();
    way_way_ += depth * depth;
    way_force_ += depth * force.z();
    if (count_ > 1.0) {
        changes_ += 1.0;
        change_square_ += (force - last_force_).squaredNorm();
    }
    last_force_ = force;
}

void Impression::learnWave(double x, double force) noexcept {
    const double phase = kOmega * kTickSeconds * static_cast<double>(ticks_ % kWaveTicks);
    running_.x_cos += x * std::cos(phase);
    running_.x_sin += x * std::sin(phase);
    running_.f_cos += force * std::cos(phase);
    running_.f_sin += force * std::sin(phase);
    if ((ticks_ + 1) % kWaveTicks != 0) return;
    if (ticks_ >= kWaveTicks) {
        whole_.x_cos += running_.x_cos;
        whole_.x_sin += running_.x_sin;
        whole_.f_cos += running_.f_cos;
        whole_.f_sin += running_.f_sin;
    }
    running_ = {};
}

double Impression::slope() const noexcept {
    const double spread = count_ * way_way_ - way_ * way_;
    return spread > 0.0 ? std::max(0.0, (count_ * way_force_ - way_ * force_) / spread) : 0.0;
}

/// With X = x_cos - i x_sin and F likewise: F / X = -k - iωc + ω²m.
double Impression::answerOfWaves() const noexcept {
    const auto& w = whole_;
    const double square = w.x_cos * w.x_cos + w.x_sin * w.x_sin;
    if (!(square > 0.0)) return 0.0;
    const double in_phase = (w.f_cos * w.x_cos + w.f_sin * w.x_sin) / square;
    const double behind = (w.f_sin * w.x_cos - w.f_cos * w.x_sin) / square;
    return std::max(0.0, quantity_ == Quantity::Inertia ? in_phase / (kOmega * kOmega) : behind / kOmega);
}

double Impression::value() const noexcept {
    switch (quantity_) {
        case Quantity::Stiffness:
            return slope();
        case Quantity::Roughness:
            return changes_ > 0.0 ? std::sqrt(change_square_ / changes_) : 0.0;
        case Quantity::Force:
            return count_ > 0.0 ? (force_sum_ / count_).norm() : 0.0;
        case Quantity::Viscosity:
        case Quantity::Inertia:
            return answerOfWaves();
        case Quantity::Position:
            return value_;
    }
    return 0.0;
}

}  // namespace passung::simulated
