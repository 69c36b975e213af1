#include "analysis/export/staircase_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "study/design/adaptive.h"
#include "study/plan/participant.h"

namespace passung::exporter {
namespace {

using store::AttemptRow;
using store::StaircaseStepRow;

constexpr const char* kEstimate =
    "up-down: mean of the reversals but the first ones, an even number; psi: where the posterior is highest";
constexpr const char* kDeviation = "psi: posterior standard deviation, in levels or, on a logarithmic axis, decades";

std::vector<Column> leading() {
    return {
        {"participant_id", "Code of the participant", "", "text", "", 1, {}},
        {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
        {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
        {"block", "Name of the block", "", "text", "", 1, {}},
        {"condition", "Condition as planned, without the staircase's key", "", "text", "", 1, {}},
        {"staircase", "Name of the staircase", "", "text", "", 1, {}},
        {"track", "Which of the tracks that take turns; NA: a catch trial", "", "text", "", 1, {}}};
}

std::vector<std::string> leadingCells(const AttemptRow& attempt, const StaircaseStepRow& step) {
    return {attempt.participant_id, attempt.kind,    cell(attempt.session_ordinal), attempt.block, attempt.condition,
            step.staircase,         cell(step.track)};
}

void addFactors(std::vector<Column>& columns, const StudyData& study) {
    for (const FactorColumn& factor : study.factors)
        columns.push_back({factor.column, "Factor " + factor.factor + " (" + factor.kind + ")", factor.unit, "text", "",
                           1, factor.levels});
}

void addFactorCells(std::vector<std::string>& row, const StudyData& study, const AttemptRow& attempt) {
    for (const FactorColumn& factor : study.factors) row.push_back(levelOf(attempt.levels, factor.factor));
}

/// Calls `each` with every step and its attempt, in the order of the attempts in `study`.
template <class Each>
void forSteps(const StudyData& study, Each each) {
    std::map<std::int64_t, const StaircaseStepRow*> steps;
    for (const StaircaseStepRow& step : study.staircase_steps) steps[step.attempt_id] = &step;
    for (const AttemptRow& attempt : study.attempts)
        if (const auto step = steps.find(attempt.attempt_id); step != steps.end()) each(attempt, *step->second);
}

/// Everything that a track of a session was told, in time.
struct Told {
    std::map<std::int64_t, std::pair<const AttemptRow*, const StaircaseStepRow*>> answers;  // by attempt
    const AttemptRow& attempt() const { return *answers.begin()->second.first; }
    const StaircaseStepRow& step() const { return *answers.begin()->second.second; }
};

/// Trials that count, their reversals, trials that no longer count, the estimate, that on a logarithmic axis, its
/// deviation: the track told anew what counts.
std::vector<std::string> thresholdCells(const StudyData& study, const Told& told) {
    const auto known = std::find_if(study.staircase_tracks.begin(), study.staircase_tracks.end(), [&](const auto& row) {
        return row.protocol_sha256 == told.attempt().protocol_sha256 && row.staircase == told.step().staircase &&
               row.track == told.step().track;
    });
    std::int64_t trials = 0, invalidated = 0;
    std::optional<design::AdaptiveTrack> track;
    if (known != study.staircase_tracks.end()) track.emplace(known->params);
    for (const auto& [id, answer] : told.answers) {
        const auto& [attempt, step] = answer;
        ++(attempt->valid ? trials : invalidated);
        if (attempt->valid && track && !track->finished()) track->answer(step->level, *step->positive);
    }
    if (!track) return {cell(trials), kMissing, cell(invalidated), kMissing, kMissing, kMissing};
    const std::optional<double> estimate = track->estimate();
    const bool decades = estimate && known->params.logarithmic;
    return {cell(trials),   cell(std::int64_t{track->reversals()}),           cell(invalidated),
            cell(estimate), decades ? cell(std::log10(*estimate)) : kMissing, cell(track->uncertainty())};
}

}  // namespace

Table makeStaircase(const StudyData& study) {
    Table table{"staircase.csv", "One row per attempt at a trial of a staircase.", leading(), {}};
    addFactors(table.columns, study);
    const std::vector<Column> more = {
        {"trial_index", "Number of the trial in the session, from 0", "", "integer", "", 1, {}},
        {"attempt_no", "Attempt at this trial, from 1", "", "integer", "", 1, {}},
        {"wanted_level", "Level that the rule asked for, in the key's unit", "", "number", "", 1, {}},
        {"level", "Level that was presented, in the key's unit", "", "number", "", 1, {}},
        {"positive",
         "1 if the response was positive; NA: no answer, or the attempt did not count when it ended",
         "",
         "0/1",
         "the staircase's measure against its threshold",
         1,
         {"0", "1"}},
        {"reversal", "1 if the track turned here", "", "0/1", "", 1, {"0", "1"}},
        {"estimate",
         "Threshold of the track after this trial as computed then, in the key's unit: answers that were invalidated "
         "later are in it, not in thresholds.csv",
         "",
         "number",
         kEstimate,
         1,
         {}},
        {"estimate_sd", "How unsure it is", "", "number", kDeviation, 1, {}},
        {"valid", "1 if the attempt counts", "", "0/1", "", 1, {"0", "1"}},
        {"protocol_sha256", "SHA-256 of the protocol's text, see protocol/", "", "text", "", 1, {}}};
    table.columns.insert(table.columns.end(), more.begin(), more.end());
    forSteps(study, [&](const AttemptRow& attempt, const StaircaseStepRow& step) {
        auto row = leadingCells(attempt, step);
        addFactorCells(row, study, attempt);
        row.insert(row.end(),
                   {cell(attempt.trial_index), cell(attempt.attempt_no), cell(step.wanted_level), cell(step.level),
                    step.positive ? cell(*step.positive) : kMissing, cell(step.reversal), cell(step.estimate),
                    cell(step.estimate_sd), cell(attempt.valid), attempt.protocol_sha256});
        table.rows.push_back(std::move(row));
    });
    return table;
}

Table makeThresholds(const StudyData& study) {
    Table table{"thresholds.csv",
                "One row per participant, staircase, condition and track of the counted session.",
                leading(),
                {}};
    table.columns.back().label = "Which of the tracks that take turns";
    addFactors(table.columns, study);
    const std::vector<Column> more = {
        {"n_trials", "Trials that told it something and count", "", "integer", "", 1, {}},
        {"n_reversals", "Reversals of the track by these alone", "", "integer", "", 1, {}},
        {"n_invalidated", "Trials that told it something and were invalidated later", "", "integer", "", 1, {}},
        {kThreshold, "Threshold by the trials that count, in the key's unit", "", "number", kEstimate, 1, {}},
        {kLogThreshold,
         "The same in decades; NA: the staircase's axis is not logarithmic",
         "",
         "number",
         "log10(estimate)",
         1,
         {}},
        {"estimate_sd", "How unsure it is", "", "number", kDeviation, 1, {}},
        {"protocol_sha256", "SHA-256 of the protocol's text, see protocol/", "", "text", "", 1, {}}};
    table.columns.insert(table.columns.end(), more.begin(), more.end());
    const auto counted = countedSessions(study);
    std::map<std::tuple<std::string, std::string, std::string, std::string>, Told> tracks;
    forSteps(study, [&](const AttemptRow& attempt, const StaircaseStepRow& step) {
        if (!step.track || !step.positive || counted.count(attempt.session_id) == 0) return;
        Told& told = tracks[{attempt.session_id, step.staircase, attempt.condition, *step.track}];
        told.answers[attempt.attempt_id] = {&attempt, &step};
    });
    std::vector<const Told*> sorted;
    for (const auto& [key, told] : tracks) sorted.push_back(&told);
    std::stable_sort(sorted.begin(), sorted.end(), [](const Told* a, const Told* b) {
        return a->attempt().participant_id < b->attempt().participant_id;
    });
    for (const Told* told : sorted) {
        const AttemptRow& attempt = told->attempt();
        auto row = leadingCells(attempt, told->step());
        addFactorCells(row, study, attempt);
        for (const std::string& value : thresholdCells(study, *told)) row.push_back(value);
        row.push_back(attempt.protocol_sha256);
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace passung::exporter
