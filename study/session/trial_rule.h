#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "study/measures/assembly_watch.h"
#include "study/measures/contour_watch.h"
#include "study/measures/hint_watch.h"
#include "study/measures/measures.h"
#include "study/measures/pair_watch.h"
#include "study/measures/passage_watch.h"
#include "study/plan/study_plan.h"
#include "study/session/success_rule.h"

namespace passung::session {

enum class TrialState { AwaitingStart, Running, Succeeded, Failed, TimedOut, Aborted };

/// Something that happened in a trial: trial_started, first_contact, success, failure, timeout, aborted; and by its
/// type engaged (the tip is in the bore), passage_entered, interval_started, interval_ended (of a pair; its first
/// interval begins with trial_started); of an assembly step_state, part_let_go, order_error, step_undone, hint_shown.
struct TrialEvent {
    std::int64_t time = 0;  // haptic periods since the attempt's tick 0: ticks and missed cycles
    const char* name = "";
    std::optional<measures::StepChange> step = {};  // of an assembly, that it is about
};

/// How a trial of a type ends, decided record by record from its start tick on:
/// - peg_in_hole: SuccessRule;
/// - narrow_passage: success once the held part is through (measures::PassageWatch);
/// - contour_following: success once the asked share is followed (measures::ContourWatch);
/// - free_placement: a button of the device that no effect has confirms; success within both tolerances, else failure;
/// - assembly: success once all steps are done (measures::AssemblyWatch);
/// - discrimination_pair: success with the answer, whichever it is; timeout if it does not come in time; aborted if the
///   hand does not come back to the start between the intervals.
/// Time-outs of the others are the course's.
class TrialRule {
public:
    /// `X_WT`: targetPose() of the condition; `attempt_seed`: AttemptStart::seed.
    TrialRule(const plan::Task& task, const scene::SceneSpec& scene, const Pose& X_WT, std::uint64_t attempt_seed);

    /// How it ends at this record, if it does; appends what happened. `time`: of the record [periods]. `hands`: as
    /// recorded of each hand, where they are looked at (assembly).
    std::optional<TrialState> follow(const TickRecord& record, std::span<const TickRecord* const> hands,
                                     std::int64_t time, std::vector<TrialEvent>& events);

    /// A tick before the trial's start: hands may pick parts up then.
    void await(std::span<const TickRecord* const> hands, std::int64_t time);

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
    struct Assembly {
        std::vector<std::optional<double>> free_paths;  // of each step [m]
        measures::AssemblyWatch watch;
        measures::HintWatch hints;
        std::vector<std::int64_t> hinted;        // how often to each step
        std::optional<std::int64_t> start = {};  // time of the first record
    };
    static Assembly makeAssembly(const plan::AssemblyTask& task, const scene::SceneSpec& scene);
    using AnyRule = std::variant<Insertion, Passage, Contour, Placement, Pair, Assembly>;
    using Verdict = std::optional<TrialState>;

    static AnyRule makeRule(const plan::Task& task, const scene::SceneSpec& scene, const Pose& X_WT,
                            std::uint64_t attempt_seed);
    Verdict judge(Insertion& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;
    Verdict judge(Passage& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;
    Verdict judge(Contour& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;
    Verdict judge(Placement& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;
    Verdict judge(Pair& form, const TickRecord& record, std::int64_t time, std::vector<TrialEvent>& events) const;
    static Verdict judge(Assembly& form, std::span<const TickRecord* const> hands, std::int64_t time,
                         std::vector<TrialEvent>& events);

    Pose X_WT_;
    AnyRule form_;
};

}  // namespace passung::session
