#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/design/trial_order.h"
#include "study/plan/frozen_plan.h"
#include "study/session/instruction_reader.h"
#include "study/session/questionnaire_source.h"
#include "study/session/resume.h"
#include "study/session/trial_sink.h"
#include "study/session/trial_timer.h"

namespace passung::session {

struct SessionSetup {
    plan::FrozenPlan plan;
    std::vector<design::PlannedTrial> trials;  // what is to be done, in this order
    std::string participant;                   // code
    std::uint64_t seed = 0;                    // of the study
    bool timing_measured = true;               // false in virtual time
    int ordinal = 1;                           // number of the participant's session
    bool waits = false;                        // for the command Start, and for Continue when a device is swapped
    std::optional<Resumption> resumed = {};    // goes on from there; none: begins
    QuestionnaireSource* answers = nullptr;    // who answers; may stay null if the plan has no questionnaire
    TrialTimer* timer = nullptr;               // of trials that the experimenter times; null: commands do it
    std::string language = {};                 // of instructions; empty: the first that they have
    InstructionReader* reader = nullptr;       // of instructions; null: they are logged as not shown
    /// Time of a device's calibration on this machine [UTC], empty: never. Without it (virtual time) nothing is said.
    std::function<std::string(const std::string& device)> calibrated_utc = {};
    bool shown = false;  // in a window, whose look is logged
};

}  // namespace passung::session
