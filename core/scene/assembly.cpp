#include "core/scene/assembly.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/scene_spec.h"

namespace passung::scene {

GoalError goalError(const Pose& X_WP, const Pose& X_WGoal, int folds) noexcept {
    const Quat turn = X_WGoal.q.conjugate() * X_WP.q;
    GoalError error{(X_WP.p - X_WGoal.p).norm(), 0.0};
    if (folds == 0) {
        const Vec3 axis = turn * Vec3::UnitZ();
        error.angle = std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
        return error;
    }
    error.angle = std::numbers::pi;
    for (int i = 0; i < folds; ++i) {
        const double half = std::numbers::pi * i / folds;
        const Quat left = turn * Quat(std::cos(half), 0.0, 0.0, -std::sin(half));
        error.angle = std::min(error.angle, 2.0 * std::atan2(left.vec().norm(), std::abs(left.w())));
    }
    return error;
}

Pose nearestGoal(const Pose& X_WP, const Pose& X_WGoal, int folds) noexcept {
    if (folds == 1) return X_WGoal;
    // |w cos + z sin| of the turn that is left is largest at this angle: the twist of what is between the two.
    const Quat between = X_WGoal.q.conjugate() * X_WP.q;
    double angle = 2.0 * std::atan2(between.z(), between.w());
    if (folds > 1) {
        const double part = 2.0 * std::numbers::pi / folds;
        angle = part * std::round(angle / part);
    }
    return {X_WGoal.q * rotationFromVector(Vec3(0.0, 0.0, angle)), X_WGoal.p};
}

Pose goalOf(const AssemblyStep& step, std::span<const Pose> X_WP) noexcept {
    return step.into == AssemblyStep::kWorld ? step.X_IGoal : X_WP[step.into] * step.X_IGoal;
}

bool isAtGoal(const AssemblyStep& step, std::span<const Pose> X_WP) noexcept {
    const GoalError error = goalError(X_WP[step.part], goalOf(step, X_WP), step.folds);
    return error.position <= step.position_tolerance && error.angle <= step.angle_tolerance;
}

std::vector<std::size_t> orderOf(std::span<const AssemblyStep> steps) {
    std::vector<std::size_t> order;
    StepSet known = 0;
    for (bool found = true; found;) {
        found = false;
        for (std::size_t i = 0; i < steps.size() && !found; ++i) {
            if ((known & stepBit(i)) != 0 || (steps[i].after & ~known) != 0) continue;
            order.push_back(i);
            known |= stepBit(i);
            found = true;
        }
    }
    return order;
}

namespace {

/// The steps that come before this one, by way of others too. @pre no step waits for itself
StepSet allBefore(std::span<const AssemblyStep> steps, std::size_t step) {
    StepSet before = steps[step].after;
    for (bool grew = true; grew;) {
        const StepSet known = before;
        for (std::size_t i = 0; i < steps.size(); ++i)
            if ((known & stepBit(i)) != 0) before |= steps[i].after;
        grew = before != known;
    }
    return before;
}

/// Why a goal cannot be in this part's frame; empty if it can.
std::string problemOfInto(std::span<const AssemblyStep> steps, std::size_t step, const SceneSpec& spec) {
    const std::size_t into = steps[step].into;
    if (into == steps[step].part) return "must be another part";
    if (!spec.parts[into].moves()) return {};
    const StepSet before = allBefore(steps, step);
    for (std::size_t i = 0; i < steps.size(); ++i)
        if ((before & stepBit(i)) != 0 && steps[i].part == into && steps[i].locks) return {};
    return "must rest: a part that no hand moves, or one that a step before this locks";
}

}  // namespace

std::vector<StepProblem> problemsOf(std::span<const AssemblyStep> steps, const SceneSpec& spec) {
    std::vector<StepProblem> problems;
    if (steps.size() > kMostSteps) return {{kMostSteps, "part", "is one step too many: an assembly has at most 63"}};
    const StepSet all = steps.empty() ? 0 : ~StepSet{0} >> (64 - steps.size());
    const auto require = [&](bool fulfilled, std::size_t i, std::string_view key, const char* message) {
        if (!fulfilled) problems.push_back({i, key, message});
    };
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const AssemblyStep& step = steps[i];
        require(step.part < spec.parts.size() && spec.parts[step.part].pickable, i, "part", "must be pickable");
        require(step.into == AssemblyStep::kWorld || step.into < spec.parts.size(), i, "into", "must be a part");
        require(isFinite(step.X_IGoal), i, "position", "must be finite");
        require(step.position_tolerance > 0.0 && std::isfinite(step.position_tolerance), i, "position_tolerance",
                "must be > 0");
        require(step.angle_tolerance > 0.0 && std::isfinite(step.angle_tolerance), i, "angle_tolerance", "must be > 0");
        require(step.folds >= 0, i, "folds", "must be ≥ 0");
        require((step.after & ~all) == 0, i, "after", "must be steps of the assembly");
        for (std::size_t other = 0; other < i; ++other)
            require(steps[other].part != step.part, i, "part", "belongs to another step already");
    }
    if (!problems.empty()) return problems;
    const std::vector<std::size_t> order = orderOf(steps);
    for (std::size_t i = 0; i < steps.size(); ++i)
        require(std::find(order.begin(), order.end(), i) != order.end(), i, "after",
                "makes steps wait for each other: none of them can be the first");
    if (!problems.empty()) return problems;
    std::vector<Pose> X_WP;
    for (const PartSpec& part : spec.parts) X_WP.push_back(part.X_WP);
    for (const std::size_t i : order) {
        if (steps[i].into != AssemblyStep::kWorld)
            if (std::string why = problemOfInto(steps, i, spec); !why.empty())
                problems.push_back({i, "into", std::move(why)});
        require(!isAtGoal(steps[i], X_WP), i, "position", "must be another pose than the part's start");
        X_WP[steps[i].part] = goalOf(steps[i], X_WP);
    }
    return problems;
}

}  // namespace passung::scene
