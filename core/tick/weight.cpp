#include "core/tick/weight.h"

#include <algorithm>

namespace passung::tick {

Wrench weightOf(const HandModel& model, const Quat& R_WG) noexcept {
    return {model.weight, (R_WG * model.centre).cross(model.weight)};
}

Hanging hangingOf(const HandModel& model, const Grip& grip) noexcept {
    Hanging hanging{model.registration.X_WB.q.conjugate() * model.weight, Vec3::Zero()};
    const bool turns = model.limits.actuates_torque && model.limits.max_torque != 0.0;
    if (turns) hanging.p_D = grip.X_DG * (model.hangsTurned() && !grip.shared ? model.centre : grip.p_GC);
    return hanging;
}

double liftEnergy(const Hanging& hanging, const Pose& X_BD) noexcept {
    return -hanging.f_B.dot(X_BD.p + X_BD.q * hanging.p_D);
}

Wrench borneWeight(const HandModel& model, const HandSample& hand, const Grip& grip, const Wrench& F_H_W) noexcept {
    const double share = std::clamp(F_H_W.force.dot(model.weight) / model.weight.squaredNorm(), 0.0, 1.0);
    const Vec3 force = share * model.weight;
    return {force, grip.leverOf(hand.X_WH.q).cross(force)};
}

double hangingTurn(const HandModel& model, const Vec3& p_GC) noexcept {
    if (!model.hasWeight() || !model.hasProxy() || !model.hangsTurned()) return 0.0;
    return model.weight.norm() * (model.centre - p_GC).norm() / model.contact.rotational_stiffness;
}

void hangPart(const HandModel& model, const HandSample& hand, const Grip& grip, const InputGuard& guard,
              Hang& hang) noexcept {
    hang.X_WR = hand.X_WH;
    if (!model.hasProxy() || !guard.has_good_pose || grip.shared) return;
    const scene::ContactSpec& c = model.contact;
    hang.X_WR.p += model.weight / c.stiffness;
    if (!model.hangsTurned()) return;
    const Vec3 turn = (hand.X_WH.q * (model.centre - grip.p_GC)).cross(model.weight) / c.rotational_stiffness;
    hang.X_WR.q = rotationFromVector(turn) * hand.X_WH.q;
    hang.X_WR.q.normalize();
    hang.X_WR.p += grip.leverOf(hand.X_WH.q) - grip.leverOf(hang.X_WR.q);
}

void addWeight(const HandModel& model, const HandSample& hand, const Grip& grip, const Proxy& proxy, const Hang& hang,
               const HandWrench& wrench, Pushes& pushes, WeightShare& added, Report& report) noexcept {
    report.status |= kWeighed;
    added.of_weight = Wrench{};
    if (grip.shared) {  // the spring holds it
        if (hand.input_usable) pushes.pushes.back().wrench = borneWeight(model, hand, grip, wrench.F_H_W);
        return;
    }
    Wrench weight = weightOf(model, hand.X_WH.q);
    if (model.hasProxy()) {
        const Vec3 from_hand = rotationVector(proxy.X_WG.q * hand.X_WH.q.conjugate());
        const Vec3 from_rest = rotationVector(proxy.X_WG.q * hang.X_WR.q.conjugate());
        weight.torque = model.contact.rotational_stiffness * (from_hand - from_rest) +
                        grip.leverOf(hand.X_WH.q).cross(weight.force);
    }
    pushes.pushes.back().wrench = hand.input_usable ? weight : Wrench{};
    added.of_weight = weight;
}

}  // namespace passung::tick
