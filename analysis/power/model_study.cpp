#include "analysis/power/model_study.h"

#include <span>

#include "core/base/random.h"
#include "study/person/completion_time.h"
#include "study/plan/participant.h"
#include "study/protocol/trial_types.h"
#include "study/session/participant_order.h"

namespace passung::power {
namespace {

store::Levels levelsOf(const plan::StudyPlan& plan, const plan::Condition& condition) {
    store::Levels levels;
    for (std::size_t f = 0; f < plan.factors.size(); ++f)
        levels.emplace_back(plan.factors[f].name, plan.factors[f].levels[condition.levels[f]].label);
    return levels;
}

/// One session of a participant.
Result<Done> perform(const plan::StudyPlan& plan, const std::string& code, const session::DesignPlace& place, int part,
                     exporter::StudyData& study) {
    const auto trials = session::planTrials(plan, place, code, part);
    if (!trials) return trials.errors();
    const person::SimulatedPerson person = person::personOf(plan.name, code, plan.seed);
    store::SessionRow session;
    session.session_id = code + '|' + std::to_string(part);
    session.participant_id = code;
    session.ordinal = part;
    session.end_state = "complete";
    session.counted = true;
    for (const design::PlannedTrial& trial : *trials) {
        const std::string purpose = "model|" + std::to_string(part) + '|' + std::to_string(trial.trial_index);
        Random random(streamSeed(plan.name, code, trial.phase, "simulated|" + purpose, plan.seed));
        store::AttemptRow attempt;
        attempt.session_id = session.session_id;
        attempt.participant_id = code;
        attempt.kind = plan::participantKindName(plan::ParticipantKind::Simulated);
        attempt.session_ordinal = part;
        attempt.block_index = trial.block_index;
        attempt.block = trial.block;
        attempt.phase = trial.phase;
        attempt.trial_index = trial.trial_index;
        attempt.condition = study.conditions[trial.condition].condition;
        attempt.levels = study.conditions[trial.condition].levels;
        attempt.outcome = "success";
        attempt.valid = true;
        const double time = person::completionTime(person, trial.trial_index, random);
        for (const char* measure : kModelMeasures) attempt.measures[measure] = time;
        study.attempts.push_back(std::move(attempt));
    }
    study.sessions.push_back(std::move(session));
    return Done{};
}

}  // namespace

Result<exporter::StudyData> modelStudy(const plan::StudyPlan& plan, int participants) {
    const auto kind = plan::ParticipantKind::Simulated;
    exporter::StudyData study;
    study.protocols.emplace_back();  // all rows are of this one, without a hash
    for (const plan::Factor& factor : plan.factors)
        study.factors.push_back({factor.name, factor.name, plan::factorKindName(factor.kind), factor.unit, {}});
    for (const plan::Condition& condition : std::span(plan.conditions).first(plan::plannedConditions(plan)))
        study.conditions.push_back({{},
                                    condition.name,
                                    levelsOf(plan, condition),
                                    std::string(protocol::typeOf(condition.task).name),
                                    condition.task.timeout});
    const auto count = static_cast<std::size_t>(participants);
    const auto places = session::firstPlaces(plan, count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::string code = plan::participantCode(kind, static_cast<std::int64_t>(i) + 1);
        for (int part = 1; part <= plan::sessionsOf(plan); ++part)
            if (const auto done = perform(plan, code, places[i], part, study); !done) return done.errors();
    }
    return study;
}

}  // namespace passung::power
