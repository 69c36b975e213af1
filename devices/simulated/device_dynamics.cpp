// One substep of h for translation (rotation alike, with small rotation vectors): the linear part
//     M v' = F + k (x_set - x) - (b + b_h) v,      M = device + hand,
// by the trapezoidal rule, which is exact for a constant force, keeps a spring's energy and is stable for every k:
//     u = (v_old + v_new)/2,  (2M/h + b + b_h + k h/2) u = 2M/h v_old + F + k (x_set - x_old),
//     x_new = x_old + h u,    v_new = 2 u - v_old.
// Dry friction follows as a separate shrink of the speed by h f_c/M, never below zero: it can only take energy away.
// A handle at rest stays exactly where it is while the other forces do not exceed f_c (no creep).
// What the hand puts into the handle follows from the mechanism's own balance, all of it exact for the substep:
//     E += m_d (v_new² - v_old²)/2 + b u² h + D - F_motor u h,    D what dry friction took, M (u's v_new² - v_new²)/2.
// Beyond the workspace, a ball of radius R about the base's origin, the mechanism's end stop pushes back along the
// radius r with  k_s (|x| - R) + b_s max(0, v·r), never outwards; it counts as a motor's force in that balance.
// Within the ball no bit is another than without it.
// Limits: f_c = k = 0: v decays as exp(-b t/M) to O(h²); b = k = 0 with friction alone: stops after v² M/(2 f_c).
#include "devices/simulated/device_dynamics.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

constexpr int kSubsteps = 4;
constexpr double kStep = kTickSeconds / kSubsteps;
constexpr double kStopStiffness = 20000.0;  // [N/m], proposed here: far stiffer than a hand
constexpr double kStopDamping = 1.0;        // per sqrt(k m): half of critical, proposed here

struct Axis {
    double mass, damping, coulomb;  // of the mechanism
    double hand_mass, hand_damping, hand_stiffness;
};

// Advances the velocity and returns the displacement; adds what the hand put in to `from_hand`. `motors` and `muscles`
// exclude spring and damper, `error` = set-point - position.
Vec3 advanceVelocity(const Axis& a, const Vec3& motors, const Vec3& muscles, const Vec3& error, Vec3& v,
                     double& from_hand) noexcept {
    const Vec3 driving = motors + muscles + a.hand_stiffness * error;
    if (v.isZero(0.0) && driving.norm() <= a.coulomb) return Vec3::Zero();
    const double mass = a.mass + a.hand_mass;
    const double inertial = 2.0 * mass / kStep;
    const Vec3 u =
        (inertial * v + driving) / (inertial + (a.damping + a.hand_damping) + 0.5 * a.hand_stiffness * kStep);
    const double before = v.squaredNorm();
    v = 2.0 * u - v;
    const double speed = v.norm();
    const double loss = kStep * a.coulomb / mass;
    v = speed > loss ? Vec3((1.0 - loss / speed) * v) : Vec3(Vec3::Zero());
    const double after = v.squaredNorm();
    from_hand += 0.5 * a.mass * (after - before) + kStep * a.damping * u.squaredNorm() +
                 0.5 * mass * (speed * speed - after) - kStep * motors.dot(u);
    return kStep * u;
}

/// Of the end stop; @pre x is outside the ball of `radius`.
Vec3 endStop(const Vec3& x, const Vec3& v, double radius, double mass) noexcept {
    const double distance = x.norm();
    const Vec3 outward = x / distance;
    const double damping = kStopDamping * std::sqrt(kStopStiffness * mass);
    return -(kStopStiffness * (distance - radius) + damping * std::max(0.0, v.dot(outward))) * outward;
}

Vec3 rounded(const Vec3& v, double quantum) noexcept {
    if (!(quantum > 0)) return v;
    return {std::round(v.x() / quantum) * quantum, std::round(v.y() / quantum) * quantum,
            std::round(v.z() / quantum) * quantum};
}

Vec3 shortened(const Vec3& v, double limit) noexcept {
    const double n = v.norm();
    return n > limit ? Vec3((limit / n) * v) : v;
}

}  // namespace

DeviceDynamics::DeviceDynamics(const DeviceParams& params, const Pose& X_BDHome)
    : params_(params), X_BDHome_(X_BDHome), X_BD_(X_BDHome) {
    PASSUNG_ASSERT(params.validate().empty());
}

Wrench DeviceDynamics::limited(const Wrench& wrench) const noexcept {
    if (!isFinite(wrench)) return {};
    const bool turns = params_.actuated_degrees == 6;
    return {shortened(wrench.force, params_.max_force.value),
            turns ? shortened(wrench.torque, params_.max_torque.value) : Vec3(Vec3::Zero())};
}

void DeviceDynamics::command(const Wrench& F_D_B) noexcept { pending_[next_] = limited(F_D_B); }

void DeviceDynamics::advance(const HandCoupling& hand) noexcept {
    const std::size_t size = pending_.size();
    acting_ = pending_[(next_ + size - static_cast<std::size_t>(params_.delay_ticks)) % size];
    // Without a new command the motors keep the last one.
    const Wrench last = pending_[next_];
    next_ = (next_ + 1) % size;
    pending_[next_] = last;

    const double held = hand.attached ? 1.0 : 0.0;
    const Axis linear{params_.mass.value, params_.damping.value, params_.coulomb_force.value,
                      held * hand.mass,   held * hand.damping,   held * hand.stiffness};
    const Axis angular{params_.inertia.value, params_.rotational_damping.value, params_.coulomb_torque.value,
                       held * hand.inertia,   held * hand.rotational_damping,   held * hand.rotational_stiffness};
    const Wrench muscles{held * hand.F_D_B.force, held * hand.F_D_B.torque};
    for (int i = 0; i < kSubsteps; ++i) {
        Vec3 motors = acting_.force;
        if (X_BD_.p.squaredNorm() > params_.workspace_radius.value * params_.workspace_radius.value)
            motors += endStop(X_BD_.p, V_BD_B_.v, params_.workspace_radius.value, linear.mass + linear.hand_mass);
        X_BD_.p += advanceVelocity(linear, motors, muscles.force, hand.X_BSet.p - X_BD_.p, V_BD_B_.v, hand_energy_);
        if (params_.sensed_degrees == 6) {
            const Vec3 error = rotationVector(hand.X_BSet.q * X_BD_.q.conjugate());
            const Vec3 turn = advanceVelocity(angular, acting_.torque, muscles.torque, error, V_BD_B_.w, hand_energy_);
            X_BD_.q = (rotationFromVector(turn) * X_BD_.q).normalized();
        }
    }
}

Pose DeviceDynamics::readPose() const noexcept {
    const Vec3 p = X_BDHome_.p + rounded(X_BD_.p - X_BDHome_.p, params_.quantum.value);
    const Vec3 turned = rounded(rotationVector(X_BD_.q * X_BDHome_.q.conjugate()), params_.rotational_quantum.value);
    return {(rotationFromVector(turned) * X_BDHome_.q).normalized(), p};
}

}  // namespace passung::simulated
