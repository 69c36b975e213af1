#include "core/tick/effect_sum.h"

namespace passung::tick {

void addEffects(const HandModel& model, const TransientsShare& transients, const WeightShare& weight,
                const ViscosityShare& viscosity, const GuidanceShare& guidance, const SnapShare& snap,
                const InertiaShare& inertia, const KeepApartShare& apart, HandWrench& wrench, EffectRecord& record,
                Report& report) noexcept {
    const std::uint32_t has = model.wrenchEffects();
    const auto add = [&](WrenchEffect effect, const Wrench& more, std::uint32_t status) {
        if ((has >> static_cast<unsigned>(effect) & 1u) == 0) return;
        wrench.F_H_W.force += more.force;
        wrench.F_H_W.torque += more.torque;
        report.status |= status;
    };
    add(WrenchEffect::Transients, transients.of_transients, 0);
    add(WrenchEffect::Weight, weight.of_weight, 0);  // which says kWeighed itself
    add(WrenchEffect::Viscosity, viscosity.of_viscosity, kAidedInAir);
    add(WrenchEffect::Guidance, guidance.of_guidance, kAidedInAir);
    add(WrenchEffect::Snap, snap.of_snap, kAidedInAir);
    add(WrenchEffect::Inertia, inertia.of_inertia, kAidedInAir);
    add(WrenchEffect::KeepApart, apart.of_keep_apart, kAidedInAir);
    if (model.effects.record) record.effects = has;
}

}  // namespace passung::tick
