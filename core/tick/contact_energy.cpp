#include "core/tick/contact_energy.h"

#include <algorithm>

namespace passung::tick {

namespace {

/// Adds a force and torque of an obstacle, about the held part's origin, in world axes.
void add(ObstaclePush& push, const Wrench& more, double pressure) noexcept {
    push.wrench.force += more.force;
    push.wrench.torque += more.torque;
    push.pressure += pressure;
}

}  // namespace

void clearPushes(Pushes& pushes) noexcept { pushes.pushes.clear(); }

void addPush(const HandModel& model, const Vec3& p_WG, const Vec3& point, const Vec3& along, double pressure,
             ObstaclePush& of) noexcept {
    const double turn = model.contact.rotational_stiffness / (model.metric_radius * model.metric_radius);
    add(of, {model.contact.stiffness * along, turn * (point - p_WG).cross(along)}, pressure);
}

void notePushes(const HandModel& model, const Proxy& proxy, const motion::ConstrainedMotion& motion,
                const motion::FrictionPatches& rubbing, Pushes& pushes) noexcept {
    clearPushes(pushes);
    const double K = model.contact.stiffness;
    const double turn = model.contact.rotational_stiffness / (model.metric_radius * model.metric_radius);
    for (int i = 0; i < motion.active; ++i) {
        const motion::ActiveContact& held = motion.active_contacts[static_cast<std::size_t>(i)];
        const contact::ContactPoint& contact = proxy.manifold[held.contact];
        const Vec3 push = held.push * contact.gradient.normalized();
        addPush(model, proxy.X_WG.p, contact.position, push, K * held.push, pushes.pushes[contact.obstacle]);
    }
    for (int p = 0; p < rubbing.count; ++p) {
        const motion::FrictionPatch& patch = rubbing.patch[static_cast<std::size_t>(p)];
        const Vec3 impulse = motion::impulseAlong(patch);
        const Vec3 torsion = patch.radius * patch.impulse.z() * patch.normal;
        add(pushes.pushes[patch.obstacle],
            {K * impulse, turn * ((patch.centre - proxy.X_WG.p).cross(impulse) + torsion)}, 0.0);
    }
}

void sharePushes(const HandModel&, const HandSample& hand, const HandWrench& wrench, Pushes& pushes) noexcept {
    if (!hand.input_usable) clearPushes(pushes);
    double pressure = 0.0;
    Wrench rest = wrench.F_H_W;
    for (const std::uint32_t i : pushes.pushes.held()) {
        const ObstaclePush& push = pushes.pushes[i];
        pressure += push.pressure;
        rest.force -= push.wrench.force;
        rest.torque -= push.wrench.torque;
    }
    if (!(pressure > 0.0)) return;
    for (const std::uint32_t i : pushes.pushes.held()) {
        ObstaclePush& push = pushes.pushes[i];
        const double share = push.pressure / pressure;
        push.wrench.force += share * rest.force;
        push.wrench.torque += share * rest.torque;
    }
}

void addHeldPushes(const HandModel&, const HeldTarget& target, Pushes& pushes) noexcept {
    for (const std::uint32_t i : target.from_hands.held())
        add(pushes.pushes[i], target.from_hands[i].wrench, target.from_hands[i].pressure);
}

void bookPairs(EnergyAccounts& accounts, const Vec3& moved, const Vec3& turned, int ticks) noexcept {
    for (const std::uint32_t i : accounts.pairs.held()) {
        PairAccount& pair = accounts.pairs[i];
        pair.taken_in -= (pair.sent.force.dot(moved) + pair.sent.torque.dot(turned)) / ticks;
        pair.least = std::min(pair.least, pair.taken_in);
    }
}

}  // namespace passung::tick
