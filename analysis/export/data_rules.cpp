#include "analysis/export/data_rules.h"

#include <map>

#include "analysis/export/cells.h"
#include "analysis/export/counted_forms.h"
#include "analysis/export/table.h"

namespace passung::exporter {
namespace {

bool isOutside(const plan::DataRule& rule, double value) {
    return (rule.below && value < *rule.below) || (rule.above && value > *rule.above);
}

/// "rule 2: time_s below 0.3 (too fast)"
std::string textOf(const store::DataRuleRow& row) {
    std::string text = "rule " + cell(row.number) + ": " + row.rule.value;
    if (row.rule.below) text += " below " + cell(*row.rule.below);
    if (row.rule.above) text += std::string(row.rule.below ? " or" : "") + " above " + cell(*row.rule.above);
    return row.rule.reason.empty() ? text : text + " (" + row.rule.reason + ")";
}

void leaveOutTrials(const store::DataRuleRow& row, StudyData& study) {
    for (const store::AttemptRow& attempt : study.attempts) {
        const auto value = attempt.measures.find(row.rule.value);
        if (attempt.protocol_sha256 == row.protocol_sha256 && attempt.counts() && value != attempt.measures.end() &&
            isOutside(row.rule, value->second))
            study.left_out.attempts.try_emplace(attempt.attempt_id, textOf(row));
    }
}

/// Of each person's trials that count, or forms.
std::map<std::string, std::vector<double>> valuesOfPeople(const store::DataRuleRow& row, const StudyData& study) {
    const auto counted = countedSessions(study);
    std::map<std::string, std::vector<double>> values;
    for (const store::AttemptRow& attempt : study.attempts) {
        const auto value = attempt.measures.find(row.rule.value);
        if (attempt.protocol_sha256 == row.protocol_sha256 && countsInMeans(study, attempt) &&
            counted.count(attempt.session_id) != 0 && value != attempt.measures.end())
            values[attempt.participant_id].push_back(value->second);
    }
    for (const store::QuestionnaireRunRow* run : countedRuns(study))
        if (run->protocol_sha256 == row.protocol_sha256)
            for (const store::ScoreRow& score : run->scores)
                if (score.value && run->questionnaire + "." + score.scale == row.rule.value)
                    values[run->participant_id].push_back(*score.value);
    return values;
}

/// What leaves the attempt out that would count, or any of a person who does not; null: nothing.
const std::string* ruleAgainst(const store::AttemptRow& attempt, const LeftOut& left_out) {
    const auto person = left_out.participants.find({attempt.protocol_sha256, attempt.participant_id});
    if (person != left_out.participants.end()) return &person->second;
    const auto alone = left_out.attempts.find(attempt.attempt_id);
    return alone != left_out.attempts.end() && !attempt.not_counted_because ? &alone->second : nullptr;
}

}  // namespace

void applyRules(StudyData& study) {
    for (const store::DataRuleRow& row : study.data_rules)
        if (!row.rule.of_participants) leaveOutTrials(row, study);
    LeftOut left_out = study.left_out;
    for (const store::DataRuleRow& row : study.data_rules) {
        if (!row.rule.of_participants) continue;
        for (const auto& [person, values] : valuesOfPeople(row, study))
            if (isOutside(row.rule, meanOf(values)))
                left_out.participants.try_emplace({row.protocol_sha256, person}, textOf(row));
    }
    study.left_out = std::move(left_out);
    for (store::AttemptRow& attempt : study.attempts)
        if (const std::string* rule = ruleAgainst(attempt, study.left_out)) attempt.not_counted_because = *rule;
}

}  // namespace passung::exporter
