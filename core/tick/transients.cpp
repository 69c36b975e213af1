#include "core/tick/transients.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/tick/twist_between.h"

namespace passung::tick {

namespace {

Wrench sum(double a, const Wrench& x, double b, const Wrench& y) noexcept {
    return {a * x.force + b * y.force, a * x.torque + b * y.torque};
}

/// |F| of the header.
double sizeOf(const HandModel& model, const Wrench& wrench) noexcept {
    return std::max(wrench.force.norm(), wrench.torque.norm() / model.reach);
}

/// s of the header.
double impactSpeed(const HandModel& model, const Ringing& ringing, const HandSample& hand, const Wrench& F) noexcept {
    const Twist V = twistBetween(ringing.X_WH_last, hand.X_WH, hand.sample_periods);
    return std::max(0.0, -(F.force.dot(V.v) + F.torque.dot(V.w)) / sizeOf(model, F));
}

}  // namespace

void renderTransients(const HandModel& model, const HandSample& hand, const ContactRecord& contacts,
                      const HandWrench& wrench, Ringing& ringing, TransientsShare& added) noexcept {
    added.of_transients = Wrench{};
    if (!hand.input_usable) {
        ringing = Ringing{};
        return;
    }
    const scene::Transients& t = model.effects.transients;
    const double r = std::exp(-kTickSeconds / t.decay);
    const double phi = 2.0 * std::numbers::pi * t.frequency * kTickSeconds;
    const Wrench& contact = wrench.F_H_W;
    const Wrench now = ringing.next;
    ringing.next = sum(2.0 * r * std::cos(phi), now, -r * r, ringing.now);
    ringing.now = now;
    const double size = sizeOf(model, contact);
    // A proxy that lags behind in free room pulls too: that is no contact.
    const bool in_contact = contacts.contacts > 0 && size > 0.0;
    const bool begins = in_contact && !ringing.in_contact && ringing.has_last;
    ringing.in_contact = in_contact;
    if (hand.sample_periods > 0) {
        if (begins) {
            const double speed = impactSpeed(model, ringing, hand, contact);
            ringing.next = sum(1.0, ringing.next, t.amplitude * speed * r * std::sin(phi) / size, contact);
        }
        ringing.X_WH_last = hand.X_WH;
        ringing.has_last = true;
    }
    added.of_transients = now;
}

}  // namespace passung::tick
