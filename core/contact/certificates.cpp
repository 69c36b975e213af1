#include "core/contact/certificates.h"

#include <algorithm>
#include <cmath>

namespace passung::contact {

namespace {

constexpr double kDeepAccuracy = 0.1;  // of φ: FieldAccuracy::depth
constexpr double kRounding = 1e-15;    // of a way in double precision [m]

}  // namespace

void Certificates::restart(double accuracy, const field::ReadChange& change) noexcept {
    accuracy_ = accuracy;
    change_ = change;
    deepest = kNone;
    if (look_ > 0) look_ += 2 * kPoses;  // all earlier looks are too long ago
}

void Certificates::begin(const Pose& X_FS) noexcept {
    if (spheres_.empty()) return;
    const View view{X_FS.q.toRotationMatrix(), X_FS.p};
    const View& last = views_[look_ % kPoses];
    if (look_ > 0 && last.R == view.R && last.p == view.p) return;
    ++look_;
    views_[look_ % kPoses] = view;
}

const Certificates::Change& Certificates::changeSince(std::uint32_t look) noexcept {
    Change& change = changes_[look % kPoses];
    if (change.until == look_) return change;
    const View &then = views_[look % kPoses], &now = views_[look_ % kPoses];
    change.by = {now.R - then.R, now.p - then.p};
    change.turn = std::sqrt(0.5) * change.by.R.norm() * (1.0 + 1e-12);
    change.until = look_;
    return change;
}

/// No point of a sphere has moved farther.
double Certificates::waySince(std::uint32_t look, const Vec3& centre, double radius) noexcept {
    const Change& change = changeSince(look);
    return (change.by.R * centre + change.by.p).norm() + change.turn * radius + kRounding;
}

bool Certificates::above(std::uint32_t i, const Vec3& centre, double radius, double limit) noexcept {
    if (spheres_.empty()) return false;
    Sphere& sphere = spheres_[i];
    if (sphere.look == 0 || look_ - sphere.look >= kPoses) return false;
    const double left = sphere.proven - limit - std::max(accuracy_, kDeepAccuracy * std::abs(limit));
    if (!(left > 0.0)) return false;
    if (sphere.look == look_) return true;
    const double way = waySince(sphere.look, centre, radius);
    if (!(left > way)) return false;
    if (look_ - sphere.look < kPoses / 2) return true;
    sphere.proven -= way;
    sphere.look = look_;
    return true;
}

void Certificates::note(std::uint32_t i, double least) noexcept {
    if (spheres_.empty()) return;
    spheres_[i].proven = least;
    spheres_[i].look = look_;
}

bool Certificates::paysToProve(std::uint32_t i, const Vec3& centre, double radius, double least,
                               double limit) noexcept {
    if (spheres_.empty()) return false;
    const double left = least - limit - 2.0 * std::max(accuracy_, kDeepAccuracy * std::abs(limit));
    const Sphere& sphere = spheres_[i];
    if (!(left > 0.0) || (sphere.tried != 0 && look_ - sphere.tried < kPatience)) return false;
    return look_ < 2 || left > waySince(look_ - 1, centre, radius);
}

void Certificates::noteProof(std::uint32_t i, double least, double limit) noexcept {
    note(i, least);
    const double needed = limit + std::max(accuracy_, kDeepAccuracy * std::abs(limit));
    spheres_[i].tried = least > needed ? 0 : look_;
}

void Certificates::noteRead(std::uint32_t i, double least) noexcept {
    if (spheres_.empty()) return;
    spheres_[i].read = least;
    spheres_[i].read_look = look_;
}

bool Certificates::readsWithin(std::uint32_t i, const Vec3& centre, double radius, double low, double high) noexcept {
    if (spheres_.empty()) return false;
    const Sphere& sphere = spheres_[i];
    if (sphere.read_look == 0 || look_ - sphere.read_look >= kPoses) return false;
    const auto isWithin = [&](double way) {
        return change_.leastAround(sphere.read, way) > std::max(low, 0.0) &&
               (std::isinf(high) || change_.mostAround(sphere.read, way) < high);
    };
    if (!isWithin(0.0)) return false;
    return sphere.read_look == look_ || isWithin(waySince(sphere.read_look, centre, radius));
}

double Certificates::provableFrom(double limit) const noexcept {
    return limit + 2.0 * std::max(accuracy_, kDeepAccuracy * std::abs(limit));
}

}  // namespace passung::contact
