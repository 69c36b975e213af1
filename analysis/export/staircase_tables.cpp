#include "analysis/export/staircase_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "analysis/export/shared_columns.h"
#include "analysis/stats/pair_fit.h"
#include "study/design/adaptive.h"

namespace passung::exporter {
namespace {

using store::AttemptRow;
using store::StaircaseStepRow;

const store::ViewColumn& ofThresholds(std::string_view name) {
    return store::viewColumn(store::StudyView::Thresholds, name);
}
constexpr double kFitLapse = 0.02;  // share of trials left to chance, of every fit
constexpr const char* kFit =
    "of a pair, by reference: the likeliest sigma of P(comparison named) = 0.01 + 0.98 Phi(x / (sqrt(2) sigma)), x = "
    "level - reference or, on a logarithmic axis, ln(level / reference), over the track's trials that count; NA: the "
    "reference is not known, or no sigma explains the answers best";
constexpr const char* kFitBound = "95 % interval of sigma by likelihood ratio; NA: no such bound";

/// Columns that both tables begin with, of rows with the members `attempt` and `step`.
template <class Row>
ColumnsOf<Row> leadingColumns(const StudyData& study, const std::string& track_label) {
    ColumnsOf<AttemptRow> of_attempt = participantSessionColumns<AttemptRow>();
    append(of_attempt, {blockColumn<AttemptRow>(), {ofThresholds("condition"), "text", &AttemptRow::condition}});
    ColumnsOf<Row> columns;
    append(columns, of_attempt, attemptOf<Row>);
    append(columns, {{ofThresholds("staircase"), "text", [](const Row& row) { return row.step->staircase; }},
                     {"track", track_label, "text", [](const Row& row) { return row.step->track; }}});
    appendFactors(columns, study, [](const Row& row) { return row.attempt->levels; });
    return columns;
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

/// A trial of a staircase.
struct StepOfAttempt {
    const AttemptRow* attempt;
    const StaircaseStepRow* step;
};

ColumnsOf<StaircaseStepRow> stepColumns() {
    return {
        {"wanted_level", "Level that the rule asked for, in the key's unit", "number", &StaircaseStepRow::wanted_level},
        {"level", "Level that was presented, in the key's unit", "number", &StaircaseStepRow::level},
        {"positive",
         "1 if the response was positive; NA: no answer, or the attempt did not count when it ended",
         "0/1",
         [](const StaircaseStepRow& step) { return step.positive ? cell(*step.positive) : kMissing; },
         {.levels = {"0", "1"}, .formula = "the staircase's measure against its threshold"}},
        {"reversal", "1 if the track turned here", "0/1", &StaircaseStepRow::reversal, {.levels = {"0", "1"}}},
        {"estimate",
         "Threshold of the track after this trial as computed then, in the key's unit: answers that were "
         "invalidated later are in it, not in thresholds.csv",
         "number",
         &StaircaseStepRow::estimate,
         {.formula = ofThresholds(kThreshold).formula}},
        {"estimate_sd",
         "How unsure it is",
         "number",
         &StaircaseStepRow::estimate_sd,
         {.formula = ofThresholds("estimate_sd").formula}}};
}

ColumnsOf<StepOfAttempt> staircaseColumns(const StudyData& study) {
    ColumnsOf<StepOfAttempt> columns =
        leadingColumns<StepOfAttempt>(study, "Which of the tracks that take turns; NA: a catch trial");
    append(columns,
           ColumnsOf<AttemptRow>{trialIndexColumn(),
                                 {"attempt_no", "Attempt at this trial, from 1", "integer", &AttemptRow::attempt_no}},
           attemptOf<StepOfAttempt>);
    append(columns, stepColumns(), [](const StepOfAttempt& row) -> const StaircaseStepRow& { return *row.step; });
    append(
        columns,
        ColumnsOf<AttemptRow>{{"valid", "1 if the attempt counts", "0/1", &AttemptRow::valid, {.levels = {"0", "1"}}},
                              protocolColumn<AttemptRow>(kInFolder)},
        attemptOf<StepOfAttempt>);
    return columns;
}

/// A track told anew what counts. Empty: the protocol's track is not known.
struct Threshold {
    const AttemptRow* attempt;  // the first that told the track something
    const StaircaseStepRow* step;
    std::int64_t trials = 0, invalidated = 0;
    std::optional<std::int64_t> reversals = {};
    std::optional<double> estimate = {}, decades = {}, deviation = {};
    std::optional<double> reference = {}, jnd75 = {};
    std::optional<stats::PairFit> fit = {};
};

/// The axis of the fit: where the error of an impression is as large everywhere.
double onFitAxis(double level, const store::StaircaseTrackRow& track) {
    const double reference = track.reference.value();
    return track.params.logarithmic ? std::log(level / reference) : level - reference;
}

/// The function of a pair's reference and all answers that count.
void fitFunction(const Told& told, const store::StaircaseTrackRow& track, Threshold& threshold) {
    threshold.reference = track.reference;
    if (!track.reference || (track.params.logarithmic && !(*track.reference > 0.0))) return;
    std::map<double, stats::LevelCount> counts;
    for (const auto& [id, answer] : told.answers) {
        const auto& [attempt, step] = answer;
        if (!attempt->valid) continue;
        stats::LevelCount& count = counts[step->level];
        count.level = onFitAxis(step->level, track);
        count.trials += 1.0;
        count.positive += *step->positive ? 1.0 : 0.0;
    }
    std::vector<stats::LevelCount> listed;
    for (const auto& [level, count] : counts) listed.push_back(count);
    threshold.fit = stats::fitPairs(listed, kFitLapse);
    if (!threshold.fit) return;
    const double jnd = threshold.fit->jnd75();
    threshold.jnd75 = track.params.logarithmic ? *track.reference * std::expm1(jnd) : jnd;
}

Threshold thresholdOf(const StudyData& study, const Told& told) {
    Threshold threshold{&told.attempt(), &told.step()};
    const auto known = std::find_if(study.staircase_tracks.begin(), study.staircase_tracks.end(), [&](const auto& row) {
        return row.protocol_sha256 == told.attempt().protocol_sha256 && row.staircase == told.step().staircase &&
               row.track == told.step().track;
    });
    std::optional<design::AdaptiveTrack> track;
    if (known != study.staircase_tracks.end()) track.emplace(known->params);
    for (const auto& [id, answer] : told.answers) {
        const auto& [attempt, step] = answer;
        ++(attempt->valid ? threshold.trials : threshold.invalidated);
        if (attempt->valid && track && !track->finished()) track->answer(step->level, *step->positive);
    }
    if (!track) return threshold;
    fitFunction(told, *known, threshold);
    threshold.reversals = track->reversals();
    threshold.estimate = track->estimate();
    if (threshold.estimate && known->params.logarithmic) threshold.decades = std::log10(*threshold.estimate);
    threshold.deviation = track->uncertainty();
    return threshold;
}

ColumnsOf<Threshold> fitColumns() {
    const auto low = [](const Threshold& row) {
        return row.fit && row.fit->sigma_low > 0.0 ? cell(row.fit->sigma_low) : kMissing;
    };
    return {
        {"reference", "The key in the interval without the comparison, in its unit; NA: no pair, or not known",
         "number", &Threshold::reference},
        {"sigma",
         "Error of one interval's impression, a standard deviation: in the key's unit or, on a logarithmic axis, of "
         "the natural logarithm, about a share",
         "number",
         [](const Threshold& row) { return row.fit ? cell(row.fit->sigma) : kMissing; },
         {.formula = kFit}},
        {"sigma_low", "Lower bound of sigma", "number", low, {.formula = kFitBound}},
        {"sigma_high",
         "Upper bound of sigma",
         "number",
         [](const Threshold& row) { return row.fit && row.fit->sigma_high ? cell(*row.fit->sigma_high) : kMissing; },
         {.formula = kFitBound}},
        {"jnd75",
         "Difference from the reference, in the key's unit, that is told in 75 % of the trials without lapses",
         "number",
         &Threshold::jnd75,
         {.formula = "d = sqrt(2) sigma 0.6745; on a logarithmic axis reference (exp(d) - 1)"}}};
}

ColumnsOf<Threshold> thresholdColumns(const StudyData& study) {
    ColumnsOf<Threshold> columns = leadingColumns<Threshold>(study, "Which of the tracks that take turns");
    append(columns, {{ofThresholds("n_trials"), "integer", &Threshold::trials},
                     {ofThresholds("n_reversals"), "integer", &Threshold::reversals},
                     {ofThresholds("n_invalidated"), "integer", &Threshold::invalidated},
                     {ofThresholds(kThreshold), "number", &Threshold::estimate},
                     {kLogThreshold,
                      "The same in decades; NA: the staircase's axis is not logarithmic",
                      "number",
                      &Threshold::decades,
                      {.formula = "log10(estimate)"}},
                     {ofThresholds("estimate_sd"), "number", &Threshold::deviation}});
    append(columns, fitColumns());
    append(columns, ColumnsOf<AttemptRow>{protocolColumn<AttemptRow>(kInFolder)}, attemptOf<Threshold>);
    return columns;
}

}  // namespace

Table makeStaircase(const StudyData& study) {
    std::vector<StepOfAttempt> rows;
    forSteps(study, [&](const AttemptRow& attempt, const StaircaseStepRow& step) {
        rows.push_back({&attempt, &step});
    });
    return makeTable("staircase.csv", "One row per attempt at a trial of a staircase.", staircaseColumns(study), rows);
}

Table makeThresholds(const StudyData& study) {
    const auto counted = countedSessions(study);
    std::map<std::tuple<std::string, std::string, std::string, std::string>, Told> tracks;
    forSteps(study, [&](const AttemptRow& attempt, const StaircaseStepRow& step) {
        if (!step.track || !step.positive || counted.count(attempt.session_id) == 0) return;
        Told& told = tracks[{attempt.session_id, step.staircase, attempt.condition, *step.track}];
        told.answers[attempt.attempt_id] = {&attempt, &step};
    });
    std::vector<Threshold> rows;
    for (const auto& [key, told] : tracks) rows.push_back(thresholdOf(study, told));
    std::stable_sort(rows.begin(), rows.end(), [](const Threshold& a, const Threshold& b) {
        return a.attempt->participant_id < b.attempt->participant_id;
    });
    return makeTable("thresholds.csv",
                     "One row per participant, staircase, condition and track of the counted session.",
                     thresholdColumns(study), rows);
}

}  // namespace passung::exporter
