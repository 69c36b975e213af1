#include "core/tick/effect_sum.h"

namespace passung::tick {

void addEffects(const HandModel& model, const TransientsShare& transients, const WeightShare& weight,
                const ViscosityShare& viscosity, const GuidanceShare& guidance, HandWrench& wrench,
                EffectRecord& record, Report& report) noexcept {
    const std::uint32_t has = model.wrenchEffects();
    const auto add = [&](WrenchEffect effect, const Wrench& more) {
        if ((has >> static_cast<unsigned>(effect) & 1u) == 0) return;
        wrench.F_H_W.force += more.force;
        wrench.F_H_W.torque += more.torque;
    };
    add(WrenchEffect::Transients, transients.of_transients);
    add(WrenchEffect::Weight, weight.of_weight);
    add(WrenchEffect::Viscosity, viscosity.of_viscosity);
    add(WrenchEffect::Guidance, guidance.of_guidance);
    if (model.effects.viscosity.any() || model.effects.guidance.share > 0.0) report.status |= kAidedInAir;
    if (model.effects.record) record.effects = has;
}

}  // namespace passung::tick
