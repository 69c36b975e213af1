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
void measureRates(Stretch& stretch, const HandSample& hand, const Vec3& e, const Vec3& psi) noexcept {
    if (hand.relocated) stretch.has_last_stretch = false;  // the proxy was set to the hand
    if (!hand.input_usable) {
        stretch.has_last_stretch = false;
        stretch.last_stretch_rate = stretch.last_twist_rate = Vec3::Zero();
        return;
    }
    if (hand.sample_periods == 0) return;
    if (stretch.has_last_stretch) {
        const double elapsed = kTickSeconds * static_cast<double>(hand.sample_periods);
        stretch.last_stretch_rate = (e - stretch.last_stretch) / elapsed;
        stretch.last_twist_rate = (psi - stretch.last_twist) / elapsed;
    }
    stretch.last_stretch = e;
    stretch.last_twist = psi;
    stretch.has_last_stretch = true;
}

}  // namespace

void renderCoupling(const HandModel& model, const HandSample& hand, const Grip& grip, const Proxy& proxy,
                    const Hang& hang, Stretch& stretch, HandWrench& wrench) noexcept {
    const Pose& rest = model.hasWeight() ? hang.X_WR : hand.X_WH;
    const Vec3 e = proxy.X_WG * grip.p_GC - rest * grip.p_GC;
    const Vec3 psi = rotationVector(proxy.X_WG.q * rest.q.conjugate());
    measureRates(stretch, hand, e, psi);
    const scene::ContactSpec& c = model.contact;
    if (model.hasInertia() && !grip.shared) {
        wrench.F_H_W.force = c.stiffness * e + c.damping * stretch.last_stretch_rate;
        wrench.F_H_W.torque = c.rotational_stiffness * psi + c.rotational_damping * stretch.last_twist_rate +
                              grip.leverOf(hand.X_WH.q).cross(wrench.F_H_W.force);
        return;
    }
    wrench.F_H_W.force = springAndDamper(e, stretch.last_stretch_rate, c.stiffness, c.damping);
    wrench.F_H_W.torque = springAndDamper(psi, stretch.last_twist_rate, c.rotational_stiffness, c.rotational_damping) +
                          grip.leverOf(hand.X_WH.q).cross(wrench.F_H_W.force);
}

}  // namespace passung::tick
