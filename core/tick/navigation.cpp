#include "core/tick/navigation.h"

#include <algorithm>

#include "core/tick/buttons.h"
#include "core/tick/output_stage.h"

namespace passung::tick {

namespace {

constexpr double kNoWay = 1e-12;  // [m]: what rounding leaves of none

/// X_BI of (1).
Pose imageOf(const Offset& offset, const Pose& X_BD) noexcept {
    return {X_BD.q * offset.Q, offset.scale * X_BD.p + offset.o};
}

/// What the clutch will hold, as the tick before left it, in which it was taken.
void noteHold(const HandModel& model, const Proxy& proxy, const Hang& hang, HandMapping& mapping) noexcept {
    Clutched& clutch = mapping.clutch;
    clutch.noted = true;
    clutch.X_WH = mapping.sample.X_WH;
    clutch.X_BI = imageOf(mapping.offset, mapping.sample.X_BD);
    clutch.stretch = clutch.twist = Vec3::Zero();
    if (!model.hasProxy()) return;
    const Pose& rest = model.hasWeight() ? hang.X_WR : mapping.sample.X_WH;
    clutch.stretch = proxy.X_WG.p - rest.p;
    clutch.twist = rotationVector(proxy.X_WG.q * rest.q.conjugate());
}

/// The part while the clutch is held; the offset takes up the hand's motion.
Pose heldPose(const HandModel& model, const Grip& grip, const Pose& X_BD, HandMapping& mapping) noexcept {
    const scene::Registration& registration = model.registration;
    const Clutched& clutch = mapping.clutch;
    Offset& offset = mapping.offset;
    const double relaxed = 1.0 - clutch.grip;
    offset.moved = true;
    if (!model.effects.navigation.clutch.orientation) {
        const Vec3 p_BI = clutch.X_BI.p + registration.X_WB.q.conjugate() * (relaxed * clutch.stretch);
        offset.o = p_BI - offset.scale * X_BD.p;
        return mappedPose(registration, offset, X_BD, grip.X_DG);
    }
    Pose X_WH = clutch.X_WH;
    X_WH.p += relaxed * clutch.stretch;
    if (!clutch.twist.isZero(0.0)) X_WH.q = (rotationFromVector(relaxed * clutch.twist) * X_WH.q).normalized();
    const Pose X_BI = registration.X_WB.inverse() * X_WH * grip.X_DG.inverse();
    offset.Q = (X_BD.q.conjugate() * X_BI.q).normalized();
    offset.o = X_BI.p - offset.scale * X_BD.p;
    return X_WH;
}

/// The scale that is asked for.
double wantedScale(const HandModel& model, const Reading& device) noexcept {
    const scene::SecondScale& second = model.effects.navigation.second_scale;
    return isDown(device.reading, second.button) ? second.scale : model.registration.scale;
}

void changeScale(double scale, const Pose& X_BD_last, Offset& offset) noexcept {
    offset.o += (offset.scale - scale) * X_BD_last.p;
    offset.scale = scale;
    offset.moved = true;
}

void addDrift(const scene::Drift& drift, const Vec3& before, const Vec3& now, Offset& offset) noexcept {
    const double way = (now - before).norm();
    const Vec3 m = 0.5 * (now + before) - drift.home;
    if (!(way > kNoWay)) return;
    offset.o += offset.scale * drift.share * way / std::max(m.norm(), drift.radius) * m;
    offset.moved = true;
}

/// One new good sample of a hand whose trial has begun. Where the part is asked to be.
Pose followSample(const HandModel& model, const Reading& device, const Grip& grip, const Pose& X_BD,
                  const EnergyAccount& account, const Proxy& proxy, const Hang& hang, const ContactSign& sign,
                  const HandSample& hand, HandMapping& mapping) noexcept {
    const scene::Navigation& navigation = model.effects.navigation;
    Clutched& clutch = mapping.clutch;
    const double fade = static_cast<double>(hand.sample_periods) / kGripTicks;
    const bool pressed = isDown(device.reading, navigation.clutch.button),
               yields = account.taken_in < mapping.sample.energy - kYield;
    if ((clutch.held || pressed) && yields) clutch.grip = 0.0;
    if (clutch.held) {
        if (!clutch.noted) noteHold(model, proxy, hang, mapping);
        clutch.held = pressed;
        if (pressed) clutch.grip = std::max(0.0, clutch.grip - fade);
        return heldPose(model, grip, X_BD, mapping);
    }
    clutch.held = pressed;
    clutch.noted = false;
    if (pressed) return mappedPose(model.registration, mapping.offset, X_BD, grip.X_DG);
    clutch.grip = std::min(1.0, clutch.grip + fade);
    if (!sign.touching) {
        const double scale = wantedScale(model, device);
        if (scale != mapping.offset.scale) changeScale(scale, mapping.sample.X_BD, mapping.offset);
        if (navigation.drift.share > 0.0 && mapping.sample.follows)
            addDrift(navigation.drift, mapping.sample.believed, account.X_BD.p - account.ahead.v, mapping.offset);
    }
    return mappedPose(model.registration, mapping.offset, X_BD, grip.X_DG);
}

/// `wrench` with `share` of its force and, of its torque about the handle, of that too or all.
Wrench faded(const Wrench& wrench, double share, bool torque, const Vec3& lever) noexcept {
    const Vec3 force = share * wrench.force;
    if (torque) return {force, share * wrench.torque};
    return {force, wrench.torque + lever.cross(wrench.force - force)};
}

}  // namespace

Pose mappedPose(const scene::Registration& registration, const Offset& offset, const Pose& X_BD,
                const Pose& X_DH) noexcept {
    if (!offset.moved) return registeredPose(registration, X_BD, X_DH);
    return registration.X_WB * (imageOf(offset, X_BD) * X_DH);
}

void navigate(const HandModel& model, const Reading& device, const InputGuard& guard, const Engagement& gate,
              const Grip& grip, const EnergyAccounts& accounts, const Proxy& proxy, const Hang& hang,
              const ContactSign& sign, HandSample& hand, HandMapping& mapping, MappingRecord& record) noexcept {
    const EnergyAccount& account = accounts.energy;
    if (!hand.input_usable) mapping.sample.follows = false;
    if (guard.has_good_pose) {
        const Pose& X_BD = guard.X_BD_good;
        if (hand.sample_periods == 0 && mapping.sample.known)
            hand.X_WH = mapping.sample.X_WH;
        else if (gate.engaged && mapping.sample.known)
            hand.X_WH = followSample(model, device, grip, X_BD, account, proxy, hang, sign, hand, mapping);
        else
            hand.X_WH = mappedPose(model.registration, mapping.offset, X_BD, grip.X_DG);
        if (hand.sample_periods > 0) {
            mapping.sample.known = mapping.sample.follows = true;
            mapping.sample.X_BD = X_BD;
            mapping.sample.believed = account.X_BD.p - account.ahead.v;
            mapping.sample.energy = account.taken_in;
        }
        mapping.sample.X_WH = hand.X_WH;
    }
    record.clutched = mapping.clutch.held;
    record.scale = mapping.offset.scale;
    record.offset = model.registration.X_WB.q * mapping.offset.o;
    record.turn = mapping.offset.Q;
}

void noteContact(const HandModel& model, const ContactRecord& contacts, const HandWrench& wrench,
                 ContactSign& sign) noexcept {
    const bool pulls_in_air = model.hasFieldProxyOf(scene::ContactMethod::Penalty) &&
                              model.contact.coupling == scene::PenaltyCoupling::Virtual;
    const bool pushed = !wrench.F_H_W.force.isZero(0.0) || !wrench.F_H_W.torque.isZero(0.0);
    sign.touching = pulls_in_air ? contacts.contacts > 0 : pushed;
}

void fadeWrench(const HandModel& model, const HandSample& hand, const Grip& grip, const HandMapping& mapping,
                Pushes& pushes, HandWrench& wrench) noexcept {
    const Clutched& clutch = mapping.clutch;
    if (clutch.grip == 1.0) return;
    const double share = clutch.held ? clutch.grip : 1.0;
    const bool torque = model.effects.navigation.clutch.orientation;
    const Vec3 lever = leverOf(hand, grip);
    Wrench weight;
    if (model.hasWeight()) weight = pushes.pushes.back().wrench;
    const Wrench contact =
        faded({wrench.F_H_W.force - weight.force, wrench.F_H_W.torque - weight.torque}, share, torque, lever);
    for (const std::uint32_t i : pushes.pushes.held()) {
        ObstaclePush& push = pushes.pushes[i];
        const bool weighs = model.hasWeight() && i + 1 == pushes.pushes.size();
        push.wrench = weighs ? faded(weight, clutch.grip, true, lever) : faded(push.wrench, share, torque, lever);
        push.pressure *= share;
    }
    wrench.F_H_W = {contact.force + clutch.grip * weight.force, contact.torque + clutch.grip * weight.torque};
}

}  // namespace passung::tick
