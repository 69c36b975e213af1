#pragma once

#include <span>
#include <vector>

#include "analysis/truth/exact_overlap.h"
#include "core/base/tick_record.h"
#include "study/measures/measures.h"
#include "study/run/files/built_scenes.h"

namespace passung::run {

/// Judges by exact geometry, off the tick, how deep what a trial showed truly overlapped. What it makes of parts is
/// kept from trial to trial.
class ShownOverlap {
public:
    /// Fills in depth and bound of `ticks`. `trial`: records of one attempt from its start tick on, from which follows
    /// which of the scenes a tick belongs to, or from tick 0 on, so that parts are where hands left them before;
    /// `others`: of its other hands, whose parts are obstacles that move. The work is bounded, by counts and not by
    /// time: the same records give the same. False: no scene has an obstacle.
    bool measure(const BuiltScenes& scenes, std::span<const TickRecord> trial,
                 std::span<const std::vector<TickRecord>> others, std::span<measures::TickOverlap> ticks);

private:
    truth::OverlapBodies bodies_;
};

}  // namespace passung::run
