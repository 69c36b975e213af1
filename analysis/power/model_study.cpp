#include "analysis/power/model_study.h"

#include <stdexcept>

#include "core/base/random.h"
#include "study/person/completion_time.h"
#include "study/protocol/participant.h"
#include "study/session/participant_order.h"

namespace passung::power {
namespace {

store::Levels levelsOf(const protocol::StudyPlan& plan, const protocol::Condition& condition) {
    store::Levels levels;
    for (std::size_t f = 0; f < plan.factors.size(); ++f)
        levels.emplace_back(plan.factors[f].name, plan.factors[f].levels[condition.levels[f]].label);
    return levels;
}

void perform(const protocol::StudyPlan& plan, std::size_t number, const session::DesignPlace& place,
             exporter::StudyData& study) {
    const auto kind = protocol::ParticipantKind::Simulated;
    const std::string code = protocol::participantCode(kind, static_cast<std::int64_t>(number) + 1);
    const person::SimulatedPerson person = person::personOf(plan.name, code, plan.seed);
    store::SessionRow session;
    session.session_id = session.participant_id = code;
    session.end_state = "complete";
    study.sessions.push_back(session);
    std::vector<design::PlannedTrial> trials;
    for (int part = 1; part <= protocol::sessionsOf(plan); ++part) {
        const auto planned = session::planTrials(plan, place, code, part);
        if (!planned) throw std::runtime_error(toString(planned.errors().front()));
        trials.insert(trials.end(), planned->begin(), planned->end());
    }
    for (const design::PlannedTrial& trial : trials) {
        const std::string purpose = "simulated|model|" + std::to_string(trial.trial_index);
        Random random(streamSeed(plan.name, code, trial.phase, purpose, plan.seed));
        store::AttemptRow attempt;
        attempt.session_id = attempt.participant_id = code;
        attempt.kind = protocol::participantKindName(kind);
        attempt.phase = trial.phase;
        attempt.trial_index = trial.trial_index;
        attempt.condition = study.conditions[trial.condition].condition;
        attempt.levels = study.conditions[trial.condition].levels;
        attempt.outcome = "success";
        attempt.valid = true;
        attempt.measures[kModelMeasure] = person::completionTime(person, trial.trial_index, random);
        study.attempts.push_back(std::move(attempt));
    }
}

}  // namespace

exporter::StudyData modelStudy(const protocol::StudyPlan& plan, int participants) {
    exporter::StudyData study;
    study.protocols.emplace_back();  // all rows are of this one, without a hash
    for (const protocol::Condition& condition : plan.conditions)
        study.conditions.push_back({{}, condition.name, levelsOf(plan, condition)});
    const auto count = static_cast<std::size_t>(participants);
    const auto places = session::firstPlaces(plan, count, protocol::ParticipantKind::Simulated);
    for (std::size_t i = 0; i < count; ++i) perform(plan, i, places[i], study);
    return study;
}

}  // namespace passung::power
