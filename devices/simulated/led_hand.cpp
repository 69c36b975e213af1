#include "devices/simulated/led_hand.h"

#include <algorithm>

#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

// Speed of giving way per force and torque: with what is felt 0.13 s late a spring of a kilonewton a metre, or of some
// newton metres a radian, draws the hand without swinging. Proposed here, not measured.
constexpr double kYield = 1.0 / 200.0;    // [m/s/N]
constexpr double kTurnYield = 1.0 / 1.0;  // [rad/s/(N·m)]
constexpr double kUnfelt = 0.15;          // [N] that nobody gives way to: friction, tremor
constexpr double kUnfeltTorque = 5e-3;    // [N·m]
constexpr double kFastest = 0.08;         // [m/s]

/// What of `v` is more than `unfelt`.
Vec3 beyond(const Vec3& v, double unfelt) noexcept {
    const double size = v.norm();
    return size > unfelt ? Vec3((1.0 - unfelt / size) * v) : Vec3::Zero();
}

}  // namespace

void LedHand::choose(const Percept& percept) noexcept {
    if (!percept.go) {
        X_WRef_ = reach_.at(t_);
        if (t_ >= reach_.duration) removeOffset(percept);
        return;
    }
    const Wrench& felt = percept.F_felt;
    const Vec3 lever = registration_.X_WB * registration_.handleFromPart(percept.X_WFelt).p - percept.X_WFelt.p;
    const Vec3 v = kYield * beyond(felt.force, kUnfelt);
    const Vec3 w = kTurnYield * beyond(felt.torque + lever.cross(felt.force), kUnfeltTorque);
    X_WRef_.p += kTickSeconds * (v.norm() > kFastest ? Vec3(kFastest / v.norm() * v) : v);
    X_WRef_.q = (rotationFromVector(kTickSeconds * w) * X_WRef_.q).normalized();
}

}  // namespace passung::simulated
