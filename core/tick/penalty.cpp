#include "core/tick/penalty.h"

#include <algorithm>

#include "core/contact/depth_sum.h"
#include "core/tick/contact_energy.h"
#include "core/tick/obstacle_query.h"
#include "core/tick/twist_between.h"

namespace passung::tick {

namespace {

bool isWeighted(scene::PenaltyVariant variant) noexcept { return variant == scene::PenaltyVariant::AreaWeighted; }

/// -b (v · û) û, no larger than what it opposes.
Vec3 dampingAlong(const Vec3& load, const Vec3& velocity, double damping) noexcept {
    const double size = load.norm();
    if (!(size > 0.0)) return Vec3::Zero();
    const Vec3 direction = load / size;
    const double along = -damping * velocity.dot(direction);
    return std::max(along, -size) * direction;
}

/// `pushes`, so far sums over their contacts.
void scalePushes(FewOfMany<ObstaclePush>* pushes, double scale) noexcept {
    if (pushes == nullptr) return;
    for (const std::uint32_t i : pushes->held()) {
        ObstaclePush& push = (*pushes)[i];
        push.wrench = {scale * push.wrench.force, scale * push.wrench.torque};
        push.pressure = push.wrench.force.norm();
    }
}

/// From sample to sample: see renderPenalty.
void measureHandVelocity(HandVelocity& velocity, const HandSample& hand) noexcept {
    if (!hand.input_usable) {
        velocity.has_last_hand = false;
        velocity.V_H_last = Twist{};
        return;
    }
    if (hand.sample_periods == 0) return;
    if (velocity.has_last_hand) velocity.V_H_last = twistBetween(velocity.X_WH_last, hand.X_WH, hand.sample_periods);
    velocity.X_WH_last = hand.X_WH;
    velocity.has_last_hand = true;
}

}  // namespace

contact::QueryRequest penaltyRequest(scene::PenaltyVariant variant) noexcept {
    return {.gradients = false, .load = isWeighted(variant), .every_node = true, .refine = true};
}

void findContactsAtHand(const HandModel& model, const HandSample& hand, const ObstaclePoses& obstacles, Proxy& proxy,
                        QueryMemory& memory, Pushes& pushes, AreaLoad& load, ContactRecord& record, HandDepth& depth,
                        Report& report) noexcept {
    proxy.X_WG = hand.X_WH;
    proxy.manifold.clear();
    clearPushes(pushes);
    const contact::QueryAnswer answer =
        queryObstacles(model, obstacles, hand.X_WH, penaltyRequest(model.contact.variant), memory.workspace,
                       proxy.manifold, memory.around_hand, true, &pushes.pushes);
    account(answer, report);
    load.load = answer.load;
    record.contacts = static_cast<std::uint32_t>(answer.contacts);
    depth.hand_depth = record.proxy_depth = std::max(0.0, -answer.phi);
}

Wrench weightedWrench(const scene::ContactSpec& contact, const Wrench& load, FewOfMany<ObstaclePush>* pushes) noexcept {
    const double scale = (contact.two_way ? 0.5 : 1.0) * contact.area_stiffness;
    scalePushes(pushes, scale);
    return {scale * load.force, scale * load.torque};
}

Wrench penaltyWrench(const scene::ContactSpec& contact, const contact::ContactManifold& manifold, const Vec3& p_WO,
                     FewOfMany<ObstaclePush>* pushes) noexcept {
    return penaltyLoad(contact, manifold, p_WO, pushes).wrench;
}

PenaltyLoad penaltyLoad(const scene::ContactSpec& contact, const contact::ContactManifold& manifold, const Vec3& p_WO,
                        FewOfMany<ObstaclePush>* pushes) noexcept {
    const bool weighted = isWeighted(contact.variant);
    const contact::DepthSum all = contact::sumDepths(
        manifold, weighted, p_WO, [&](const contact::ContactPoint& c, const Vec3& f, const Vec3& moment) {
            if (pushes == nullptr) return;
            (*pushes)[c.obstacle].wrench.force += f;
            (*pushes)[c.obstacle].wrench.torque += moment;
        });
    double scale = (contact.two_way ? 0.5 : 1.0) * (weighted ? contact.area_stiffness : contact.stiffness);
    if (contact.variant == scene::PenaltyVariant::MaxNormalised) {
        const double coherent = std::max(all.sum.force.norm(), kLeastCoherence * all.depths);
        if (coherent > 0.0) scale = contact.stiffness * all.deepest / coherent;
    }
    scalePushes(pushes, scale);
    return {{scale * all.sum.force, scale * all.sum.torque}, scale};
}

void renderPenalty(const HandModel& model, const HandSample& hand, const Proxy& proxy, const AreaLoad& load,
                   HandVelocity& velocity, Pushes& pushes, HandWrench& wrench) noexcept {
    measureHandVelocity(velocity, hand);
    Wrench F = isWeighted(model.contact.variant)
                   ? weightedWrench(model.contact, load.load, &pushes.pushes)
                   : penaltyWrench(model.contact, proxy.manifold, hand.X_WH.p, &pushes.pushes);
    const Vec3 force_damping = dampingAlong(F.force, velocity.V_H_last.v, model.contact.damping);
    const Vec3 torque_damping = dampingAlong(F.torque, velocity.V_H_last.w, model.contact.rotational_damping);
    F.force += force_damping;
    F.torque += torque_damping;
    wrench.F_H_W = F;
}

}  // namespace passung::tick
