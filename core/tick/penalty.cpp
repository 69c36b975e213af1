#include "core/tick/penalty.h"

#include <algorithm>

#include "core/contact/depth_sum.h"
#include "core/tick/contact_energy.h"
#include "core/tick/obstacle_query.h"
#include "core/tick/twist_between.h"

namespace passung::tick {

namespace {

bool isWeighted(model::PenaltyVariant variant) noexcept { return variant == model::PenaltyVariant::AreaWeighted; }

/// -b (v · û) û, no larger than what it opposes.
Vec3 dampingAlong(const Vec3& load, const Vec3& velocity, double damping) noexcept {
    const double size = load.norm();
    if (!(size > 0.0)) return Vec3::Zero();
    const Vec3 direction = load / size;
    const double along = -damping * velocity.dot(direction);
    return std::max(along, -size) * direction;
}

/// `pairs`, so far with sums over their contacts.
void scalePushes(std::span<PairAccount> pairs, double scale) noexcept {
    for (PairAccount& pair : pairs) {
        pair.push = {scale * pair.push.force, scale * pair.push.torque};
        pair.pressure = pair.push.force.norm();
    }
}

/// From sample to sample: see renderPenalty.
void measureHandVelocity(TickState& state, const TickFrame& frame) noexcept {
    if (!frame.input_usable) {
        state.has_last_hand = false;
        state.V_H_last = Twist{};
        return;
    }
    if (frame.sample_periods == 0) return;
    if (state.has_last_hand) state.V_H_last = twistBetween(state.X_WH_last, frame.X_WH, frame.sample_periods);
    state.X_WH_last = frame.X_WH;
    state.has_last_hand = true;
}

}  // namespace

QueryRequest penaltyRequest(model::PenaltyVariant variant) noexcept {
    return {.gradients = false, .load = isWeighted(variant), .refine = true};
}

void findContactsAtHand(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    state.X_WG = frame.X_WH;
    state.manifold.clear();
    clearPushes(state);
    const QueryAnswer answer = queryObstacles(model, frame.X_WH, penaltyRequest(model.contact.variant), state.workspace,
                                              state.manifold, state.pairs);
    account(answer, frame);
    frame.load = answer.load;
    frame.contacts = static_cast<std::uint32_t>(answer.contacts);
    frame.hand_depth = frame.proxy_depth = std::max(0.0, -answer.phi);
}

Wrench weightedWrench(const model::ContactSpec& contact, const Wrench& load, std::span<PairAccount> pairs) noexcept {
    const double scale = (contact.two_way ? 0.5 : 1.0) * contact.area_stiffness;
    scalePushes(pairs, scale);
    return {scale * load.force, scale * load.torque};
}

Wrench penaltyWrench(const model::ContactSpec& contact, const ContactManifold& manifold, const Vec3& p_WO,
                     std::span<PairAccount> pairs) noexcept {
    return penaltyLoad(contact, manifold, p_WO, pairs).wrench;
}

PenaltyLoad penaltyLoad(const model::ContactSpec& contact, const ContactManifold& manifold, const Vec3& p_WO,
                        std::span<PairAccount> pairs) noexcept {
    const bool weighted = isWeighted(contact.variant);
    const DepthSum all =
        sumDepths(manifold, weighted, p_WO, [&](const ContactPoint& c, const Vec3& f, const Vec3& moment) {
            if (pairs.empty()) return;
            pairs[c.obstacle].push.force += f;
            pairs[c.obstacle].push.torque += moment;
        });
    double scale = (contact.two_way ? 0.5 : 1.0) * (weighted ? contact.area_stiffness : contact.stiffness);
    if (contact.variant == model::PenaltyVariant::MaxNormalised) {
        const double coherent = std::max(all.sum.force.norm(), kLeastCoherence * all.depths);
        if (coherent > 0.0) scale = contact.stiffness * all.deepest / coherent;
    }
    scalePushes(pairs, scale);
    return {{scale * all.sum.force, scale * all.sum.torque}, scale};
}

void renderPenalty(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    measureHandVelocity(state, frame);
    Wrench wrench = isWeighted(model.contact.variant)
                        ? weightedWrench(model.contact, frame.load, state.pairs)
                        : penaltyWrench(model.contact, state.manifold, frame.X_WH.p, state.pairs);
    const Vec3 force_damping = dampingAlong(wrench.force, state.V_H_last.v, model.contact.damping);
    const Vec3 torque_damping = dampingAlong(wrench.torque, state.V_H_last.w, model.contact.rotational_damping);
    wrench.force += force_damping;
    wrench.torque += torque_damping;
    frame.F_H_W = wrench;
}

}  // namespace passung::tick
