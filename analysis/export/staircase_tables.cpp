#include "analysis/export/staircase_tables.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "study/protocol/participant.h"

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

/// The attempt's answer was told to a track and still counts.
bool counts(const AttemptRow& attempt, const StaircaseStepRow& step) {
    return attempt.valid && step.track && step.positive;
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
         "1 if the response was positive; NA: no answer, or it did not count",
         "",
         "0/1",
         "the staircase's measure against its threshold",
         1,
         {"0", "1"}},
        {"reversal", "1 if the track turned here", "", "0/1", "", 1, {"0", "1"}},
        {"estimate", "Threshold of the track after this trial, in the key's unit", "", "number", kEstimate, 1, {}},
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
        {"n_trials", "Trials that told it something", "", "integer", "", 1, {}},
        {"n_reversals", "Reversals", "", "integer", "", 1, {}},
        {"estimate",
         "Threshold after the last of them as computed then, in the key's unit; answers that were invalidated later "
         "are in it",
         "",
         "number",
         kEstimate,
         1,
         {}},
        {"estimate_sd", "How unsure it is", "", "number", kDeviation, 1, {}},
        {"protocol_sha256", "SHA-256 of the protocol's text, see protocol/", "", "text", "", 1, {}}};
    table.columns.insert(table.columns.end(), more.begin(), more.end());
    struct Track {
        const AttemptRow* attempt = nullptr;  // the newest
        const StaircaseStepRow* step = nullptr;
        std::int64_t trials = 0, reversals = 0;
    };
    const auto counted = countedSessions(study);
    std::map<std::tuple<std::string, std::string, std::string, std::string>, Track> tracks;
    forSteps(study, [&](const AttemptRow& attempt, const StaircaseStepRow& step) {
        if (!counts(attempt, step) || counted.count(attempt.session_id) == 0) return;
        Track& track = tracks[{attempt.session_id, step.staircase, attempt.condition, *step.track}];
        if (track.attempt == nullptr || track.attempt->attempt_id < attempt.attempt_id)
            track.attempt = &attempt, track.step = &step;
        ++track.trials;
        track.reversals += step.reversal ? 1 : 0;
    });
    std::vector<const Track*> sorted;
    for (const auto& [key, track] : tracks) sorted.push_back(&track);
    std::stable_sort(sorted.begin(), sorted.end(), [](const Track* a, const Track* b) {
        return a->attempt->participant_id < b->attempt->participant_id;
    });
    for (const Track* track : sorted) {
        auto row = leadingCells(*track->attempt, *track->step);
        addFactorCells(row, study, *track->attempt);
        row.insert(row.end(), {cell(track->trials), cell(track->reversals), cell(track->step->estimate),
                               cell(track->step->estimate_sd), track->attempt->protocol_sha256});
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace passung::exporter
