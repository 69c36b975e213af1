#include "analysis/export/session_tables.h"

#include <algorithm>
#include <map>
#include <set>

#include "study/plan/participant.h"

namespace passung::exporter {
namespace {

using Names = std::vector<std::string>;

std::string listCell(const Names& names) { return names.empty() ? kMissing : joined(names, ";"); }

/// The devices that the session was performed on, each once, in the order in which they came.
std::string devicesOf(const store::SessionRow& session, const StudyData& study) {
    std::map<std::pair<std::int64_t, std::int64_t>, std::string> attempts;  // by start, by number
    for (const store::AttemptRow& attempt : study.attempts)
        if (attempt.session_id == session.session_id) attempts[{attempt.start_ns, attempt.attempt_id}] = attempt.device;
    Names devices;
    const auto add = [&devices](const std::string& device) {
        if (std::find(devices.begin(), devices.end(), device) == devices.end()) devices.push_back(device);
    };
    for (const auto& [when, device] : attempts) add(device);
    if (attempts.empty())
        for (const std::string& device : session.segment_devices) add(device);
    return listCell(devices);
}

}  // namespace

Table makeEvents(const StudyData& study) {
    Table table{
        "events.csv",
        "One row per event of a session, in the order of time.",
        {{"participant_id", "Code of the participant", "", "text", "", 1, {}},
         {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
         {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
         {"t_s",
          "Session time: 1 ms for every cycle of the haptic loop, missed ones too, from the session's first attempt "
          "on. "
          "It runs in attempts and rests only and stands still in between, in instructions, questionnaires and pauses "
          "and between an interruption and the resume, after which it goes on from the last time that was stored: "
          "differences across these are not the time that passed, which t_utc tells where epoch is wall",
          "s",
          "number",
          "",
          1,
          {}},
         {"t_utc",
          "When, by the session's epoch (see sessions.csv): by the wall clock, pauses included, or in virtual time "
          "2000-01-01T00:00:00Z + t_s",
          "",
          "time",
          "",
          1,
          {}},
         {"trial_index", "Trial that it belongs to", "", "integer", "", 1, {}},
         {"attempt_no", "Attempt that it belongs to", "", "integer", "", 1, {}},
         {"source", "Who reported it", "", "text", "", 1, {}},
         {"event", "What happened", "", "text", "", 1, {}},
         {"payload_json", "More about it, as JSON", "", "text", "", 1, {}}},
        {}};
    for (const store::EventRow& event : study.events) {
        table.rows.push_back({event.participant_id, event.kind, cell(event.session_ordinal), secondsCell(event.t_ns),
                              event.t_utc, cell(event.trial_index), cell(event.attempt_no), event.source, event.event,
                              event.payload_json});
    }
    return table;
}

Table makeSessions(const StudyData& study) {
    Table table{
        "sessions.csv",
        "One row per session.",
        {{"participant_id", "Code of the participant", "", "text", "", 1, {}},
         {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
         {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
         {"session_id", "Identifier of the session", "", "text", "", 1, {}},
         {"station", "Place where the session ran", "", "text", "", 1, {}},
         {"device",
          "Haptic devices of the session's attempts in the order in which they were made, parted by ;, each once; "
          "without attempts those of segment_devices",
          "",
          "text",
          "",
          1,
          {}},
         {"segment_devices",
          "Device with which each run of the program began, in order, parted by ;: another one after a resume on "
          "another device",
          "",
          "text",
          "",
          1,
          {}},
         {"device_simulated", "1 if all of segment_devices are simulated", "", "0/1", "", 1, {"0", "1"}},
         {"experimenter", "Who led the session", "", "text", "", 1, {}},
         {"language", "Language of the texts", "", "text", "", 1, {}},
         {"seed", "Seed of everything random in the session", "", "integer", "", 1, {}},
         {"rng", "Random generator", "", "text", "", 1, {}},
         {"epoch",
          "wall: UTC is the clock's; virtual: UTC counts from 2000-01-01T00:00:00Z",
          "",
          "text",
          "",
          1,
          {"virtual", "wall"}},
         {"started_utc", "Start", "", "time", "", 1, {}},
         {"ended_utc", "End", "", "time", "", 1, {}},
         {"end_state", "How the session ended", "", "text", "", 1, {"complete", "aborted", "crashed", "withdrawn"}},
         {"counted",
          "1 if cells, scores and thresholds count this session: one that the participant completed under this "
          "protocol, else the latest; 0 if the participant is excluded",
          "",
          "0/1",
          "",
          1,
          {"0", "1"}},
         {"n_segments", "Runs of the program that the session took", "", "integer", "", 1, {}},
         {"n_planned_trials", "Trials in the session's plan", "", "integer", "", 1, {}},
         {"n_attempts", "Attempts made", "", "integer", "", 1, {}},
         {"n_valid_attempts", "Attempts that may be analysed", "", "integer", "", 1, {}},
         {"protocol_sha256", "SHA-256 of the protocol's text, see protocol/", "", "text", "", 1, {}},
         {"app_version", "Version of the program", "", "text", "", 1, {}}},
        {}};
    const std::set<std::string> counted = countedSessions(study);
    for (const store::SessionRow& s : study.sessions) {
        table.rows.push_back({s.participant_id,
                              s.kind,
                              cell(s.ordinal),
                              s.session_id,
                              s.station,
                              devicesOf(s, study),
                              listCell(s.segment_devices),
                              cell(s.device_simulated),
                              cell(s.experimenter),
                              s.language,
                              std::to_string(s.seed),
                              s.rng,
                              s.epoch,
                              s.started_utc,
                              cell(s.ended_utc),
                              cell(s.end_state),
                              cell(counted.count(s.session_id) != 0),
                              cell(s.segments),
                              cell(s.planned_trials),
                              cell(s.attempts),
                              cell(s.valid_attempts),
                              s.protocol_sha256,
                              s.app_version});
    }
    return table;
}

Table makeParticipants(const StudyData& study) {
    Table table{
        "participants.csv",
        "One row per participant.",
        {{"participant_id", "Code of the participant", "", "text", "", 1, {}},
         {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
         {"status",
          "Where the participant stands",
          "",
          "text",
          "",
          1,
          {"enrolled", "active", "complete", "excluded", "withdrawn"}},
         {"status_reason", "Why", "", "text", "", 1, {}},
         {"group",
          "Group of the between-subjects factors; all if there is none; NA: there is no place yet, or it was given "
          "back",
          "",
          "text",
          "",
          1,
          {}},
         {"sequence_index", "Row of the counterbalancing square, from 0", "", "integer", "", 1, {}},
         {"replicate", "Which use of the square, from 0", "", "integer", "", 1, {}},
         {"created_utc", "Enrolment", "", "time", "", 1, {}},
         {"n_sessions", "Sessions begun", "", "integer", "", 1, {}}},
        {}};
    for (const store::ParticipantRow& p : study.participants) {
        table.rows.push_back({p.participant_id, p.kind, p.status, cell(p.status_reason),
                              groupOf(study, p.participant_id), cell(p.sequence_index), cell(p.replicate),
                              p.created_utc, cell(p.sessions)});
    }
    return table;
}

Table makeTiming(const StudyData& study) {
    Table table{
        "timing.csv",
        "One row per attempt that has ended: how well the haptic loop kept its rate. Times are NA where the "
        "loop ran in virtual time.",
        {{"participant_id", "Code of the participant", "", "text", "", 1, {}},
         {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
         {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
         {"trial_index", "Number of the trial in the session, from 0", "", "integer", "", 1, {}},
         {"attempt_no", "Number of the attempt at this trial, from 1", "", "integer", "", 1, {}},
         {"loop", "What drove the loop", "", "text", "", 1, {}},
         {"n_ticks", "Ticks computed", "", "integer", "", 1, {}},
         {"mean_us", "Computing time of a tick, mean", "µs", "number", "", 1, {}},
         {"sd_us", "Computing time of a tick, standard deviation", "µs", "number", "", 1, {}},
         {"p99_us", "Computing time of a tick, 99th percentile", "µs", "number", "", 1, {}},
         {"p999_us", "Computing time of a tick, 99.9th percentile", "µs", "number", "", 1, {}},
         {"max_us", "Computing time of a tick, largest", "µs", "number", "", 1, {}},
         {"overruns",
          "Cycles that were missed because an earlier one took too long; 0 in virtual time",
          "",
          "integer",
          "",
          1,
          {}},
         {"dropped_samples", "Ticks that could not be recorded", "", "integer", "", 1, {}}},
        {}};
    for (const store::MeasureRow& counter : study.counters)
        table.columns.push_back(
            {counter.measure, counter.label, "", "integer", counter.formula, counter.formula_version, {}});
    for (const store::AttemptRow& attempt : study.attempts) {
        if (!attempt.timing) continue;
        const store::TimingRow& t = *attempt.timing;
        table.rows.push_back({attempt.participant_id, attempt.kind, cell(attempt.session_ordinal),
                              cell(attempt.trial_index), cell(attempt.attempt_no), t.loop, cell(t.ticks),
                              cell(t.mean_us), cell(t.sd_us), cell(t.p99_us), cell(t.p999_us), cell(t.max_us),
                              cell(t.overruns), cell(t.dropped_samples)});
        for (const store::MeasureRow& counter : study.counters) {
            const auto count = attempt.measures.find(counter.measure);
            table.rows.back().push_back(count == attempt.measures.end() ? kMissing : cell(count->second));
        }
    }
    return table;
}

Table makeAccuracy(const StudyData& study) {
    Table table{
        "accuracy.csv",
        "One row per setting of the contact that was measured for accuracy = \"auto\" when the protocol first ran: "
        "what "
        "it costs and errs, and which was picked. Measured on one machine: another database of the same protocol may "
        "hold other times and picks.",
        {{"protocol_sha256", "SHA-256 of the protocol's text, see protocol/", "", "text", "", 1, {}},
         {"candidate", "Number of the setting in the order of measuring, from 0", "", "integer", "", 1, {}},
         {"picked_for_us",
          "Budgets (accuracy_budget_us) that it was picked for, parted by ;",
          "µs",
          "text",
          "least error_p99_um among those with time_p99_us within the budget",
          1,
          {}},
         {"mode", "Interpolation of the distance fields", "", "text", "", 1, {}},
         {"tolerance_um", "Asked accuracy of the distance fields", "µm", "number", "", 1, {}},
         {"spacing_mm", "Asked distance between the held part's points", "mm", "number", "", 1, {}},
         {"budget_nodes", "Most tree nodes that a query visits; 0: no limit", "", "integer", "", 1, {}},
         {"points", "Points of the held part", "", "integer", "", 1, {}},
         {"time_median_us",
          "Time of a query against all other parts, median over poses along contact paths",
          "µs",
          "number",
          "of each pose the faster of two; processor time of one thread; the slowest scene counts",
          1,
          {}},
         {"time_p99_us", "The same, 99th percentile", "µs", "number", "nearest rank", 1, {}},
         {"time_max_us", "The same, largest", "µs", "number", "", 1, {}},
         {"error_mean_um",
          "Error of the depth, mean over poses along contact paths in contact",
          "µm",
          "number",
          "|answer - truth|, truth by exact distances; the worst scene counts; in a database made before revision 3 of "
          "its schema: of the signed distance, at poses without contact too",
          2,
          {}},
         {"error_p99_um", "The same, 99th percentile", "µm", "number", "nearest rank", 2, {}},
         {"error_max_um", "The same, largest", "µm", "number", "", 2, {}},
         {"force_error_p99_percent",
          "Error of the force's size in the area-weighted penalty of the contacts found, 99th percentile",
          "%",
          "number",
          "truth by a dense sum; at poses with at least 1 % of the largest true force; the worst scene counts",
          1,
          {}},
         {"direction_error_p99_deg", "The same: angle between the force and the true one", "°", "number", "", 1, {}},
         {"torque_error_p99_percent",
          "The same: error of the torque",
          "%",
          "number",
          "share of the true force times the distance of the held part's farthest point from its origin",
          1,
          {}}},
        {}};
    for (const store::AccuracyRow& row : study.accuracy) {
        std::string budgets;
        for (const double budget : row.picked_for_us) budgets += (budgets.empty() ? "" : ";") + cell(budget);
        table.rows.push_back({row.protocol_sha256, cell(row.candidate), budgets.empty() ? kMissing : budgets, row.mode,
                              cell(row.tolerance_um), cell(row.spacing_mm), cell(row.budget_nodes), cell(row.points),
                              cell(row.time_median_us), cell(row.time_p99_us), cell(row.time_max_us),
                              cell(row.error_mean_um), cell(row.error_p99_um), cell(row.error_max_um),
                              cell(row.force_error_p99_percent), cell(row.direction_error_p99_deg),
                              cell(row.torque_error_p99_percent)});
    }
    return table;
}

}  // namespace passung::exporter
