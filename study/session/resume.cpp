#include "study/session/resume.h"

#include <fmt/format.h>

#include <algorithm>

namespace passung::session {
namespace {

using measures::Outcome;

/// Trials that are over and to be done again, in the plan's order.
std::vector<std::size_t> toRedo(const plan::ResumePolicy& policy, const Agenda& agenda) {
    std::vector<std::size_t> places;
    if (agenda.empty()) return places;
    const std::int64_t block = agenda.trial(agenda.next()).block_index;
    for (std::size_t place = 0; place < agenda.planned(); ++place) {
        const design::PlannedTrial& trial = agenda.trial(place);
        const bool practice =
            policy.redo_practice && trial.block_index < block && trial.phase == plan::phaseName(plan::Phase::Practice);
        const bool restarted = policy.restart_block && trial.block_index == block;
        if ((practice || restarted) && agenda.isOver(place)) places.push_back(place);
    }
    return places;
}

ToldStep toldStep(const plan::StudyPlan& plan, const StoredAttempt& attempt, const design::PlannedTrial& trial) {
    const auto staircase = std::find_if(plan.staircases.begin(), plan.staircases.end(),
                                        [&](const auto& known) { return known.name == attempt.step->staircase; });
    return {attempt.id,          static_cast<std::size_t>(staircase - plan.staircases.begin()),
            trial.condition,     attempt.step->track,
            attempt.step->level, attempt.step->positive};
}

/// Has the session's past happen to its order once more.
class Replay {
public:
    Replay(const plan::StudyPlan& plan, Resumption& result)
        : plan_(plan), result_(result), latest_(result.past.size()) {}

    void follow(const OrderStep& step) {
        const std::size_t place = placeOf(step.trial_index);
        if (step.attempt && step.decided_by == Decider::Protocol) ++result_.past[place].judged;
        result_.agenda.bring(place);
        result_.agenda.end(step.then);
        latest_[place] = step;
    }

    /// The protocol was content with this attempt, and later somebody was not.
    void followInvalidated(const StoredAttempt& attempt) {
        const OrderStep& latest = latest_[attempt.place];
        if (attempt.valid || latest.attempt != attempt.id || latest.decided_by != Decider::Protocol) return;
        if (!result_.agenda.isOver(attempt.place)) return;
        const Then then = thenAfterInvalid(blockOf(attempt.place), result_.past[attempt.place].judged);
        if (then == Then::Done) return;
        const OrderStep step{.trial_index = latest.trial_index, .then = then, .decided_by = Decider::Experimenter};
        follow(step);
        result_.change.steps.push_back(step);
    }

    /// Of which no step tells; the step that does from now on.
    void follow(const StoredAttempt& attempt, bool cut_off) {
        OrderStep step{.trial_index = result_.agenda.trial(attempt.place).trial_index,
                       .then = Then::RepeatNow,
                       .decided_by = Decider::Interruption,
                       .attempt = attempt.id};
        if (!cut_off) {
            step.decided_by = Decider::Protocol;
            step.then = thenAfter(blockOf(attempt.place), *attempt.outcome, attempt.valid,
                                  result_.past[attempt.place].judged + 1);
        }
        follow(step);
        result_.change.steps.push_back(step);
    }

    /// The trials come next, in this order, and what they had no longer counts.
    void redo(const std::vector<std::size_t>& places) {
        for (auto place = places.rbegin(); place != places.rend(); ++place) {
            result_.agenda.bring(*place);
            result_.change.steps.push_back({.trial_index = result_.agenda.trial(*place).trial_index,
                                            .then = Then::RepeatNow,
                                            .decided_by = Decider::Interruption});
            if (auto& counting = result_.past[*place].counting)
                result_.change.discounted.push_back(*counting), counting.reset();
        }
    }

private:
    std::size_t placeOf(std::int64_t trial_index) const {
        std::size_t place = 0;
        while (result_.agenda.trial(place).trial_index != trial_index) ++place;
        return place;
    }
    const plan::Block& blockOf(std::size_t place) const {
        return plan_.blocks.at(static_cast<std::size_t>(result_.agenda.trial(place).block_index));
    }

    const plan::StudyPlan& plan_;
    Resumption& result_;
    std::vector<OrderStep> latest_;  // by place
};

void replayOrder(Replay& replay, const std::vector<StoredAttempt>& attempts, const std::vector<OrderStep>& steps,
                 bool crashed) {
    const auto told = [&](AttemptId id) {
        return std::any_of(steps.begin(), steps.end(), [&](const OrderStep& step) { return step.attempt == id; });
    };
    // Whoever resumes tells of all: what nobody has told of is newer.
    for (const OrderStep& step : steps) replay.follow(step);
    for (const StoredAttempt& attempt : attempts) {
        if (told(attempt.id)) continue;
        const bool last = &attempt == &attempts.back();
        replay.follow(attempt, !attempt.outcome || (last && !crashed && *attempt.outcome == Outcome::Aborted));
    }
    for (const StoredAttempt& attempt : attempts) replay.followInvalidated(attempt);
}

/// Where nothing is left: what a whole session lacks.
std::vector<std::size_t> toOffer(const Staircases& staircases, const Resumption& result) {
    std::vector<std::size_t> places;
    for (std::size_t place = 0; place < result.past.size() && result.agenda.empty(); ++place)
        if (lacks(staircases, result.agenda.trial(place), result.past[place])) places.push_back(place);
    return places;
}

/// What became of the trials by their newest attempt that ended; of one that is discounted now it is another's turn.
std::vector<EarlierTrial> earlierTrials(const Resumption& result, const std::vector<StoredAttempt>& attempts) {
    std::vector<EarlierTrial> trials;
    for (std::size_t place = 0; place < result.past.size(); ++place) {
        const StoredAttempt* newest = nullptr;
        int ended = 0;
        for (const StoredAttempt& attempt : attempts) {
            if (attempt.place != place || !attempt.outcome) continue;
            newest = &attempt;
            ++ended;
        }
        if (newest == nullptr) continue;
        const auto time = std::find_if(newest->measures.begin(), newest->measures.end(),
                                       [](const measures::Value& value) { return value.name == "trial_time_s"; });
        trials.push_back({place, ended, *newest->outcome, newest->valid, newest->invalid_reason,
                          time == newest->measures.end() ? std::nullopt : time->value, result.agenda.isOver(place)});
    }
    return trials;
}

}  // namespace

Then thenAfter(const plan::Block& block, Outcome outcome, bool valid, int judged) {
    using plan::Repeat;
    if (judged >= block.max_attempts) return Then::Done;
    Repeat repeat = outcome == Outcome::Timeout   ? block.on_timeout
                    : outcome == Outcome::Failure ? block.on_failure
                                                  : Repeat::Never;
    if (repeat == Repeat::Never && !valid) repeat = block.on_invalid;
    switch (repeat) {
        case Repeat::Never:
            break;
        case Repeat::Now:
            return Then::RepeatNow;
        case Repeat::AtBlockEnd:
            return Then::RepeatAtBlockEnd;
    }
    return Then::Done;
}

Then thenAfterInvalid(const plan::Block& block, int judged) {
    return thenAfter(block, Outcome::Aborted, false, judged);
}

bool lacks(const Staircases& staircases, const design::PlannedTrial& trial, const Past& past) {
    if (past.counting) return false;
    return staircases.governs(trial) ? staircases.needs(trial) : trial.phase == plan::phaseName(plan::Phase::Main);
}

Resumption resumption(const plan::StudyPlan& plan, std::vector<design::PlannedTrial> trials,
                      const std::vector<StoredAttempt>& attempts, bool crashed, std::vector<StoredForm> forms,
                      const std::vector<OrderStep>& steps) {
    const std::size_t planned = trials.size();
    Resumption result{Agenda(std::move(trials)), std::vector<Past>(planned)};
    std::vector<const StoredAttempt*> newest(planned);
    for (const StoredAttempt& attempt : attempts) {
        Past& past = result.past.at(attempt.place);
        past.attempts = std::max(past.attempts, attempt.attempt_no);
        past.last = attempt.id;
        if (attempt.valid) past.counting = attempt.id;
        if (attempt.outcome) result.last = attempt.place;
        newest[attempt.place] = &attempt;
        if (attempt.valid && attempt.step)
            result.steps.push_back(toldStep(plan, attempt, result.agenda.trial(attempt.place)));
    }
    Replay replay(plan, result);
    replayOrder(replay, attempts, steps, crashed);
    Staircases staircases(plan, {}, plan.seed, 1);  // whether their tracks are finished depends on the answers alone
    for (const ToldStep& told : result.steps) staircases.restore(told);
    result.agenda.leaveOut([&](const design::PlannedTrial& trial) { return !staircases.needs(trial); });
    replay.redo(toRedo(plan.resume, result.agenda));
    replay.redo(toOffer(staircases, result));
    std::erase_if(result.steps, [&](const ToldStep& told) {
        const auto& discounted = result.change.discounted;
        return std::find(discounted.begin(), discounted.end(), told.attempt) != discounted.end();
    });
    for (const std::size_t place : result.agenda.over()) {
        if (newest[place] == nullptr) continue;  // left out
        result.finished.push_back({result.agenda.trial(place), newest[place]->measures, newest[place]->start_ns});
    }
    result.earlier = earlierTrials(result, attempts);
    result.forms = std::move(forms);
    return result;
}

std::optional<std::string> tooOld(const plan::ResumePolicy& policy, double age_s) {
    if (!(age_s > policy.max_age)) return std::nullopt;
    return fmt::format("was interrupted {:.1f} h ago, and the protocol lets it go on for {:g} h", age_s / 3600.0,
                       policy.max_age / 3600.0);
}

}  // namespace passung::session
