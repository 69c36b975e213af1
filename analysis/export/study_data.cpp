#include "analysis/export/study_data.h"

#include <algorithm>

#include "analysis/export/data_rules.h"
#include "analysis/export/staircase_tables.h"
#include "analysis/export/table.h"
#include "analysis/export/trial_tables.h"
#include "study/measures/measures.h"
#include "study/measures/period_clock.h"

namespace passung::exporter {
namespace {

std::vector<FactorColumn> mergeFactors(const std::vector<store::FactorRow>& rows, const std::set<std::string>& taken) {
    std::vector<FactorColumn> factors;
    for (const store::FactorRow& row : rows) {
        auto found = std::find_if(factors.begin(), factors.end(),
                                  [&](const FactorColumn& factor) { return factor.factor == row.factor; });
        if (found == factors.end()) {
            const std::string column = taken.count(row.factor) != 0 ? "factor_" + row.factor : row.factor;
            factors.push_back({row.factor, column, row.kind, row.unit, {}});
            found = factors.end() - 1;
        }
        for (const std::string& level : row.levels) {
            if (std::find(found->levels.begin(), found->levels.end(), level) == found->levels.end()) {
                found->levels.push_back(level);
            }
        }
    }
    return factors;
}

/// Moves a read list into `target`, or its errors into `errors`.
template <class Row>
void take(Result<std::vector<Row>> rows, std::vector<Row>& target, Errors& errors) {
    if (rows) {
        target = *std::move(rows);
    } else {
        errors.insert(errors.end(), rows.errors().begin(), rows.errors().end());
    }
}

/// Finds the ticks of each trial's start and end. Periods and ticks are the same as long as no cycle was missed; where
/// one was, the recorded ticks tell, and if one up to there is missing or cannot be read, nothing does.
void findTicks(const store::StoreReader& reader, std::vector<store::AttemptRow>& attempts) {
    for (store::AttemptRow& attempt : attempts) {
        if (!attempt.trial_ns) continue;
        const auto periodsTo = [&](std::int64_t t_ns) {
            return (t_ns - attempt.start_ns + kTickNanoseconds / 2) / kTickNanoseconds;
        };
        const std::int64_t start = periodsTo(*attempt.trial_ns);
        std::optional<std::int64_t> end;
        if (attempt.end_ns) end = periodsTo(*attempt.end_ns);
        if (attempt.timing && attempt.timing->overruns == 0) {
            attempt.start_tick = start;
            attempt.end_tick = end;
            continue;
        }
        const auto records = reader.records(attempt.attempt_id);
        if (!records) continue;
        measures::PeriodClock clock;
        std::int64_t next = 0;
        for (const TickRecord& record : *records) {
            if (record.tick != next++) break;  // how many periods a missing record stands for is not known
            const std::int64_t time = clock.at(record);
            if (!attempt.start_tick && time >= start) attempt.start_tick = record.tick;
            if (!attempt.end_tick && end && time >= *end) attempt.end_tick = record.tick;
        }
    }
}

}  // namespace

Result<StudyData> readStudy(const store::StoreReader& reader) {
    StudyData study;
    study.damages = reader.damages();
    Errors errors;
    const auto extras = reader.extras();
    if (extras)
        study.extras = *extras;
    else
        errors.insert(errors.end(), extras.errors().begin(), extras.errors().end());
    std::vector<store::FactorRow> factors;
    take(reader.protocols(), study.protocols, errors);
    take(reader.factors(), factors, errors);
    take(reader.conditions(), study.conditions, errors);
    take(reader.plannedCells(), study.planned, errors);
    take(reader.analyses(), study.analyses, errors);
    take(reader.dataRules(), study.data_rules, errors);
    take(reader.questionnaires(), study.definitions, errors);
    take(reader.namedFiles(), study.files, errors);
    take(reader.measures(), study.measures, errors);
    take(reader.participants(), study.participants, errors);
    take(reader.sessions(), study.sessions, errors);
    take(reader.attempts(), study.attempts, errors);
    take(reader.notes(), study.notes, errors);
    take(reader.detections(), study.detections, errors);
    take(reader.staircaseTracks(), study.staircase_tracks, errors);
    take(reader.staircaseSteps(), study.staircase_steps, errors);
    take(reader.questionnaireRuns(), study.questionnaires, errors);
    take(reader.accuracy(), study.accuracy, errors);
    if (!errors.empty()) return errors;
    std::erase_if(study.measures, [](const store::MeasureRow& measure) { return !measure.declared; });
    const auto counter =
        std::stable_partition(study.measures.begin(), study.measures.end(),
                              [](const store::MeasureRow& measure) { return !measures::countsTicks(measure.measure); });
    study.counters.assign(counter, study.measures.end());
    study.measures.erase(counter, study.measures.end());
    findTicks(reader, study.attempts);
    std::set<std::string> taken;
    for (const Column& column : trialColumns(study)) taken.insert(column.name);  // not yet those of factors
    if (!study.staircase_tracks.empty())  // by the plan, so that a name does not depend on who has been there
        for (const Table& table : {makeStaircase(study), makeThresholds(study)})
            for (const Column& column : table.columns) taken.insert(column.name);
    study.factors = mergeFactors(factors, taken);
    for (store::AttemptRow& attempt : study.attempts) attempt.group = groupOf(study, attempt.participant_id);
    applyRules(study);
    return study;
}

std::string levelOf(const store::Levels& levels, const std::string& factor) {
    for (const auto& [name, label] : levels) {
        if (name == factor) return label;
    }
    return kMissing;
}

std::string groupOf(const StudyData& study, const std::string& participant) {
    for (const store::ParticipantRow& person : study.participants)
        if (person.participant_id == participant && person.group) return *person.group;
    const bool has_groups = std::any_of(study.factors.begin(), study.factors.end(),
                                        [](const FactorColumn& factor) { return factor.kind == "between"; });
    return has_groups ? kMissing : "all";
}

std::string sequenceOf(const StudyData& study, const std::string& participant) {
    for (const store::ParticipantRow& person : study.participants)
        if (person.participant_id == participant) return cell(person.sequence_index);
    return kMissing;
}

bool countsInMeans(const StudyData& study, const store::AttemptRow& attempt) {
    return attempt.counts() && study.left_out.attempts.count(attempt.attempt_id) == 0;
}

std::set<std::string> countedSessions(const StudyData& study) {
    std::set<std::string> ids;
    for (const store::SessionRow& session : study.sessions)
        if (session.counted &&
            study.left_out.participants.count({session.protocol_sha256, session.participant_id}) == 0)
            ids.insert(session.session_id);
    return ids;
}

}  // namespace passung::exporter
