#include "analysis/export/secondary_table.h"

#include <map>

#include "study/plan/participant.h"

namespace passung::exporter {

Table makeSecondary(const StudyData& study) {
    Table table{
        "secondary.csv",
        "One row per stimulus of a secondary task, and per press of its button that answers none, by time.",
        {{"participant_id", "Code of the participant", "", "text", "", 1, {}},
         {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
         {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
         {"block", "Name of the block", "", "text", "", 1, {}},
         {"trial_index", "Number of the trial in the session, from 0", "", "integer", "", 1, {}},
         {"attempt_no", "Number of the attempt at this trial, from 1", "", "integer", "", 1, {}},
         {"condition", "Name of the condition: its levels joined by /", "", "text", "", 1, {}},
         {"valid", "1 if the attempt may be analysed", "", "0/1", "", 1, {"0", "1"}},
         {"number", "By time in the attempt, from 1", "", "integer", "", 1, {}},
         {"stimulus", "What was to be answered", "", "text", "", 1, {"visual", "vibrotactile", "audio"}},
         {"onset_s",
          "Time from the attempt's start to the stimulus; NA: a press without one",
          "s",
          "number",
          "",
          1,
          {}},
         {"off_s",
          "Time from the attempt's start to the end of the stimulus: the response, its longest duration or the trial's "
          "end",
          "s",
          "number",
          "",
          1,
          {}},
         {"press_s", "Time from the attempt's start to the press; NA: none", "s", "number", "", 1, {}},
         {"response_time_s", "From onset to press; only of hits", "s", "number", "press_s - onset_s", 1, {}},
         {"result",
          "hit: answered in time; miss: not; false_alarm: a press that answers none; not_scored: before the trial's "
          "start, or cut off by its end",
          "",
          "text",
          "",
          1,
          {"hit", "miss", "false_alarm", "not_scored"}}},
        {}};
    std::map<std::int64_t, const store::AttemptRow*> attempts;
    for (const store::AttemptRow& attempt : study.attempts) attempts[attempt.attempt_id] = &attempt;
    const auto seconds = [](const std::optional<std::int64_t>& periods) {
        return periods ? secondsCell(*periods * kTickNanoseconds) : std::string(kMissing);
    };
    for (const store::DetectionRow& row : study.detections) {
        const store::AttemptRow& a = *attempts.at(row.attempt_id);
        const measures::Detection& d = row.detection;
        const bool hit = d.result == measures::DetectionResult::Hit;
        table.rows.push_back({a.participant_id, a.kind, cell(a.session_ordinal), a.block, cell(a.trial_index),
                              cell(a.attempt_no), a.condition, cell(a.valid), cell(row.number), a.stimulus,
                              seconds(d.stimulus), seconds(d.off), seconds(d.response),
                              hit ? seconds(*d.response - *d.stimulus) : kMissing,
                              measures::detectionResultName(d.result)});
    }
    return table;
}

}  // namespace passung::exporter
