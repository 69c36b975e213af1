#include "core/tick/weight.h"

namespace passung::tick {

Wrench weightOf(const HandModel& model, const Quat& R_WG) noexcept {
    return {model.weight, (R_WG * model.centre).cross(model.weight)};
}

double liftEnergy(const HandModel& model, const Pose& X_BD) noexcept {
    const scene::Registration& registration = model.registration;
    const Vec3 f_B = registration.X_WB.q.conjugate() * model.weight;
    Vec3 p_BC = X_BD.p;  // on which f_B acts
    const bool turns = model.limits.actuates_torque && model.limits.max_torque != 0.0;
    if (turns) p_BC += X_BD.q * (model.hangsTurned() ? registration.X_DH * model.centre : registration.X_DH.p);
    return -f_B.dot(p_BC);
}

void hangPart(const HandModel& model, const HandSample& hand, const InputGuard& guard, Hang& hang) noexcept {
    hang.X_WR = hand.X_WH;
    if (!model.hasProxy() || !guard.has_good_pose) return;
    const Wrench weight = weightOf(model, hand.X_WH.q);
    const scene::ContactSpec& c = model.contact;
    hang.X_WR.p += weight.force / c.stiffness;
    if (!model.hangsTurned()) return;
    hang.X_WR.q = rotationFromVector(weight.torque / c.rotational_stiffness) * hand.X_WH.q;
    hang.X_WR.q.normalize();
}

void addWeight(const HandModel& model, const HandSample& hand, const Proxy& proxy, const Hang& hang, Pushes& pushes,
               HandWrench& wrench, Report& report) noexcept {
    Wrench weight = weightOf(model, hand.X_WH.q);
    if (model.hasProxy()) {
        const Vec3 from_hand = rotationVector(proxy.X_WG.q * hand.X_WH.q.conjugate());
        const Vec3 from_rest = rotationVector(proxy.X_WG.q * hang.X_WR.q.conjugate());
        weight.torque = model.contact.rotational_stiffness * (from_hand - from_rest);
    }
    pushes.pushes.back().wrench = hand.input_usable ? weight : Wrench{};
    wrench.F_H_W.force += weight.force;
    wrench.F_H_W.torque += weight.torque;
    report.status |= kWeighed;
}

}  // namespace passung::tick
