#include "core/tick/viscosity.h"

#include <cmath>

#include "core/tick/twist_between.h"

namespace passung::tick {

void resistMotion(const HandModel& model, const HandSample& hand, Stirring& stirring, ViscosityShare& added) noexcept {
    added.of_viscosity = Wrench{};
    if (!hand.input_usable || hand.relocated) {
        stirring = Stirring{};
        return;
    }
    if (hand.sample_periods > 0) {
        if (stirring.has_last) {
            const Twist V = twistBetween(stirring.X_WH_last, hand.X_WH, hand.sample_periods);
            const double n = static_cast<double>(hand.sample_periods);
            const double follow = 1.0 - std::exp(-n * kTickSeconds / kStirringTime);
            stirring.V.v += follow * (V.v - stirring.V.v);
            stirring.V.w += follow * (V.w - stirring.V.w);
        }
        stirring.X_WH_last = hand.X_WH;
        stirring.has_last = true;
    }
    const scene::Viscosity& b = model.effects.viscosity;
    added.of_viscosity = {-b.damping * stirring.V.v, -b.rotational_damping * stirring.V.w};
}

}  // namespace passung::tick
