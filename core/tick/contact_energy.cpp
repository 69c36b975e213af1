#include "core/tick/contact_energy.h"

#include <algorithm>

namespace passung::tick {

void clearPushes(TickState& state) noexcept {
    for (PairAccount& pair : state.pairs) {
        pair.push = Wrench{};
        pair.pressure = 0.0;
    }
}

void addPush(TickState& state, std::uint32_t obstacle, const Wrench& push, double pressure) noexcept {
    PairAccount& pair = state.pairs[obstacle];
    pair.push.force += push.force;
    pair.push.torque += push.torque;
    pair.pressure += pressure;
}

void notePushes(const TickModel& model, TickState& state, const ConstrainedMotion& motion,
                const FrictionPatches& rubbing) noexcept {
    clearPushes(state);
    const double K = model.contact.stiffness;
    const double turn = model.contact.rotational_stiffness / (model.metric_radius * model.metric_radius);
    for (int i = 0; i < motion.active; ++i) {
        const HeldContact& held = motion.held[static_cast<std::size_t>(i)];
        const ContactPoint& contact = state.manifold[held.contact];
        const Vec3 push = held.push * contact.gradient.normalized();
        addPush(state, contact.obstacle, {K * push, turn * (contact.position - state.X_WG.p).cross(push)},
                K * held.push);
    }
    for (int p = 0; p < rubbing.count; ++p) {
        const FrictionPatch& patch = rubbing.patch[static_cast<std::size_t>(p)];
        const Vec3 rub = rubAlong(patch);
        const Vec3 torsion = patch.radius * patch.rub.z() * patch.normal;
        addPush(state, patch.obstacle, {K * rub, turn * ((patch.centre - state.X_WG.p).cross(rub) + torsion)}, 0.0);
    }
}

void sharePushes(const TickModel&, TickState& state, TickFrame& frame) noexcept {
    if (!frame.input_usable) clearPushes(state);
    double pressure = 0.0;
    Wrench rest = frame.F_H_W;
    for (const PairAccount& pair : state.pairs) {
        pressure += pair.pressure;
        rest.force -= pair.push.force;
        rest.torque -= pair.push.torque;
    }
    if (!(pressure > 0.0)) return;
    for (PairAccount& pair : state.pairs) {
        const double share = pair.pressure / pressure;
        pair.push.force += share * rest.force;
        pair.push.torque += share * rest.torque;
    }
}

void delayPushes(const TickModel& model, TickState& state) noexcept {
    const auto length = static_cast<std::int64_t>(model.limits.delay_ticks) + 1;
    const std::size_t count = state.pairs.size();
    const auto in = static_cast<std::size_t>(state.tick % length) * count;
    const auto out = static_cast<std::size_t>((state.tick + 1) % length) * count;
    for (std::size_t i = 0; i < count; ++i) {
        state.push_line[in + i] = state.pairs[i].push;
        state.pairs[i].push = state.push_line[out + i];
    }
}

void bookPairs(TickState& state, const Vec3& moved, const Vec3& turned, int ticks) noexcept {
    for (PairAccount& pair : state.pairs) {
        pair.taken_in -= (pair.sent.force.dot(moved) + pair.sent.torque.dot(turned)) / ticks;
        pair.least = std::min(pair.least, pair.taken_in);
    }
}

}  // namespace passung::tick
