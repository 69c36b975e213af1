#pragma once

#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "study/plan/study_plan.h"

namespace passung::session {

/// Which interval of a discrimination pair, 1 or 2, has the comparison: drawn from the attempt's seed
/// (AttemptStart::seed, which is stored), so that a repeated attempt tells nothing of the one before.
int comparisonInterval(std::uint64_t attempt_seed);

/// A scene and for how long it is rendered.
struct RenderedScene {
    scene::SceneSpec spec;
    std::int64_t periods;  // from the tick at which its start gate opens; the last one stays
};

/// What an attempt renders, one scene after the other: of a pair the two intervals and then, while the answer is
/// awaited, nothing (the second one behind a start gate that never opens); of every other trial the condition's scene.
std::vector<RenderedScene> renderedScenes(const plan::Condition& condition, std::uint64_t attempt_seed);

/// The pose that the trial is about: of its target, or the goal of a placement. Errors: there is no such part.
Result<Pose> targetPose(const plan::Condition& condition);

}  // namespace passung::session
