#include "analysis/export/secondary_table.h"

#include <map>

#include "analysis/export/shared_columns.h"

namespace passung::exporter {
namespace {

using measures::Detection;
using store::AttemptRow;

/// A stimulus or press of an attempt.
struct AttemptDetection {
    const AttemptRow* attempt;
    const store::DetectionRow* row;
};

std::string secondsOf(const std::optional<std::int64_t>& periods) {
    return periods ? secondsCell(*periods * kTickNanoseconds) : kMissing;
}

std::string responseTime(const Detection& detection) {
    const bool hit = detection.result == measures::DetectionResult::Hit;
    return hit ? secondsOf(*detection.response - *detection.stimulus) : kMissing;
}

ColumnsOf<AttemptRow> leadingColumns() {
    ColumnsOf<AttemptRow> columns = participantSessionColumns<AttemptRow>();
    append(columns,
           {blockColumn<AttemptRow>(), trialIndexColumn(), attemptNumberColumn(), conditionColumn(), validColumn()});
    return columns;
}

ColumnsOf<Detection> detectionColumns() {
    return {
        {"onset_s",
         "Time from the attempt's start to the stimulus; NA: a press without one",
         "number",
         [](const Detection& detection) { return secondsOf(detection.stimulus); },
         {.unit = "s"}},
        {"off_s",
         "Time from the attempt's start to the end of the stimulus: the response, its longest duration or the trial's "
         "end",
         "number",
         [](const Detection& detection) { return secondsOf(detection.off); },
         {.unit = "s"}},
        {"press_s",
         "Time from the attempt's start to the press; NA: none",
         "number",
         [](const Detection& detection) { return secondsOf(detection.response); },
         {.unit = "s"}},
        {"response_time_s",
         "From onset to press; only of hits",
         "number",
         responseTime,
         {.unit = "s", .formula = "press_s - onset_s"}},
        {"result",
         "hit: answered in time; miss: not; false_alarm: a press that answers none; not_scored: before the trial's "
         "start, or cut off by its end",
         "text",
         [](const Detection& detection) { return measures::detectionResultName(detection.result); },
         {.levels = {"hit", "miss", "false_alarm", "not_scored"}}}};
}

ColumnsOf<AttemptDetection> secondaryColumns() {
    ColumnsOf<AttemptDetection> columns;
    append(columns, leadingColumns(), attemptOf<AttemptDetection>);
    append(columns, {{"number", "By time in the attempt, from 1", "integer",
                      [](const AttemptDetection& row) { return row.row->number; }},
                     {"stimulus",
                      "What was to be answered",
                      "text",
                      [](const AttemptDetection& row) { return row.attempt->stimulus; },
                      {.levels = {"visual", "vibrotactile", "audio"}}}});
    append(columns, detectionColumns(),
           [](const AttemptDetection& row) -> const Detection& { return row.row->detection; });
    return columns;
}

}  // namespace

Table makeSecondary(const StudyData& study) {
    return makeLongTable<AttemptDetection>(
        "secondary.csv",
        "One row per stimulus of a secondary task, and per press of its button that answers none, by time.",
        secondaryColumns(), [&study](const auto& take) {
            std::map<std::int64_t, const AttemptRow*> attempts;
            for (const AttemptRow& attempt : study.attempts) attempts[attempt.attempt_id] = &attempt;
            for (const store::DetectionRow& row : study.detections) take({attempts.at(row.attempt_id), &row});
            return Done{};
        });
}

}  // namespace passung::exporter
