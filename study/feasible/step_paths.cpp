#include "study/feasible/step_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "core/path/search/path_search.h"

namespace passung::feasible {

namespace {

using StepParts = std::vector<std::shared_ptr<const scene::Part>>;

/// Do closed forms tell of the room of all pairs?
bool inClosedForm(const scene::SceneSpec& scene, const PathProblem& problem) {
    return std::all_of(problem.standing.begin(), problem.standing.end(), [&](const StandingPart& other) {
        return path::inClosedForm(scene.parts[problem.part], scene.parts[other.part]);
    });
}

Result<StepParts> build(const scene::SceneSpec& scene, bool closed_form, scene::PartCache& cache) {
    StepParts parts;
    for (const scene::PartSpec& part : scene.parts) {
        auto built = cache.get(part, {.clusters = !closed_form});
        if (!built) return built.errors();
        parts.push_back(*std::move(built));
    }
    return parts;
}

/// Which part the moving one overlaps at an end of the path, and how deep; nothing if it does not.
std::optional<std::string> overlapAt(const Pose& X, const char* end, const scene::SceneSpec& scene,
                                     const PathProblem& problem, const StepParts& parts, truth::OverlapBodies& bodies) {
    const auto& moving = bodies.of(*parts[problem.part]);
    for (const StandingPart& other : problem.standing) {
        const auto& standing = bodies.of(*parts[other.part]);
        const truth::Overlap overlap = truth::overlapOf(*moving.body, X, *standing.body, other.X_WP,
                                                        {.tolerance = kTouch, .share = 0.02, .ignore = kTouch});
        if (overlap.depth > kTouch)
            return fmt::format("the {} itself overlaps {} by {:.4g} µm (proof)", end, scene.parts[other.part].name,
                               1e6 * overlap.depth);
    }
    return std::nullopt;
}

}  // namespace

void seed(const Settings& settings) { path::seedSearches(settings.seed); }

Result<StepPath> pathOf(const scene::SceneSpec& scene, const PathProblem& problem, scene::PartCache& cache,
                        truth::OverlapBodies& bodies, const Settings& settings) {
    const auto begin = std::chrono::steady_clock::now();
    const bool closed_form = inClosedForm(scene, problem);
    const auto parts = build(scene, closed_form, cache);
    if (!parts) return parts.errors();
    StepPath answer;
    answer.name = problem.name;
    answer.part = scene.parts[problem.part].name;
    auto overlap = overlapAt(problem.X_WGoal, "goal", scene, problem, *parts, bodies);
    if (!overlap) overlap = overlapAt(problem.X_WStart, "start", scene, problem, *parts, bodies);
    if (overlap) {
        answer.why = *std::move(overlap);
        answer.is_proof = true;
    } else {
        std::vector<path::RestingPart> standing;
        for (const StandingPart& other : problem.standing) standing.push_back({(*parts)[other.part].get(), other.X_WP});
        const path::FreeRoom room(*(*parts)[problem.part], std::move(standing), closed_form);
        auto found = path::findPath(room, problem.X_WStart, problem.X_WGoal, {settings.seconds});
        if (found) {
            answer.found = true;
            answer.poses = *std::move(found);
            answer.measures = path::measure(room, answer.poses);
            if (closed_form) answer.measures.proven = 0.0;  // a minimum between samples may not have been seen
            if (const auto at = answer.measures.least.standing)
                answer.nearest = scene.parts[problem.standing[*at].part].name;
        } else {
            answer.why = fmt::format("no path found within {:.3g} s (no proof)", settings.seconds);
        }
    }
    answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return answer;
}

}  // namespace passung::feasible
