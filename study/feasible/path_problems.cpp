#include "study/feasible/path_problems.h"

#include <fmt/format.h>

#include <variant>

#include "study/plan/scene_parts.h"

namespace passung::feasible {

namespace {

/// Everything but the part that moves.
std::vector<StandingPart> othersThan(std::size_t part, const std::vector<Pose>& X_WP) {
    std::vector<StandingPart> standing;
    for (std::size_t i = 0; i < X_WP.size(); ++i)
        if (i != part) standing.push_back({i, X_WP[i]});
    return standing;
}

/// `asked`: in the order of the scene's.
std::vector<PathProblem> assemblyProblems(const scene::SceneSpec& scene, const std::vector<plan::AskedStep>& asked) {
    std::vector<PathProblem> problems;
    std::vector<Pose> X_WP;
    for (const scene::PartSpec& part : scene.parts) X_WP.push_back(part.X_WP);
    const auto& steps = scene.effects.pick.steps;
    for (const std::size_t i : scene::orderOf(steps)) {
        const scene::AssemblyStep& step = steps[i];
        const Pose X_start = X_WP[step.part];
        const Pose X_goal = scene::nearestGoal(X_start, scene::goalOf(step, X_WP), step.folds);
        problems.push_back({asked[i].name, step.part, X_start, X_goal, othersThan(step.part, X_WP)});
        X_WP[step.part] = X_goal;
    }
    return problems;
}

std::vector<PathProblem> pegProblems(const plan::Condition& condition, const plan::PegInHoleTask& task) {
    const scene::SceneSpec& scene = condition.scene;
    const scene::PartSpec* target = plan::partNamed(scene, condition.task.target);
    const std::size_t held = scene.heldBy(0);
    if (target == nullptr || held == scene.parts.size()) return {};
    std::vector<Pose> X_WP;
    for (const scene::PartSpec& part : scene.parts) X_WP.push_back(part.X_WP);
    const Pose X_goal =
        plan::judgedFrame(condition.task, target->X_WP) * Pose{Quat::Identity(), Vec3(0.0, 0.0, -task.insertion_depth)};
    return {{scene.parts[held].name, held, scene.parts[held].X_WP, X_goal, othersThan(held, X_WP)}};
}

std::string poseText(const Pose& X) {
    return fmt::format(" {:a} {:a} {:a} {:a} {:a} {:a} {:a}", X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(),
                       X.q.z());
}

std::string partText(const scene::PartSpec& part) {
    if (const auto* file = std::get_if<scene::MeshFile>(&part.geometry))
        return fmt::format("{} {:a}", file->path, file->metres_per_unit);
    const auto& shape = std::get<shape::Shape>(part.geometry);
    std::string text = shape::kindName(shape);
    for (const double value : shape::dimensions(shape)) text += fmt::format(" {:a}", value);
    return text;
}

}  // namespace

std::vector<PathProblem> problemsOf(const plan::Condition& condition) {
    if (const auto* assembly = std::get_if<plan::AssemblyTask>(&condition.task.form))
        return assemblyProblems(condition.scene, assembly->steps);
    if (const auto* peg = std::get_if<plan::PegInHoleTask>(&condition.task.form)) return pegProblems(condition, *peg);
    return {};
}

std::string geometryText(const scene::SceneSpec& scene, const std::vector<PathProblem>& problems) {
    std::string text;
    for (const scene::PartSpec& part : scene.parts)
        text += part.name + " " + partText(part) + poseText(part.X_WP) + "\n";
    for (const PathProblem& problem : problems)
        text += problem.name + poseText(problem.X_WStart) + poseText(problem.X_WGoal) + "\n";
    return text;
}

}  // namespace passung::feasible
