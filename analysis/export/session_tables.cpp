#include "analysis/export/session_tables.h"

#include <algorithm>
#include <map>
#include <set>

#include "analysis/export/shared_columns.h"

namespace passung::exporter {
namespace {

using store::AccuracyRow;
using store::AttemptRow;
using store::EventRow;
using store::ParticipantRow;
using store::SessionRow;
using store::TimingRow;

using Names = std::vector<std::string>;

std::string listCell(const Names& names) { return names.empty() ? kMissing : joined(names, ";"); }

/// The devices that the session was performed on, each once, in the order in which they came.
std::string devicesOf(const SessionRow& session, const StudyData& study) {
    std::map<std::pair<std::int64_t, std::int64_t>, std::string> attempts;  // by start, by number
    for (const AttemptRow& attempt : study.attempts)
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

ColumnsOf<EventRow> eventColumns() {
    const auto of = [](std::string_view name) -> const store::ViewColumn& {
        return store::viewColumn(store::StudyView::Events, name);
    };
    ColumnsOf<EventRow> columns = participantSessionColumns<EventRow>();
    append(columns, {{of("t_s"), "number", [](const EventRow& event) { return secondsCell(event.t_ns); }},
                     {of("t_utc"), "time", &EventRow::t_utc},
                     {of("trial_index"), "integer", &EventRow::trial_index},
                     {of("attempt_no"), "integer", &EventRow::attempt_no},
                     {of("source"), "text", &EventRow::source},
                     {of("event"), "text", &EventRow::event},
                     {of("payload_json"), "text", &EventRow::payload_json}});
    return columns;
}

/// Refers to `study` and `counted`.
ColumnsOf<SessionRow> sessionColumns(const StudyData& study, const std::set<std::string>& counted) {
    ColumnsOf<SessionRow> columns = participantColumns<SessionRow>();
    columns.push_back(sessionColumn(&SessionRow::ordinal));
    append(columns,
           {{"session_id", "Identifier of the session", "text", &SessionRow::session_id},
            {"station", "Place where the session ran", "text", &SessionRow::station},
            {"device",
             "Haptic devices of the session's attempts in the order in which they were made, parted by ;, each once; "
             "without attempts those of segment_devices",
             "text", [&study](const SessionRow& session) { return devicesOf(session, study); }},
            {"segment_devices",
             "Device with which each run of the program began, in order, parted by ;: another one after a resume on "
             "another device",
             "text", [](const SessionRow& session) { return listCell(session.segment_devices); }},
            {"device_simulated",
             "1 if all of segment_devices are simulated",
             "0/1",
             &SessionRow::device_simulated,
             {.levels = {"0", "1"}}},
            {"device_backends",
             "Ways to the real devices that the session was performed on, parted by ;, each once; simulated: none was "
             "real",
             "text",
             [](const SessionRow& session) {
                 return session.device_backends.empty() ? "simulated" : listCell(session.device_backends);
             }},
            {"device_serials", "Serial numbers of these devices likewise, as they say them", "text",
             [](const SessionRow& session) { return listCell(session.device_serials); }},
            {"experimenter", "Who led the session", "text", &SessionRow::experimenter, {.typed = true}},
            {"language", "Language of the texts", "text", &SessionRow::language},
            {"seed", "Seed of everything random in the session", "integer",
             [](const SessionRow& session) { return std::to_string(session.seed); }},
            {"rng", "Random generator", "text", &SessionRow::rng},
            {"epoch",
             "wall: UTC is the clock's; virtual: UTC counts from 2000-01-01T00:00:00Z",
             "text",
             &SessionRow::epoch,
             {.levels = {"virtual", "wall"}}},
            {"started_utc", "Start", "time", &SessionRow::started_utc},
            {"ended_utc", "End", "time", &SessionRow::ended_utc},
            {"end_state",
             "How the session ended",
             "text",
             &SessionRow::end_state,
             {.levels = {"complete", "aborted", "crashed", "withdrawn"}}},
            {"counted",
             "1 if cells, scores and thresholds count this session: one that the participant completed under this "
             "protocol, else the latest; 0 if the participant is excluded",
             "0/1",
             [&counted](const SessionRow& session) { return counted.count(session.session_id) != 0; },
             {.levels = {"0", "1"}}},
            {"n_segments", "Runs of the program that the session took", "integer", &SessionRow::segments},
            {"n_planned_trials", "Trials in the session's plan", "integer", &SessionRow::planned_trials},
            {"n_attempts", "Attempts made", "integer", &SessionRow::attempts},
            {"n_valid_attempts", "Attempts that may be analysed", "integer", &SessionRow::valid_attempts},
            protocolColumn<SessionRow>(kInFolder),
            {"app_version", "Version of the program", "text", &SessionRow::app_version}});
    return columns;
}

/// Refers to `study`.
ColumnsOf<ParticipantRow> participantTableColumns(const StudyData& study) {
    ColumnsOf<ParticipantRow> columns = participantColumns<ParticipantRow>();
    append(
        columns,
        {{"status",
          "Where the participant stands",
          "text",
          &ParticipantRow::status,
          {.levels = {"enrolled", "active", "complete", "excluded", "withdrawn"}}},
         {"status_reason", "Why", "text", &ParticipantRow::status_reason, {.typed = true}},
         {"group",
          "Group of the between-subjects factors; all if there is none; NA: there is no slot yet, or it was given "
          "back",
          "text", [&study](const ParticipantRow& person) { return groupOf(study, person.participant_id); }},
         {"sequence_index", "Row of the counterbalancing square, from 0", "integer", &ParticipantRow::sequence_index},
         {"replicate", "Which use of the square, from 0", "integer", &ParticipantRow::replicate},
         {"created_utc", "Enrolment", "time", &ParticipantRow::created_utc},
         {"n_sessions", "Sessions begun", "integer", &ParticipantRow::sessions}});
    return columns;
}

ColumnsOf<TimingRow> timingColumns() {
    const ColumnDetails microseconds{.unit = "µs"};
    return {{"loop", "What drove the loop", "text", &TimingRow::loop},
            {"n_ticks", "Ticks computed", "integer", &TimingRow::ticks},
            {"mean_us", "Computing time of a tick, mean", "number", &TimingRow::mean_us, microseconds},
            {"sd_us", "Computing time of a tick, standard deviation", "number", &TimingRow::sd_us, microseconds},
            {"p99_us", "Computing time of a tick, 99th percentile", "number", &TimingRow::p99_us, microseconds},
            {"p999_us", "Computing time of a tick, 99.9th percentile", "number", &TimingRow::p999_us, microseconds},
            {"max_us", "Computing time of a tick, largest", "number", &TimingRow::max_us, microseconds},
            {"processor_mean_us", "Of a tick's computing time what its thread spent on a processor, mean", "number",
             &TimingRow::processor_mean_us, microseconds},
            {"processor_p99_us", "The same, 99th percentile", "number", &TimingRow::processor_p99_us, microseconds},
            {"processor_p999_us", "The same, 99.9th percentile", "number", &TimingRow::processor_p999_us, microseconds},
            {"processor_max_us", "The same, largest", "number", &TimingRow::processor_max_us, microseconds},
            {"overruns", "Cycles that were missed because an earlier one took too long; 0 in virtual time", "integer",
             &TimingRow::overruns},
            {"dropped_samples", "Ticks that could not be recorded", "integer", &TimingRow::dropped_samples}};
}

/// How often something happened in the ticks of an attempt; NA: not counted there.
ColumnOf<AttemptRow> counterColumn(const store::MeasureRow& counter) {
    return {counter.measure,
            counter.label,
            "integer",
            [name = counter.measure](const AttemptRow& attempt) {
                const auto count = attempt.measures.find(name);
                return count == attempt.measures.end() ? kMissing : cell(count->second);
            },
            {.formula = counter.formula, .formula_version = counter.formula_version}};
}

ColumnsOf<AccuracyRow> accuracyColumns() {
    const auto budgetsOf = [](const AccuracyRow& row) {
        Names budgets;
        for (const double budget : row.picked_for_us) budgets.push_back(cell(budget));
        return listCell(budgets);
    };
    return {
        protocolColumn<AccuracyRow>(kInFolder),
        {"candidate", "Number of the setting in the order of measuring, from 0", "integer", &AccuracyRow::candidate},
        {"picked_for_us",
         "Budgets (accuracy_budget_us) that it was picked for, parted by ;",
         "text",
         budgetsOf,
         {.unit = "µs", .formula = "least error_p99_um among those with time_p99_us within the budget"}},
        {"mode", "Interpolation of the distance fields", "text", &AccuracyRow::mode},
        {"tolerance_um", "Asked accuracy of the distance fields", "number", &AccuracyRow::tolerance_um, {.unit = "µm"}},
        {"spacing_mm",
         "Asked distance between the held part's points",
         "number",
         &AccuracyRow::spacing_mm,
         {.unit = "mm"}},
        {"budget_nodes", "Most tree nodes that a query visits; 0: no limit", "integer", &AccuracyRow::budget_nodes},
        {"points", "Points of the held part", "integer", &AccuracyRow::points},
        {"time_median_us",
         "Time of a query against all other parts, median over poses along contact paths",
         "number",
         &AccuracyRow::time_median_us,
         {.unit = "µs",
          .formula = "of each pose the faster of two; processor time of one thread; the slowest scene counts"}},
        {"time_p99_us",
         "The same, 99th percentile",
         "number",
         &AccuracyRow::time_p99_us,
         {.unit = "µs", .formula = "nearest rank"}},
        {"time_max_us", "The same, largest", "number", &AccuracyRow::time_max_us, {.unit = "µs"}},
        {"error_mean_um",
         "Error of the depth, mean over poses along contact paths in contact",
         "number",
         &AccuracyRow::error_mean_um,
         {.unit = "µm",
          .formula = "|answer - truth|, truth by exact distances; the worst scene counts; in a database made before "
                     "revision 3 of its schema: of the signed distance, at poses without contact too",
          .formula_version = 2}},
        {"error_p99_um",
         "The same, 99th percentile",
         "number",
         &AccuracyRow::error_p99_um,
         {.unit = "µm", .formula = "nearest rank", .formula_version = 2}},
        {"error_max_um",
         "The same, largest",
         "number",
         &AccuracyRow::error_max_um,
         {.unit = "µm", .formula_version = 2}},
        {"force_error_p99_percent",
         "Error of the force's size in the area-weighted penalty of the contacts found, 99th percentile",
         "number",
         &AccuracyRow::force_error_p99_percent,
         {.unit = "%",
          .formula =
              "truth by a dense sum; at poses with at least 1 % of the largest true force; the worst scene counts"}},
        {"direction_error_p99_deg",
         "The same: angle between the force and the true one",
         "number",
         &AccuracyRow::direction_error_p99_deg,
         {.unit = "°"}},
        {"torque_error_p99_percent",
         "The same: error of the torque",
         "number",
         &AccuracyRow::torque_error_p99_percent,
         {.unit = "%",
          .formula = "share of the true force times the distance of the held part's farthest point from its origin"}}};
}

}  // namespace

Table makeEvents(const store::StoreReader& reader) {
    return makeLongTable<EventRow>("events.csv", "One row per event of a session, in the order of time.",
                                   eventColumns(), [&reader](const auto& take) { return reader.eachEvent(take); });
}

Table makeSessions(const StudyData& study) {
    const std::set<std::string> counted = countedSessions(study);
    return makeTable("sessions.csv", "One row per session.", sessionColumns(study, counted), study.sessions);
}

Table makeParticipants(const StudyData& study) {
    return makeTable("participants.csv", "One row per participant.", participantTableColumns(study),
                     study.participants);
}

Table makeTiming(const StudyData& study) {
    struct TimedAttempt {
        const AttemptRow* attempt;
    };
    ColumnsOf<TimedAttempt> columns;
    append(columns, attemptColumns(), attemptOf<TimedAttempt>);
    append(columns, timingColumns(),
           [](const TimedAttempt& timed) -> const TimingRow& { return *timed.attempt->timing; });
    for (const store::MeasureRow& counter : study.counters)
        append(columns, ColumnsOf<AttemptRow>{counterColumn(counter)}, attemptOf<TimedAttempt>);
    return makeAttemptTable<TimedAttempt>(
        study, "timing.csv",
        "One row per attempt that has ended: how well the haptic loop kept its rate. Times are NA where "
        "the loop ran in virtual time.",
        std::move(columns), [](const AttemptRow& attempt, const auto& take) {
            if (attempt.timing) take({&attempt});
        });
}

Table makeAccuracy(const StudyData& study) {
    return makeTable("accuracy.csv",
                     "One row per setting of the contact that was measured for accuracy = \"auto\" when the protocol "
                     "first ran: what it costs and errs, and which was picked. Measured on one machine: another "
                     "database of the same protocol may hold other times and picks.",
                     accuracyColumns(), study.accuracy);
}

}  // namespace passung::exporter
