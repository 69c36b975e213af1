#include "core/tick/virtual_coupling.h"

namespace passung::tick {

namespace {

/// stiffness · x + damping · rate, without a part against x.
Vec3 springAndDamper(const Vec3& x, const Vec3& rate, double stiffness, double damping) noexcept {
    const Vec3 load = stiffness * x + damping * rate;
    const double along = load.dot(x);
    if (along >= 0.0) return load;
    return load - along / x.squaredNorm() * x;  // along < 0 only if x ≠ 0
}

}  // namespace

void renderCoupling(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const Vec3 e = state.X_WG.p - frame.X_WH.p;
    const Vec3 psi = rotationVector(state.X_WG.q * frame.X_WH.q.conjugate());
    const Vec3 e_rate = state.has_last_stretch ? Vec3((e - state.last_stretch) / kTickSeconds) : Vec3(Vec3::Zero());
    const Vec3 psi_rate = state.has_last_stretch ? Vec3((psi - state.last_twist) / kTickSeconds) : Vec3(Vec3::Zero());
    const model::ContactSpec& c = model.contact;
    frame.F_H_W.force = springAndDamper(e, e_rate, c.stiffness, c.damping);
    frame.F_H_W.torque = springAndDamper(psi, psi_rate, c.rotational_stiffness, c.rotational_damping);
    state.last_stretch = e;
    state.last_twist = psi;
    state.has_last_stretch = true;
}

}  // namespace passung::tick
