#include "analysis/export/study_data.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "analysis/export/staircase_tables.h"
#include "analysis/export/trial_tables.h"

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

}  // namespace

Result<StudyData> readStudy(const store::StoreReader& reader) {
    StudyData study;
    Errors errors;
    std::vector<store::FactorRow> factors;
    take(reader.protocols(), study.protocols, errors);
    take(reader.factors(), factors, errors);
    take(reader.conditions(), study.conditions, errors);
    take(reader.measures(), study.measures, errors);
    take(reader.participants(), study.participants, errors);
    take(reader.sessions(), study.sessions, errors);
    take(reader.attempts(), study.attempts, errors);
    take(reader.events(), study.events, errors);
    take(reader.notes(), study.notes, errors);
    take(reader.detections(), study.detections, errors);
    take(reader.staircaseTracks(), study.staircase_tracks, errors);
    take(reader.staircaseSteps(), study.staircase_steps, errors);
    take(reader.questionnaireRuns(), study.questionnaires, errors);
    take(reader.accuracy(), study.accuracy, errors);
    if (!errors.empty()) return errors;
    std::erase_if(study.measures, [](const store::MeasureRow& measure) { return !measure.declared; });
    std::set<std::string> taken;
    for (const Column& column : fixedColumns()) taken.insert(column.name);
    for (const store::MeasureRow& measure : study.measures) taken.insert(measure.measure);
    if (!study.staircase_steps.empty())
        for (const Table& table : {makeStaircase(study), makeThresholds(study)})
            for (const Column& column : table.columns) taken.insert(column.name);
    study.factors = mergeFactors(factors, taken);
    return study;
}

std::string levelOf(const store::Levels& levels, const std::string& factor) {
    for (const auto& [name, label] : levels) {
        if (name == factor) return label;
    }
    return kMissing;
}

std::set<std::string> countedSessions(const StudyData& study) {
    std::set<std::string> excluded;
    for (const store::ParticipantRow& person : study.participants)
        if (person.status == "excluded") excluded.insert(person.participant_id);
    std::map<std::pair<std::string, std::string>, const store::SessionRow*> latest;  // participant, protocol
    std::set<std::pair<std::string, std::string>> whole;
    std::set<std::string> ids;
    for (const store::SessionRow& session : study.sessions) {
        if (excluded.count(session.participant_id) != 0) continue;
        const std::pair who(session.participant_id, session.protocol_sha256);
        const store::SessionRow*& best = latest[who];
        if (!best || session.ordinal > best->ordinal) best = &session;
        if (session.end_state != "complete") continue;
        whole.insert(who);
        ids.insert(session.session_id);
    }
    for (const auto& [who, session] : latest)
        if (whole.count(who) == 0) ids.insert(session->session_id);
    return ids;
}

std::vector<Cell> cellsOf(const StudyData& study) {
    const std::set<std::string> counted = countedSessions(study);
    // participant, then the protocol's place in the list
    std::map<std::pair<std::string, std::size_t>, std::vector<const store::AttemptRow*>> by_person;
    for (const store::AttemptRow& attempt : study.attempts) {
        const auto protocol =
            std::find_if(study.protocols.begin(), study.protocols.end(),
                         [&](const store::ProtocolRow& row) { return row.sha256 == attempt.protocol_sha256; });
        by_person[{attempt.participant_id, static_cast<std::size_t>(protocol - study.protocols.begin())}].push_back(
            &attempt);
    }
    const bool all_within = std::all_of(study.factors.begin(), study.factors.end(),
                                        [](const FactorColumn& factor) { return factor.kind == "within"; });
    std::set<std::string> apart;  // met in catch trials or those of a staircase only
    const auto is_apart = [](const store::AttemptRow& a) { return a.phase == "catch" || a.phase == "adaptive"; };
    for (const store::AttemptRow& attempt : study.attempts)
        if (is_apart(attempt)) apart.insert(attempt.condition);
    for (const store::AttemptRow& attempt : study.attempts)
        if (!is_apart(attempt)) apart.erase(attempt.condition);
    std::vector<Cell> cells;
    for (const auto& [key, attempts] : by_person) {
        const store::AttemptRow& first = *attempts.front();
        for (const store::ConditionRow& condition : study.conditions) {
            if (condition.protocol_sha256 != first.protocol_sha256 || apart.count(condition.condition) != 0) continue;
            const bool met = std::any_of(attempts.begin(), attempts.end(), [&](const store::AttemptRow* attempt) {
                return attempt->condition == condition.condition;
            });
            if (!met && !all_within) continue;
            Cell cell{first.participant_id, first.kind, first.group, first.protocol_sha256, &condition, {}};
            for (const store::AttemptRow* attempt : attempts) {
                if (attempt->counts() && attempt->condition == condition.condition &&
                    counted.count(attempt->session_id) != 0) {
                    cell.attempts.push_back(attempt);
                }
            }
            cells.push_back(std::move(cell));
        }
    }
    return cells;
}

std::vector<double> valuesOf(const std::vector<const store::AttemptRow*>& attempts, const std::string& measure) {
    std::vector<double> values;
    for (const store::AttemptRow* attempt : attempts) {
        if (const auto found = attempt->measures.find(measure); found != attempt->measures.end()) {
            values.push_back(found->second);
        }
    }
    return values;
}

double meanOf(const std::vector<double>& values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double medianOf(std::vector<double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2.0;
}

}  // namespace passung::exporter
