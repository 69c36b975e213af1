#include "core/tick/virtual_coupling.h"

namespace passung::tick {

namespace {

constexpr double kNoStretch = 1e-8;  // [m], [rad]: what rounding leaves of none, and has no direction

/// stiffness · x + damping · rate, without a part against x; nothing without x.
Vec3 springAndDamper(const Vec3& x, const Vec3& rate, double stiffness, double damping) noexcept {
    const double square = x.squaredNorm();
    if (!(square > kNoStretch * kNoStretch)) return Vec3::Zero();
    const Vec3 load = stiffness * x + damping * rate;
    const double along = load.dot(x);
    return along >= 0.0 ? load : Vec3(load - along / square * x);
}

/// From sample to sample: see renderCoupling.
void measureRates(TickState& state, const TickFrame& frame, const Vec3& e, const Vec3& psi) noexcept {
    if (!frame.input_usable) {
        state.has_last_stretch = false;
        state.last_stretch_rate = state.last_twist_rate = Vec3::Zero();
        return;
    }
    if (frame.sample_periods == 0) return;
    if (state.has_last_stretch) {
        const double elapsed = kTickSeconds * static_cast<double>(frame.sample_periods);
        state.last_stretch_rate = (e - state.last_stretch) / elapsed;
        state.last_twist_rate = (psi - state.last_twist) / elapsed;
    }
    state.last_stretch = e;
    state.last_twist = psi;
    state.has_last_stretch = true;
}

}  // namespace

void renderCoupling(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const Vec3 e = state.X_WG.p - frame.X_WH.p;
    const Vec3 psi = rotationVector(state.X_WG.q * frame.X_WH.q.conjugate());
    measureRates(state, frame, e, psi);
    const model::ContactSpec& c = model.contact;
    frame.F_H_W.force = springAndDamper(e, state.last_stretch_rate, c.stiffness, c.damping);
    frame.F_H_W.torque = springAndDamper(psi, state.last_twist_rate, c.rotational_stiffness, c.rotational_damping);
}

}  // namespace passung::tick
