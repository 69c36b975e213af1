#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "study/measures/contour_watch.h"
#include "study/measures/measures.h"
#include "study/measures/pair_watch.h"
#include "study/measures/passage_watch.h"
#include "study/plan/study_plan.h"
#include "study/session/success_rule.h"

namespace passung::session {

enum class TrialState { AwaitingStart, Running, Succeeded, Failed, TimedOut, Aborted };

/// Something that happened in a trial: trial_started, first_contact, success, failure, timeout, aborted; and by its
/// type engaged (the tip is in the bore), passage_entered, interval_started, interval_ended (of a pair; its first
/// interval begins with trial_started).
struct TrialEvent {
    std::int64_t time = 0;  // haptic periods since the attempt's tick 0: ticks and missed cycles
    const char* name = "";
};

/// How a trial of a type ends, decided record by record from its start tick on:
/// - peg_in_hole: SuccessRule;
/// - narrow_passage: success once the held part is through (measures::PassageWatch);
/// - contour_following: success once the asked share is followed (measures::ContourWatch);
/// - free_placement: a button of the device that no effect has confirms; success within both tolerances, else failure;
/// - discrimination_pair: success with the answer, whichever it is; timeout if it does not come in time; aborted if the
///   hand does not come back to the start between the intervals.
/// Time-outs of the others are the course's.
class TrialRule {
public:
    /// `X_WT`: targetPose() of the condition; `attempt_seed`: AttemptStart::seed.
    TrialRule(const plan::Task& task, const Pose& X_WT, std::uint64_t attempt_seed);

    /// How it ends at this record, if it does; appends what happened. `time`: of the record [periods].
    std::optional<TrialState> follow(const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events);

    /// Tells whether the type has a time-out of its own.
    bool timesItself() const { return std::holds_alternative<Pair>(form_); }

    /// Adds what its measures need to know.
    void describe(measures::TrialContext& context) const;

private:
    struct Insertion {
        plan::PegInHoleTask task;
        SuccessRule rule;
        bool engaged = false;
    };
    struct Passage {
        measures::PassageFacts facts;
        measures::PassageWatch watch;
    };
    struct Contour {
        measures::ContourFacts facts;
        double coverage;
        measures::ContourWatch watch;
    };
    struct Placement {
        plan::FreePlacementTask task;
        measures::ButtonWatch buttons;
    };
    struct Pair {
        std::int64_t answer_periods;
        int comparison_interval;
        measures::PairWatch watch;
    };
    using AnyRule = std::variant<Insertion, Passage, Contour, Placement, Pair>;
    using Verdict = std::optional<TrialState>;

    static AnyRule makeRule(const plan::Task& task, const Pose& X_WT, std::uint64_t attempt_seed);
    Verdict judge(Insertion& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;
    Verdict judge(Passage& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;
    Verdict judge(Contour& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;
    Verdict judge(Placement& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;
    Verdict judge(Pair& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;

    Pose X_WT_;
    AnyRule form_;
};

}  // namespace passung::session
