#include "study/session/rendered_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/base/tick_record.h"
#include "study/plan/scene_parts.h"

namespace passung::session {

int comparisonInterval(std::uint64_t attempt_seed) {
    Random random(attempt_seed ^ fnv1a64("comparison interval"));
    return 1 + static_cast<int>(random.below(2));
}

std::vector<RenderedScene> renderedScenes(const plan::Condition& condition, std::uint64_t attempt_seed) {
    constexpr std::int64_t kToTheEnd = std::numeric_limits<std::int64_t>::max();
    const auto* pair = std::get_if<plan::DiscriminationPairTask>(&condition.task.form);
    if (pair == nullptr || !condition.comparison) return {{condition.scene, kToTheEnd}};
    const std::int64_t periods = std::llround(pair->interval / kTickSeconds);
    std::vector<RenderedScene> scenes{{condition.scene, periods}, {*condition.comparison, periods}};
    if (comparisonInterval(attempt_seed) == 1) std::swap(scenes[0], scenes[1]);
    scenes.push_back({scenes[1].spec, kToTheEnd});
    scenes[2].spec.start_gate.hold_ticks = std::numeric_limits<int>::max();
    for (scene::HandSpec& hand : scenes[2].spec.other_hands)
        hand.start_gate.hold_ticks = std::numeric_limits<int>::max();
    return scenes;
}

Result<Pose> targetPose(const plan::Condition& condition) {
    if (const auto* placement = std::get_if<plan::FreePlacementTask>(&condition.task.form)) return placement->X_WGoal;
    if (std::holds_alternative<plan::AssemblyTask>(condition.task.form)) return Pose{};  // each step has its own
    if (const auto* part = plan::partNamed(condition.scene, condition.task.target))
        return plan::judgedFrame(condition.task, part->X_WP);
    Error error;
    error.message = fmt::format("condition {} has no part of this name", condition.name);
    error.key = "target";
    error.value = condition.task.target;
    return error;
}

}  // namespace passung::session
