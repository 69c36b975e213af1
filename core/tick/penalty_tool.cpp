#include "core/tick/penalty_tool.h"

#include <algorithm>
#include <cmath>

#include "core/tick/contact_energy.h"
#include "core/tick/god_object.h"
#include "core/tick/obstacle_query.h"
#include "core/tick/penalty.h"
#include "core/tick/proxy.h"

namespace passung::tick {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kRounds = 12;  // of Newton's method on the linearised contacts

/// A x = b for A symmetric, positive definite (Cholesky, in a fixed order of operations).
motion::Motion solved(Matrix6 A, motion::Motion b) noexcept {
    for (int j = 0; j < 6; ++j) {
        for (int k = 0; k < j; ++k) A(j, j) -= A(j, k) * A(j, k);
        A(j, j) = std::sqrt(A(j, j));
        for (int i = j + 1; i < 6; ++i) {
            for (int k = 0; k < j; ++k) A(i, j) -= A(i, k) * A(j, k);
            A(i, j) /= A(j, j);
        }
    }
    for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < i; ++k) b[i] -= A(i, k) * b[k];
        b[i] /= A(i, i);
    }
    for (int i = 5; i >= 0; --i) {
        for (int k = i + 1; k < 6; ++k) b[i] -= A(k, i) * b[k];
        b[i] /= A(i, i);
    }
    return b;
}

/// The equation of one tick: penalty_tool.h.
class ToolBalance {
public:
    ToolBalance(const HandModel& model, const HandSample& hand, const HeldTarget& target, const Proxy& proxy,
                const ToolMotion& tool) noexcept
        : model_(model), metric_(target.metric), X_WT_(target.X_WT), X_before_(proxy.X_WG), law_(model.contact) {
        const scene::ContactSpec& c = model.contact;
        law_.stiffness = c.penalty_stiffness;
        if (c.coupling != scene::PenaltyCoupling::Virtual) return;
        const double K = c.stiffness, turn = K * metric_.radius * metric_.radius;
        damper_ = split(c.damping / K, c.rotational_damping / turn) / kTickSeconds;
        inertia_ = split(c.tool_mass / K, c.tool_inertia / turn) / (kTickSeconds * kTickSeconds);
        stiff_ += damper_ + inertia_;
        last_ = tool.last;
        if (tool.has_last_hand) hand_ = metric_.between(tool.X_WH_last, hand.X_WH);
    }

    /// Takes up what is known around the tool.
    void update(const Proxy& proxy) noexcept {
        const PenaltyLoad load = penaltyLoad(law_, proxy.manifold, metric_.centre(proxy.X_WG));
        scale_ = load.scale / model_.contact.stiffness;
        motion::Motion push;
        push << load.wrench.force, load.wrench.torque / metric_.radius;
        stretch = metric_.between(proxy.X_WG, X_WT_);
        const motion::Motion U = way(proxy);
        open = stretch + push / model_.contact.stiffness + damper_.cwiseProduct(hand_ - U) +
               inertia_.cwiseProduct(last_ - U);
    }

    /// The tool's motion in this tick so far.
    motion::Motion way(const Proxy& proxy) const noexcept { return metric_.between(X_before_, proxy.X_WG); }
    const scene::ContactSpec& law() const noexcept { return law_; }
    double size() const noexcept { return open.cwiseQuotient(stiff_).norm(); }
    /// How far the tool may end from the hand where contacts push it away.
    double longestStretch() const noexcept {
        const double drift = (model_.contact.coupling == scene::PenaltyCoupling::Virtual) ? last_.norm() : 0.0;
        return stretch.norm() + drift + kRepair * model_.finest_cell;
    }

    /// The motion that solves the linearised equation.
    motion::Motion step(const contact::ContactManifold& contacts, const Pose& X_WG) const noexcept {
        motion::Motion u = motion::Motion::Zero();
        for (int round = 0; round < kRounds; ++round) {
            Matrix6 A = stiff_.asDiagonal();
            motion::Motion b = open;
            for (const contact::ContactPoint& contact : contacts) {
                const double depth = -contact.phi;
                const motion::Motion a = metric_.at(X_WG).rowOf(contact.position, contact.gradient);
                const double sigma =
                    scale_ * (law_.variant == scene::PenaltyVariant::AreaWeighted ? contact.area : 1.0);
                if (depth > 0.0) b -= sigma * depth * a;
                if (!(depth - a.dot(u) > 0.0)) continue;
                A += (sigma * a) * a.transpose();
                b += sigma * depth * a;
            }
            const motion::Motion next = solved(A, b);
            const bool same = (next - u).norm() < kSettled;
            u = next;
            if (same) break;
        }
        return u;
    }

    motion::Motion stretch = motion::Motion::Zero(), open = motion::Motion::Zero();  // w and q

private:
    static motion::Motion split(double translation, double rotation) noexcept {
        motion::Motion both;
        both << Vec3::Constant(translation), Vec3::Constant(rotation);
        return both;
    }

    const HandModel& model_;
    const motion::Metric& metric_;
    const Pose& X_WT_;  // where the spring draws the tool
    const Pose X_before_;
    scene::ContactSpec law_;  // of the contacts
    motion::Motion stiff_ = motion::Motion::Ones(), damper_ = motion::Motion::Zero(), inertia_ = motion::Motion::Zero();
    double scale_ = 0.0;  // of penaltyLoad, per K
    motion::Motion last_ = motion::Motion::Zero(), hand_ = motion::Motion::Zero();
};

/// Puts the tool at `X_WG` and looks around: points nearer than `reach`, and up to `search` how far the nearest is.
void lookAt(const ProxyView& view, const Pose& X_WG, double reach, double search) noexcept {
    const auto& [model, proxy, memory, report, obstacles] = view;
    proxy.manifold.clear();
    const contact::QueryRequest request{
        .collect_below = reach, .search_below = std::max(reach, search), .refine = true};
    const contact::QueryAnswer answer =
        queryObstacles(model, obstacles, X_WG, request, memory.workspace, proxy.manifold, memory.around_proxy);
    account(answer, report);
    proxy.X_WG = X_WG;
    proxy.manifold_reach = reach;
    proxy.clearance = proxy.clearance_bound = answer.phi;
    noteObstacles(view);
}

void startTool(const ProxyView& view, const HandSample& hand, ToolMotion& tool) noexcept {
    Proxy& proxy = view.proxy;
    if (hand.relocated) {
        proxy.X_WG = hand.X_WH;
        proxy.manifold_reach = -1.0;
        tool.has_last_hand = false;
        tool.last = motion::Motion::Zero();
    }
    forgetMoved(view);
    const double reach = kLongestStep * view.model.finest_cell;
    if (proxy.manifold_reach < 0.0) lookAt(view, proxy.X_WG, reach, reach);
}

/// The share of `u` after which the stretch, now w, is no longer than `longest`.
double shareWithin(double longest, const motion::Motion& w, const motion::Motion& u) noexcept {
    const double square = u.squaredNorm(), along = w.dot(u);
    const double room = std::max(0.0, longest * longest - w.squaredNorm());
    if (!((w - u).norm() > longest)) return 1.0;
    return (along + std::sqrt(along * along + square * room)) / square;
}

/// Moves by `u`, or as much of it as makes the balance's rest smaller; false, and the tool stays, if none does.
bool makeStep(const ProxyView& view, const motion::Metric& metric, ToolBalance& balance, const motion::Motion& u,
              double reach, double search) noexcept {
    const auto& [model, proxy, memory, report, obstacles] = view;
    const Pose X_here = proxy.X_WG;
    const double before = balance.size();
    double share = 1.0;
    for (int half = 0; half <= kHalvings; ++half, share *= 0.5) {
        lookAt(view, metric.moved(X_here, share * u), reach, search);
        balance.update(proxy);
        if (balance.size() < before) return true;
        report.status |= kStepRejected;
    }
    lookAt(view, X_here, reach, reach);
    balance.update(proxy);
    return false;
}

}  // namespace

void settleTool(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                const ObstaclePoses& obstacles, Proxy& proxy, ToolMotion& tool, QueryMemory& memory, Pushes& pushes,
                Report& report) noexcept {
    const ProxyView view{model, proxy, memory, report, obstacles};
    startTool(view, hand, tool);
    ToolBalance balance(model, hand, target, proxy, tool);
    balance.update(proxy);
    const double longest = balance.longestStretch(), half_cell = kLongestStep * model.finest_cell;
    const double reach = nextReach(model, tool.last_way);
    bool settled = false, held_back = false;
    for (int i = 0; i < kToolSteps; ++i) {
        settled = balance.size() < kSettled;
        if (settled) break;
        motion::Motion u = balance.step(proxy.manifold, proxy.X_WG);
        const double path = target.metric.wayOf(u, model.shell->reach()),
                     farthest = std::max(0.0, proxy.clearance) + half_cell;
        if (path > farthest) u *= farthest / path;
        const double share = shareWithin(longest, balance.stretch, u);
        held_back = share < 1.0;
        report.iterations = static_cast<std::uint32_t>(i + 1);
        if (!makeStep(view, target.metric, balance, share * u, reach, path)) break;
    }
    if (!settled && !(balance.size() < kSettled)) report.status |= kIterationLimit;
    const motion::Motion way = balance.way(proxy);
    tool.last_way = way.norm();
    tool.last = held_back ? motion::Motion::Zero() : way;
    tool.X_WH_last = hand.X_WH;
    tool.has_last_hand = true;
    clearPushes(pushes);
    penaltyWrench(balance.law(), proxy.manifold, proxy.X_WG.p, &pushes.pushes);
}

}  // namespace passung::tick
