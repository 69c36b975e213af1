#include "core/tick/contact_energy.h"

#include <algorithm>

#include "core/tick/weight.h"

namespace passung::tick {

namespace {

/// Adds a force and torque of an obstacle, about the held part's origin, in world axes.
void add(ObstaclePush& push, const Wrench& more, double pressure) noexcept {
    push.wrench.force += more.force;
    push.wrench.torque += more.torque;
    push.pressure += pressure;
}

/// What the coupling makes of a push: about the held part's origin.
class CouplingPush {
public:
    CouplingPush(const HandModel& model, const HeldTarget& target, const Pose& X_WG) noexcept
        : K_(target.springs == 1 ? model.contact.stiffness * target.stiffness : 0.0),
          turn_(target.springs == 1 ? turnOf(model, target) : 0.0),
          centre_(target.metric.centre(X_WG)),
          lever_(centre_ - X_WG.p) {}

    /// Of K times `along` at `point`, and of `torsion` times K [m²].
    Wrench at(const Vec3& point, const Vec3& along, const Vec3& torsion = Vec3::Zero()) const noexcept {
        const Vec3 force = K_ * along;
        return {force, turn_ * ((point - centre_).cross(along) + torsion) + lever_.cross(force)};
    }

    Wrench of(const motion::FrictionPatch& patch) const noexcept {
        return at(patch.centre, motion::impulseAlong(patch), patch.radius * patch.impulse.z() * patch.normal);
    }

private:
    /// Of what contacts turn the part by, over the levers' share: shown as far as the coupling turns the hand.
    static double turnOf(const HandModel& model, const HeldTarget& target) noexcept {
        const double turns = model.contact.rotational_stiffness;
        if (!target.isPulled()) return turns / (target.metric.radius * target.metric.radius);
        return turns > 0.0 ? model.contact.stiffness * target.stiffness : 0.0;
    }

    double K_, turn_;
    Vec3 centre_, lever_;
};

}  // namespace

void clearPushes(Pushes& pushes) noexcept { pushes.pushes.clear(); }

void addPush(const HandModel& model, const HeldTarget& target, const Pose& X_WG, const Vec3& point, const Vec3& along,
             double pressure, ObstaclePush& of) noexcept {
    const CouplingPush push(model, target, X_WG);
    add(of, push.at(point, along), pressure);
}

void addRub(const HandModel& model, const HeldTarget& target, const Pose& X_WG, const motion::FrictionPatch& patch,
            ObstaclePush& of) noexcept {
    add(of, CouplingPush(model, target, X_WG).of(patch), 0.0);
}

void notePushes(const HandModel& model, const HeldTarget& target, const Proxy& proxy,
                const motion::ConstrainedMotion& motion, const motion::FrictionPatches& rubbing,
                Pushes& pushes) noexcept {
    clearPushes(pushes);
    const CouplingPush push(model, target, proxy.X_WG);
    for (int i = 0; i < motion.active; ++i) {
        const motion::ActiveContact& held = motion.active_contacts[static_cast<std::size_t>(i)];
        const contact::ContactPoint& contact = proxy.manifold[held.contact];
        add(pushes.pushes[contact.obstacle], push.at(contact.position, held.push * contact.gradient.normalized()),
            model.contact.stiffness * target.stiffness * held.push);
    }
    for (int p = 0; p < rubbing.count; ++p) {
        const motion::FrictionPatch& patch = rubbing.patch[static_cast<std::size_t>(p)];
        add(pushes.pushes[patch.obstacle], push.of(patch), 0.0);
    }
}

void sharePushes(const HandModel& model, const HandSample& hand, const Grip& grip, const HandWrench& wrench,
                 const TransientsShare& transients, Pushes& pushes) noexcept {
    if (!hand.input_usable) clearPushes(pushes);
    double pressure = 0.0;
    Wrench rest = wrench.F_H_W;
    if (grip.shared && model.hasWeight()) {
        const Wrench weight = borneWeight(model, hand, grip, wrench.F_H_W);
        rest.force -= weight.force;
        rest.torque -= weight.torque;
    }
    rest.force += transients.of_transients.force;
    rest.torque += transients.of_transients.torque;
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
