#include "study/session/resume.h"

#include <fmt/format.h>

#include <algorithm>

namespace passung::session {
namespace {

using measures::Outcome;

/// Trials that are over and to be done again, in the plan's order.
std::vector<std::size_t> toRedo(const protocol::ResumePolicy& policy, const Agenda& agenda) {
    std::vector<std::size_t> places;
    if (agenda.empty()) return places;
    const std::int64_t block = agenda.trial(agenda.next()).block_index;
    for (std::size_t place = 0; place < agenda.planned(); ++place) {
        const design::PlannedTrial& trial = agenda.trial(place);
        const bool practice = policy.redo_practice && trial.block_index < block &&
                              trial.phase == protocol::phaseName(protocol::Phase::Practice);
        const bool restarted = policy.restart_block && trial.block_index == block;
        if ((practice || restarted) && agenda.isOver(place)) places.push_back(place);
    }
    return places;
}

ToldStep toldStep(const protocol::StudyPlan& plan, const StoredAttempt& attempt, const design::PlannedTrial& trial) {
    const auto staircase = std::find_if(plan.staircases.begin(), plan.staircases.end(),
                                        [&](const auto& known) { return known.name == attempt.step->staircase; });
    return {attempt.id,          static_cast<std::size_t>(staircase - plan.staircases.begin()),
            trial.condition,     attempt.step->track,
            attempt.step->level, attempt.step->positive};
}

}  // namespace

Then thenAfter(const protocol::Block& block, Outcome outcome, bool valid, int judged) {
    using protocol::Repeat;
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

Resumption resumption(const protocol::StudyPlan& plan, std::vector<design::PlannedTrial> trials,
                      const std::vector<StoredAttempt>& attempts, bool crashed, const std::vector<StoredForm>& forms) {
    const std::size_t planned = trials.size();
    Resumption result{Agenda(std::move(trials)), std::vector<Past>(planned), {}, 0};
    Agenda& agenda = result.agenda;
    std::vector<const StoredAttempt*> newest(planned);
    for (const StoredAttempt& attempt : attempts) {
        Past& past = result.past.at(attempt.place);
        past.attempts = std::max(past.attempts, attempt.attempt_no);
        past.last = attempt.id;
        if (attempt.valid) past.counting = attempt.id;
        newest[attempt.place] = &attempt;
        if (attempt.valid && attempt.step) result.steps.push_back(toldStep(plan, attempt, agenda.trial(attempt.place)));
        agenda.bring(attempt.place);
        const bool last = &attempt == &attempts.back();
        const bool cut_off = !attempt.outcome || (last && !crashed && *attempt.outcome == Outcome::Aborted);
        const auto block = static_cast<std::size_t>(agenda.trial(attempt.place).block_index);
        agenda.end(cut_off ? Then::RepeatNow
                           : thenAfter(plan.blocks.at(block), *attempt.outcome, attempt.valid, ++past.judged));
    }
    const auto redo = toRedo(plan.resume, agenda);
    for (auto place = redo.rbegin(); place != redo.rend(); ++place) {
        agenda.bring(*place);
        if (auto& counting = result.past[*place].counting) result.discounted.push_back(*counting), counting.reset();
    }
    std::erase_if(result.steps, [&](const ToldStep& told) {
        return std::find(result.discounted.begin(), result.discounted.end(), told.attempt) != result.discounted.end();
    });
    for (const std::size_t place : agenda.over())
        result.finished.push_back({agenda.trial(place), newest[place]->measures});
    const std::int64_t since = agenda.canGoBack() ? newest[agenda.last()]->start_ns : -1;
    for (const StoredForm& form : forms)
        if (form.t_ns > since) result.answered.push_back(form.id);
    return result;
}

std::optional<std::string> tooOld(const protocol::ResumePolicy& policy, double age_s) {
    if (!(age_s > policy.max_age)) return std::nullopt;
    return fmt::format("was interrupted {:.1f} h ago, and the protocol lets it go on for {:g} h", age_s / 3600.0,
                       policy.max_age / 3600.0);
}

}  // namespace passung::session
