#include "core/tick/passivity.h"

#include <algorithm>

#include "core/tick/contact_energy.h"

namespace passung::tick {

namespace {

/// How far the handle moved for certain while its reading moved by `step`; `ahead` follows.
Vec3 certainMotion(const Vec3& step, double quantum, Vec3& ahead) noexcept {
    const Vec3 before = ahead;
    ahead = (ahead + step).cwiseMax(-0.5 * quantum).cwiseMin(0.5 * quantum);
    return step - (ahead - before);
}

/// Where the handle is believed to be.
Pose believedPose(const Pose& X_BD, const Twist& ahead) noexcept {
    return {rotationFromVector(-ahead.w) * X_BD.q, X_BD.p - ahead.v};
}

/// Leaves the energy of the part's weight out of the account, and of that of what no obstacle pushes.
void leaveOutWeight(const HandModel& model, const Grip& grip, const HandMapping& mapping, const Pose& X_BD,
                    EnergyAccounts& accounts) noexcept {
    EnergyAccount& account = accounts.energy;
    Pose X = believedPose(X_BD, account.ahead);
    if (mapping.offset.moved) X.q = X.q * mapping.offset.Q;  // the part's turn in the handle
    if (account.has_sample) {
        const double of_weight = (liftEnergy(account.hanging, X) - account.lifted) * account.weighed / account.ticks;
        account.taken_in -= of_weight;
        accounts.pairs.back().taken_in -= of_weight;
    }
    account.hanging = hangingOf(model, grip);
    account.lifted = liftEnergy(account.hanging, X);
    account.weighed = 0.0;
}

}  // namespace

void observeEnergy(const HandModel& model, const InputGuard& guard, const HandSample& hand, const Grip& grip,
                   const HandMapping& mapping, const SentWrench& sent, EnergyAccounts& accounts,
                   EnergyRecord& record) noexcept {
    EnergyAccount& account = accounts.energy;
    account.sent.force += sent.last_sent.force;
    account.sent.torque += sent.last_sent.torque;
    ++account.ticks;
    account.weighed += sent.weighed;
    for (const std::uint32_t i : sent.last_shares.held()) {
        accounts.pairs[i].sent.force += sent.last_shares[i].force;
        accounts.pairs[i].sent.torque += sent.last_shares[i].torque;
    }
    if (!hand.input_usable) {
        account.has_sample = false;
        account.V_BD = account.ahead = Twist{};
    } else if (hand.sample_periods > 0) {
        const Pose& X = guard.X_BD_good;
        const bool weighs = model.hasWeight() || account.weighed > 0;  // or did, until it was let go
        if (account.has_sample) {
            const Vec3 dx = X.p - account.X_BD.p;
            const Vec3 dphi = rotationVector(X.q * account.X_BD.q.conjugate());
            const Vec3 moved = certainMotion(dx, model.limits.quantum, account.ahead.v);
            const Vec3 turned = certainMotion(dphi, model.limits.rotational_quantum, account.ahead.w);
            account.taken_in -= (account.sent.force.dot(moved) + account.sent.torque.dot(turned)) / account.ticks;
            if (weighs) leaveOutWeight(model, grip, mapping, X, accounts);
            bookPairs(accounts, moved, turned, account.ticks);
            const double elapsed = kTickSeconds * static_cast<double>(hand.sample_periods);
            account.V_BD = {dx / elapsed, dphi / elapsed};
        } else if (weighs) {
            leaveOutWeight(model, grip, mapping, X, accounts);
        }
        account.X_BD = X;
        account.has_sample = true;
        account.sent = Wrench{};
        for (const std::uint32_t i : accounts.pairs.held()) accounts.pairs[i].sent = Wrench{};
        accounts.pairs.letGo();
        account.ticks = 0;
    }
    record.energy = account.taken_in;
}

void dampActivity(const HandModel& model, const HandSample& hand, const Grip& grip, const EnergyAccounts& accounts,
                  HandWrench& wrench, Report& report) noexcept {
    const EnergyAccount& account = accounts.energy;
    // On a held tick nothing new is known, and what was asked back is on its way.
    if (!(account.taken_in < 0.0) || hand.sample_periods == 0) return;
    const double rho2 = model.metric_radius * model.metric_radius;
    const double square = account.V_BD.v.squaredNorm() + rho2 * account.V_BD.w.squaredNorm();
    if (!(square > 0.0)) return;
    const double alpha = std::min(-account.taken_in / (kTickSeconds * square), model.effects.passivity_damping);
    const Wrench damper{-alpha * account.V_BD.v, -alpha * rho2 * account.V_BD.w};
    const Wrench F_H_W = wrenchOnHeldPart(model, hand, grip, damper);
    wrench.F_H_W.force += F_H_W.force;
    wrench.F_H_W.torque += F_H_W.torque;
    report.status |= kPassivityActed;
}

}  // namespace passung::tick
