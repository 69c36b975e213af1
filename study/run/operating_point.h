#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "study/plan/study_plan.h"
#include "study/run/machine/tick_front.h"

namespace passung::run {

/// What became of a setting that a study was to be rendered by from now on.
struct OperatingPoint {
    enum class Outcome {
        Written,       // `plan` is what the file says now
        SaidAlready,   // nothing had to be written
        FileChanged,   // the file, or one that it includes, is not the one that was measured
        Begun,         // the study's database has sessions, or its protocol: what they ran by stays
        SetElsewhere,  // a factor's levels, a block or a staircase sets a key: `problem` has its place
        Refused        // `problem` says why
    };
    Outcome outcome = Outcome::Refused;
    std::optional<plan::StudyPlan> plan;
    Error problem;
};

/// Writes what `setting` needs into [scene.contact] of the study's file, and nothing else: the file reads then as the
/// setting for this condition. The other conditions get the same keys, as far as their levels do not set them. `plan`:
/// as it was measured; `database`: of the study's sessions, which need not exist.
OperatingPoint useSetting(const plan::StudyPlan& plan, std::size_t condition, const TickFront& front,
                          const truth::TickSetting& setting, const std::string& database);

}  // namespace passung::run
