#include "core/tick/transients.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace passung::tick {

namespace {

Wrench sum(double a, const Wrench& x, double b, const Wrench& y) noexcept {
    return {a * x.force + b * y.force, a * x.torque + b * y.torque};
}

/// s of the header; 0 where there is no impact.
double impactSpeed(const Ringing& ringing, const TickFrame& frame) noexcept {
    const Wrench& F = frame.F_H_W;
    const double force = F.force.norm();
    if (!ringing.has_last || ringing.in_contact || !(force > 0.0)) return 0.0;
    const double elapsed = kTickSeconds * static_cast<double>(frame.sample_periods);
    const Vec3 v = (frame.X_WH.p - ringing.X_WH_last.p) / elapsed;
    const Vec3 w = rotationVector(frame.X_WH.q * ringing.X_WH_last.q.conjugate()) / elapsed;
    return std::max(0.0, -(F.force.dot(v) + F.torque.dot(w)) / force);
}

}  // namespace

void renderTransients(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    Ringing& ringing = state.ringing;
    if (!frame.input_usable) {
        ringing = Ringing{};
        return;
    }
    const model::Transients& t = model.transients;
    const double r = std::exp(-kTickSeconds / t.decay);
    const double phi = 2.0 * std::numbers::pi * t.frequency * kTickSeconds;
    const Wrench contact = frame.F_H_W;
    const Wrench now = ringing.next;
    ringing.next = sum(2.0 * r * std::cos(phi), now, -r * r, ringing.now);
    ringing.now = now;
    if (frame.sample_periods > 0) {
        const double speed = impactSpeed(ringing, frame);
        if (speed > 0.0)
            ringing.next =
                sum(1.0, ringing.next, t.amplitude * speed * r * std::sin(phi) / contact.force.norm(), contact);
        ringing.in_contact = !contact.force.isZero(0.0);
        ringing.X_WH_last = frame.X_WH;
        ringing.has_last = true;
    }
    frame.F_H_W = sum(1.0, contact, 1.0, now);
}

}  // namespace passung::tick
