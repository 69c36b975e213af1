#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/design/trial_order.h"
#include "study/plan/study_plan.h"
#include "study/session/instruction_reader.h"
#include "study/session/trial_sink.h"

namespace passung::session {

/// Shows a session's instructions before its trials and after the last one, and logs who read each: event
/// "instruction", its source the reader; "instruction_not_shown" by "session" where nobody is there to show it.
class InstructionCourse {
public:
    /// `language`: of the texts; one that they do not have: their first. `reader` may be null. Everything outlives the
    /// desk.
    InstructionCourse(const plan::StudyPlan& plan, std::string language, bool timing_measured,
                      InstructionReader* reader, TrialSink& sink);

    /// Checks once the pages before the trial `next`, or (nullptr) after the last one: true while one is open.
    bool show(const design::PlannedTrial* next, std::int64_t session_ns);

private:
    std::vector<const plan::Instruction*> due(const design::PlannedTrial* next) const;
    Page pageOf(const plan::Instruction& instruction) const;
    void log(const plan::Instruction& instruction, const std::optional<PageRead>& read, std::int64_t session_ns) const;

    const plan::StudyPlan& plan_;
    std::string language_;
    bool timing_measured_;
    InstructionReader* reader_;
    TrialSink& sink_;
    bool begun_ = false;                    // the pages of the session's start have been read
    std::optional<std::int64_t> block_;     // the last one whose pages this run has shown
    std::optional<std::int64_t> open_for_;  // block before which the open pages stand; -1: the session's end
    std::size_t read_ = 0;                  // of these pages
    int pages_ = 0;                         // shown so far
};

}  // namespace passung::session
