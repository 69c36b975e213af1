#pragma once

#include "core/tick/tick_model.h"

namespace passung::tick {

/// Stage: a spring and damper between the proxy and the hand (Colgate 1995); steps #6 of the god object.
///   Reads X_WG, X_WH; writes F_H_W, the wrench on the hand about the held part's origin.
///   e = p_WG - p_WH,  ψ = log(R_WG R_WHᵀ)
///   F = K e + B ė,   T = K_φ ψ + B_φ ψ̇,   ė and ψ̇ by the difference of two ticks.
/// The damper acts on the stretch, not on the hand's speed: in free motion e = 0, so that both parts vanish, and along
/// a frictionless surface e does not change, so that sliding is not braked. It may not pull the hand into the surface
/// it leaves: where the damper would turn F against e (T against ψ), that part is dropped. Limit case: a proxy at rest
/// gives ė = -v_H, the usual wall damper.
void renderCoupling(const TickModel& model, TickState& state, TickFrame& frame) noexcept;

}  // namespace passung::tick
