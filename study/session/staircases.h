#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/design/adaptive.h"
#include "study/design/trial_order.h"
#include "study/measures/measures.h"
#include "study/plan/study_plan.h"
#include "study/session/staircase_step.h"
#include "study/session/trial_sink.h"

namespace passung::session {

/// An answer that a track was told.
struct ToldStep {
    AttemptId attempt;
    std::size_t staircase = 0;  // index into the plan's
    std::size_t condition = 0;  // as planned
    std::string track;
    double level = 0.0;  // as presented
    bool positive = false;
};

/// The staircases of one session. What a trial presents follows from the seed, the trial and the answers that count, in
/// the order of their attempts: whoever knows those knows the state, so that a resumed session goes on as the
/// uninterrupted one.
class Staircases {
public:
    /// The plan outlives this.
    Staircases(const plan::StudyPlan& plan, std::string participant, std::uint64_t seed, int ordinal);

    bool governs(const design::PlannedTrial& trial) const { return find(trial) != nullptr; }

    /// What the trial presents; nothing if all tracks of its condition are finished: it is left out. @pre
    /// governs(trial)
    std::optional<StaircaseStep> next(const design::PlannedTrial& trial) const;

    /// False of trials of a staircase whose tracks are all finished.
    bool needs(const design::PlannedTrial& trial) const;

    /// What the trial's measures say to its track; nothing if they lack the staircase's. @pre governs(trial)
    std::optional<bool> answerTo(const design::PlannedTrial& trial, const std::vector<measures::Value>& measures) const;

    /// Takes the attempt's answer, if it `counts` and has one. @pre `step` was next() of the trial
    StaircaseAnswer take(AttemptId attempt, const design::PlannedTrial& trial, const StaircaseStep& step,
                         const std::vector<measures::Value>& measures, bool counts);

    /// An answer of an earlier part of the session. Ascending by attempt.
    void restore(ToldStep told);
    /// The attempt's answer no longer counts: its track is as if it had not been given.
    void forget(AttemptId attempt);

private:
    const plan::Staircase* find(const design::PlannedTrial& trial) const;
    using Tracks = std::vector<design::AdaptiveTrack>;
    Tracks& tracks(const plan::Staircase& staircase, std::size_t condition) const;
    bool isCatch(const plan::Staircase& staircase, const design::PlannedTrial& trial) const;

    const plan::StudyPlan& plan_;
    std::string participant_;
    std::uint64_t seed_;
    int ordinal_;
    std::vector<ToldStep> told_;
    mutable std::map<std::pair<std::size_t, std::size_t>, Tracks>
        tracks_;  // by staircase, condition; follows from told_
};

}  // namespace passung::session
