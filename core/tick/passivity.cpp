#include "core/tick/passivity.h"

#include <algorithm>

#include "core/tick/contact_energy.h"
#include "core/tick/output_stage.h"

namespace passung::tick {

namespace {

/// How far the handle moved for certain while its reading moved by `step`; `ahead` follows.
Vec3 certainMotion(const Vec3& step, double quantum, Vec3& ahead) noexcept {
    const Vec3 before = ahead;
    ahead = (ahead + step).cwiseMax(-0.5 * quantum).cwiseMin(0.5 * quantum);
    return step - (ahead - before);
}

}  // namespace

void observeEnergy(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    EnergyAccount& account = state.energy;
    account.sent.force += state.last_sent.force;
    account.sent.torque += state.last_sent.torque;
    ++account.ticks;
    for (PairAccount& pair : state.pairs) {
        pair.sent.force += pair.last_sent.force;
        pair.sent.torque += pair.last_sent.torque;
    }
    if (!frame.input_usable) {
        account.has_sample = false;
        account.V_BD = account.ahead = Twist{};
    } else if (frame.sample_periods > 0) {
        const Pose& X = state.X_BD_good;
        if (account.has_sample) {
            const Vec3 dx = X.p - account.X_BD.p;
            const Vec3 dphi = rotationVector(X.q * account.X_BD.q.conjugate());
            const Vec3 moved = certainMotion(dx, model.limits.quantum, account.ahead.v);
            const Vec3 turned = certainMotion(dphi, model.limits.rotational_quantum, account.ahead.w);
            account.taken_in -= (account.sent.force.dot(moved) + account.sent.torque.dot(turned)) / account.ticks;
            bookPairs(state, moved, turned, account.ticks);
            const double elapsed = kTickSeconds * static_cast<double>(frame.sample_periods);
            account.V_BD = {dx / elapsed, dphi / elapsed};
        }
        account.X_BD = X;
        account.has_sample = true;
        account.sent = Wrench{};
        for (PairAccount& pair : state.pairs) pair.sent = Wrench{};
        account.ticks = 0;
    }
    frame.energy = account.taken_in;
}

void dampActivity(const TickModel& model, TickState& state, TickFrame& frame) noexcept {
    const EnergyAccount& account = state.energy;
    // On a held tick nothing new is known, and what was asked back is on its way.
    if (!(account.taken_in < 0.0) || frame.sample_periods == 0) return;
    const double rho2 = model.metric_radius * model.metric_radius;
    const double square = account.V_BD.v.squaredNorm() + rho2 * account.V_BD.w.squaredNorm();
    if (!(square > 0.0)) return;
    const double alpha = std::min(-account.taken_in / (kTickSeconds * square), model.passivity_damping);
    const Wrench damper{-alpha * account.V_BD.v, -alpha * rho2 * account.V_BD.w};
    const Wrench F_H_W = wrenchOnHeldPart(model, frame, damper);
    frame.F_H_W.force += F_H_W.force;
    frame.F_H_W.torque += F_H_W.torque;
    frame.status |= kPassivityActed;
}

}  // namespace passung::tick
