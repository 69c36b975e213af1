#include "core/tick/inertia.h"

#include <algorithm>

namespace passung::tick {

namespace {

/// A damper over a tick as a spring, over the coupling's stiffness.
double dampingPerStiffness(double damping, double stiffness) noexcept {
    return stiffness > 0.0 ? damping / (stiffness * kTickSeconds) : 0.0;
}

/// Where a damper of `share` of the spring draws to, of how far it was stretched.
double drawnBack(double share) noexcept { return share / (1.0 + share); }

void noteMotion(const HandModel& model, const HandSample& hand, const Pose& X_WG, Moving& moving) noexcept {
    moving.on = {};
    if (moving.has_before && !hand.relocated)
        moving.on = {X_WG * model.centre - moving.X_WG_before * model.centre,
                     rotationVector(X_WG.q * moving.X_WG_before.q.conjugate())};
    moving.X_WG_before = X_WG;
    moving.has_before = true;
}

}  // namespace

motion::Momentum momentumOf(const HandModel& model, const Moving& moving, const Pose& X_WG) noexcept {
    const double per_stiffness = model.effects.inertia.scale / (model.contact.stiffness * kTickSeconds * kTickSeconds);
    motion::Momentum momentum{per_stiffness * model.mass, per_stiffness * model.moments, X_WG};
    Pose& X_WA = momentum.X_WA;
    X_WA.q = (rotationFromVector(moving.on.w) * X_WG.q).normalized();
    X_WA.p = X_WG * model.centre + moving.on.v - X_WA.q * model.centre;
    return momentum;
}

motion::Pull pullOf(const HandModel& model, std::span<const Vec3> held, const motion::Momentum& momentum) noexcept {
    const scene::ContactSpec& c = model.contact;
    motion::Pull pull{.count = static_cast<int>(held.size()), .p_GM = model.centre, .momentum = momentum};
    for (std::size_t i = 0; i < held.size(); ++i) pull.springs[i].p_GC = held[i];
    pull.spring = 1.0 + dampingPerStiffness(c.damping, c.stiffness);
    pull.turn = model.metric_radius * model.metric_radius *
                (1.0 + dampingPerStiffness(c.rotational_damping, c.rotational_stiffness));
    return pull;
}

Pose drawnTo(const HandModel& model, const Stretch& stretch, const Vec3& p_GC, const Pose& X_WR,
             const Pose& X_WG) noexcept {
    const scene::ContactSpec& c = model.contact;
    const bool known = stretch.has_last_stretch;
    const Vec3 e = known ? stretch.last_stretch : Vec3(X_WG * p_GC - X_WR * p_GC);
    const Vec3 twist = known ? stretch.last_twist : rotationVector(X_WG.q * X_WR.q.conjugate());
    Pose X = X_WR;
    X.q = (rotationFromVector(drawnBack(dampingPerStiffness(c.rotational_damping, c.rotational_stiffness)) * twist) *
           X_WR.q)
              .normalized();
    X.p = X_WR * p_GC + drawnBack(dampingPerStiffness(c.damping, c.stiffness)) * e - X.q * p_GC;
    return X;
}

void tellInertia(const HandModel& model, const HandSample& hand, const Grip& grip, const HeldTarget& target,
                 const Proxy& proxy, const Pushes& pushes, Moving& moving, HandWrench& wrench,
                 InertiaShare& added) noexcept {
    noteMotion(model, hand, proxy.X_WG, moving);
    added.of_inertia = Wrench{};
    if (grip.shared || !hand.input_usable) return;
    Wrench contact;
    const auto add = [&contact](const Wrench& push) {
        contact.force += push.force;
        contact.torque += push.torque;
    };
    for (const std::uint32_t i : pushes.pushes.held()) add(pushes.pushes[i].wrench);
    for (const std::uint32_t i : target.from_hands.held()) add(target.from_hands[i].wrench);
    added.of_inertia = {wrench.F_H_W.force - contact.force, wrench.F_H_W.torque - contact.torque};
    wrench.F_H_W = contact;
}

}  // namespace passung::tick
