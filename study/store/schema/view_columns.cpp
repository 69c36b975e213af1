#include "study/store/schema/view_columns.h"

#include <algorithm>
#include <utility>

#include "core/base/assert.h"

namespace passung::store {
namespace {

using Columns = std::vector<ViewColumn>;

// Parts of views, of rows of session s, participant pa, trial_plan t, attempt a
const char* const kEnded = "a.outcome IN('success','failure','timeout')";
const char* const kTrialStart =
    "(SELECT min(e.t_ns) FROM event e WHERE e.attempt_id=a.attempt_id AND e.event='trial_started')";

const char* const kNewestForm =
    "r.run_id=(SELECT max(o.run_id) FROM questionnaire_run o JOIN questionnaire k USING(questionnaire_sha256) WHERE "
    "o.session_id=r.session_id AND k.key=q.key AND o.moment=r.moment AND o.block_index IS r.block_index AND o.trial_id "
    "IS r.trial_id AND o.condition_id IS r.condition_id)";

/// What the protocols' rules on recorded values leave out, as applyRules() of analysis/export/data_rules.h does: rows
/// of trial_rule and person_rule, each with the text of the first rule that is broken.
std::string ruleParts() {
    return std::string(
               "rule AS MATERIALIZED (SELECT p.protocol_sha256, x.key + 1 number, json_extract(x.value, "
               "'$.data')='participants' of_people, json_extract(x.value, '$.value') value, json_extract(x.value, "
               "'$.below') below, json_extract(x.value, '$.above') above, 'rule ' || (x.key + 1) || ': ' || "
               "json_extract(x.value, '$.value') || coalesce(' below ' || (x.value -> '$.below'), '') || coalesce(CASE "
               "WHEN json_extract(x.value, '$.below') IS NULL THEN '' ELSE ' or' END || ' above ' || (x.value -> "
               "'$.above'), '') || coalesce(' (' || json_extract(x.value, '$.reason') || ')', '') told FROM "
               "protocol_version p, json_each(CASE WHEN json_valid(p.expanded_json) THEN p.expanded_json ELSE '{}' "
               "END, "
               "'$.data_rules') x), trial_rule AS MATERIALIZED (SELECT a.attempt_id, min(x.number), x.told FROM rule x "
               "JOIN session s USING(protocol_sha256) JOIN trial_plan t USING(session_id) JOIN attempt a "
               "USING(trial_id) JOIN attempt_measure z ON z.attempt_id=a.attempt_id AND z.measure=x.value WHERE NOT "
               "x.of_people AND t.phase='main' AND a.valid AND ") +
           kEnded +
           " AND (z.value_num<x.below OR z.value_num>x.above) GROUP BY a.attempt_id), of_person AS (SELECT x.number, "
           "s.protocol_sha256, s.participant_id, z.value_num value FROM rule x JOIN session s USING(protocol_sha256) "
           "JOIN participant pa USING(participant_id) JOIN trial_plan t USING(session_id) JOIN attempt a "
           "USING(trial_id) JOIN attempt_measure z ON z.attempt_id=a.attempt_id AND z.measure=x.value WHERE "
           "x.of_people "
           "AND t.phase='main' AND a.valid AND " +
           kEnded + " AND " + countedSession() +
           " AND a.attempt_id NOT IN (SELECT attempt_id FROM trial_rule) UNION ALL SELECT x.number, s.protocol_sha256, "
           "s.participant_id, z.value FROM rule x JOIN session s USING(protocol_sha256) JOIN participant pa "
           "USING(participant_id) JOIN questionnaire_run r USING(session_id) JOIN questionnaire q "
           "USING(questionnaire_sha256) JOIN score z USING(run_id) WHERE x.of_people AND q.key || '.' || "
           "z.scale=x.value AND " +
           countedSession() + " AND " + kNewestForm +
           "), person_rule AS MATERIALIZED (SELECT m.protocol_sha256, m.participant_id, min(m.number), x.told FROM "
           "(SELECT number, protocol_sha256, participant_id, avg(value) mean FROM of_person GROUP BY 1, 2, 3) m JOIN "
           "rule x USING(protocol_sha256, number) WHERE m.mean<x.below OR m.mean>x.above GROUP BY 1, 2) ";
}

/// Of a row of `session s`, beside ruleParts(): whether its person is left out by no rule.
const char* const kNotLeftOut =
    "NOT EXISTS(SELECT 1 FROM person_rule x WHERE x.protocol_sha256=s.protocol_sha256 AND "
    "x.participant_id=s.participant_id)";

/// And of its `participant pa`: whether means are taken over it.
std::string takenSession() { return "(" + countedSession() + " AND " + kNotLeftOut + ")"; }

const ViewColumn kParticipant{"participant_id", "s.participant_id", "Code of the participant"};
const ViewColumn kKind{"kind", "pa.kind", "Real person, pilot or simulated participant"};
const ViewColumn kBetweenGroup{
    "group",
    "coalesce((SELECT d.between_group FROM design_slot d WHERE d.participant_id=s.participant_id), CASE WHEN NOT "
    "EXISTS(SELECT 1 FROM factor b WHERE b.kind='between') THEN 'all' END)",
    "Group of the between-subjects factors; all if there is none; NA: the slot was given back, see order_sequence"};
const ViewColumn kSession{"session", "s.ordinal", "Number of the participant's session, from 1"};
const ViewColumn kSequence{
    "order_sequence", "(SELECT d.sequence_index FROM design_slot d WHERE d.participant_id=s.participant_id)",
    "Row of the counterbalancing that the participant has, from 0: sequence_index of participants.csv; NA: the slot "
    "was given back, as after a session that did not complete and by exclusion"};
const ViewColumn kBlockIndex{"block_index", "t.block_index", "Number of the block, from 0"};
const ViewColumn kBlock{"block", "t.block", "Name of the block"};
const ViewColumn kTrialIndex{"trial_index", "t.trial_index", "Number of the trial in the session, from 0"};
const ViewColumn kAttemptNumber{"attempt_no", "a.attempt_no", "Number of the attempt at this trial, from 1"};
const ViewColumn kCondition{"condition", "c.condition", "Name of the condition: its levels joined by /"};
const ViewColumn kProtocol{"protocol_sha256", "s.protocol_sha256", "SHA-256 of the protocol's text"};

/// A column with texts that somebody typed.
ViewColumn typed(ViewColumn column) {
    column.typed = true;
    return column;
}

/// A column whose SQL is another one in the view: `sql`, with the column's own at {}.
ViewColumn inView(ViewColumn column, std::string sql) {
    column.in_view = std::move(sql);
    column.in_view.replace(column.in_view.find("{}"), 2, "(" + column.sql + ")");
    return column;
}

Columns trialColumns() {
    return {
        {"attempt_id", "a.attempt_id", "Number of the attempt in this database, as in its tables"},
        kParticipant,
        kKind,
        kBetweenGroup,
        kSession,
        {"station", "s.station", "Place where the session ran"},
        // A mouse stands for the device that the condition names; once only its name told that.
        {"device",
         "CASE WHEN coalesce(json_extract(g.device_json, '$.stands_for_preset'), json_extract(g.device_json, "
         "'$.name')='mouse') THEN json_extract(g.device_json, '$.name') ELSE coalesce(json_extract(a.params_json, "
         "'$.device'), json_extract(g.device_json, '$.name')) END",
         "Haptic device of the attempt"},
        kBlockIndex,
        kBlock,
        {"phase", "t.phase", "Phase of the block"},
        kTrialIndex,
        {"trial_in_block", "t.trial_in_block", "Number of the trial in the block, from 0"},
        {"repetition", "t.repetition", "Pass through the block's conditions, from 1"},
        kAttemptNumber,
        kSequence,
        {"order_position", "row_number() OVER made",
         "Place of the attempt among those of its block in this session as they were made, from 1; NA: not known, as "
         "missing.csv lists an attempt of the session"},
        kCondition,
        {"previous_condition", "lag(c.condition) OVER made",
         "Condition of the attempt made before it in the same block; NA: there is none, or order_position is not "
         "known"},
        {"start_s", "a.start_ns/1e9", "Start of the attempt in session time: see t_s of events.csv", "s"},
        {"start_tick",
         std::string("CASE WHEN m.overruns=0 THEN (") + kTrialStart + " - a.start_ns + 500000)/1000000 END",
         "Tick of the attempt's samples at which the trial began: measures take the samples from there on; NA: it "
         "never began, or cycles were missed and samples before it are missing"},
        {"end_tick",
         std::string("CASE WHEN m.overruns=0 AND ") + kTrialStart +
             " IS NOT NULL THEN (a.end_ns - a.start_ns + 500000)/1000000 END",
         "Tick at which the trial ended, by success, failure, time-out or abort: measures take the samples up to the "
         "one before it; later ones are of the loop running out. NA: as start_tick, or it has not ended"},
        {"duration_s", "(a.end_ns - a.start_ns)/1e9", "From the start of the attempt to its end", "s", "end - start"},
        {"outcome", "a.outcome",
         "How the attempt ended; crashed: the program ended first; running: it has not ended yet"},
        // Whoever is excluded counts nowhere; their rows stay as they are.
        {"valid", "(a.valid AND pa.status<>'excluded')", "1 if the attempt may be analysed"},
        typed({"invalid_reason",
               "CASE WHEN a.valid AND pa.status='excluded' THEN 'participant excluded' ELSE a.invalid_reason END",
               "Why the attempt may not be analysed"}),
        inView({"counted",
                std::string("(t.phase='main' AND a.valid AND ") + kEnded + " AND " + countedSession() + ")",
                "1 if cells_long.csv and the wide tables count the attempt",
                {},
                "valid = 1, phase = main, outcome success, failure or timeout, counted = 1 of the session in "
                "sessions.csv, "
                "and left out by no [[exclude]] of the protocol"},
               "tr.told IS NULL AND pr.told IS NULL AND {}"),
        inView(
            typed({"not_counted_because",
                   std::string(
                       "CASE WHEN pa.status='excluded' THEN 'the participant is excluded' WHEN t.phase='adaptive' THEN "
                       "'trial of a staircase: see thresholds.csv' WHEN t.phase='catch' THEN 'catch trial' WHEN "
                       "t.phase<>'main' THEN t.phase WHEN NOT a.valid THEN 'not valid: ' || coalesce(a.invalid_reason, "
                       "'no reason is stored') WHEN NOT ") +
                       kEnded + " THEN a.outcome WHEN NOT " + countedSession() +
                       " THEN 'a complete or later session of the participant counts' END",
                   "Why they do not count it; NA: they do"}),
            "coalesce(pr.told, {}, tr.told)"),
        {"feedback_given",
         "(SELECT coalesce(nullif(substr(CASE WHEN y.force_ticks>0 THEN '+kinesthetic' ELSE '' END || CASE WHEN "
         "y.visual_frames>0 THEN '+visual' ELSE '' END || CASE WHEN y.vibrotactile_ticks>0 THEN '+vibrotactile' ELSE "
         "'' END || CASE WHEN y.audio_ticks>0 THEN '+audio' ELSE '' END || CASE WHEN y.masking_ticks>0 THEN "
         "'+masking_noise' ELSE '' END, 2), ''), 'none') FROM delivery y WHERE y.attempt_id=a.attempt_id)",
         "What reached the participant of the condition's feedback, joined by +: kinesthetic (force), visual, "
         "vibrotactile, audio, masking_noise; none. Given is what a device rendered, a window drew or a loudspeaker "
         "played at least once in the attempt, and to simulated participants what their senses were handed; where "
         "nothing touched, neither force nor cue was. NA: not known, as of attempts that did not end"},
        {"timed_by", "coalesce(json_extract(a.params_json, '$.timed_by'), 'program')",
         "Who said when the trial began and ended; simulated participants have their part of the experimenter "
         "simulated too"},
        kProtocol,
        {"app_version", "g.app_version", "Version of the program"}};
}

const char* const kFromTrials =
    "FROM attempt a JOIN trial_plan t USING(trial_id) JOIN session s USING(session_id) JOIN participant pa "
    "USING(participant_id) JOIN segment g ON g.segment_id=a.segment_id JOIN condition c USING(condition_id) LEFT JOIN "
    "timing m USING(attempt_id) LEFT JOIN trial_rule tr USING(attempt_id) LEFT JOIN person_rule pr ON "
    "pr.protocol_sha256=s.protocol_sha256 AND pr.participant_id=s.participant_id WINDOW made AS (PARTITION BY "
    "t.session_id, t.block_index ORDER BY a.start_ns, "
    "a.attempt_id)";

const char* const kRestricted =
    "area under the Kaplan-Meier curve of time_s with finished from 0 to restricted_to_s, carried on level after the "
    "last time: the mean of min(time_s, restricted_to_s) where whatever is not finished ended at a time-out";

/// A row for each cell and measure, where cells_long.csv has columns for each measure.
Columns cellColumns() {
    return {kParticipant,
            kKind,
            kBetweenGroup,
            kSequence,
            kSession,
            kBlockIndex,
            kBlock,
            kProtocol,
            kCondition,
            {"n_trials",
             "coalesce(r.trials, 0)",
             "Attempts counted",
             {},
             "count over the attempts with counted = 1 in trials.csv"},
            {"n_success", "coalesce(r.successes, 0)", "Attempts counted that succeeded"},
            {"success_share", "1.0*r.successes/r.trials", "Share of success", {}, "n_success / n_trials"},
            {"measure", "d.measure", "Measure that the columns after this are of: see column_doc"},
            {"mean", "v.mean", "Mean of the measure", "of the measure",
             "mean over the attempts with counted = 1 in trials.csv that have a value"},
            {"median", "v.median", "Median of the measure", "of the measure",
             "median over the attempts with counted = 1 in trials.csv that have a value"},
            {"n",
             "coalesce(v.n, 0)",
             "Attempts counted that have a value",
             {},
             "n over the attempts with counted = 1 in trials.csv that have a value"},
            {"restricted_mean", "CASE WHEN d.measure='time_s' THEN w.restricted_mean END",
             "Restricted mean of time_s; NA of all other measures", "s", kRestricted},
            {"restricted_to_s", "CASE WHEN d.measure='time_s' THEN h.horizon_s END",
             "Up to where that mean goes: the shortest time-out of the block's conditions", "s",
             "where the stored plan tells no time-out: the longest time_s of the block"}};
}

/// Steps of the restricted mean as restrictedMean() of analysis/export/cells.h says it.
std::string cellParts() {
    return "WITH RECURSIVE " + ruleParts() +
           ", cell AS (SELECT DISTINCT t.session_id, t.block_index, t.block, t.condition_id FROM "
           "trial_plan t JOIN session s USING(session_id) JOIN participant pa USING(participant_id) WHERE "
           "t.phase='main' AND " +
           takenSession() +
           "), made AS MATERIALIZED (SELECT t.session_id, t.block_index, t.block, t.condition_id, a.attempt_id, "
           "a.outcome FROM attempt a JOIN trial_plan t USING(trial_id) JOIN session s USING(session_id) JOIN "
           "participant pa USING(participant_id) WHERE t.phase='main' AND a.valid AND " +
           kEnded + " AND " + takenSession() +
           " AND a.attempt_id NOT IN (SELECT attempt_id FROM trial_rule)), result AS (SELECT session_id, block_index, "
           "condition_id, count(*) trials, sum(outcome='success') "
           "successes FROM made GROUP BY 1, 2, 3), worth AS (SELECT y.session_id, y.block_index, y.condition_id, "
           "z.measure, z.value_num, row_number() OVER(PARTITION BY y.session_id, y.block_index, y.condition_id, "
           "z.measure ORDER BY z.value_num) place, count(*) OVER(PARTITION BY y.session_id, y.block_index, "
           "y.condition_id, z.measure) n FROM made y JOIN attempt_measure z USING(attempt_id) WHERE z.value_num IS NOT "
           "NULL), summary AS (SELECT session_id, block_index, condition_id, measure, avg(value_num) mean, avg(CASE "
           "WHEN place IN((n + 1)/2, (n + 2)/2) THEN value_num END) median, count(*) n FROM worth GROUP BY 1, 2, 3, "
           "4), lasted AS MATERIALIZED (SELECT y.*, z.value_num time_s, coalesce(f.value_num>0.5, "
           "y.outcome='success') finished FROM made y JOIN attempt_measure z ON z.attempt_id=y.attempt_id AND "
           "z.measure='time_s' LEFT JOIN attempt_measure f ON f.attempt_id=y.attempt_id AND f.measure='finished' WHERE "
           "z.value_num IS NOT NULL), "
           // Up to where times are compared
           "told AS (SELECT b.protocol_sha256, b.block, min(json_extract(j.value, '$.params.task.timeout_s')) "
           "horizon_s FROM (SELECT DISTINCT s.protocol_sha256, t.block, c.condition FROM trial_plan t JOIN session s "
           "USING(session_id) JOIN condition c USING(condition_id) WHERE t.phase='main') b JOIN protocol_version p "
           "USING(protocol_sha256) JOIN json_each(p.expanded_json, '$.conditions') j ON json_extract(j.value, "
           "'$.condition')=b.condition GROUP BY 1, 2), longest AS (SELECT s.protocol_sha256, y.block, max(y.time_s) "
           "horizon_s FROM lasted y JOIN session s USING(session_id) GROUP BY 1, 2), horizon AS MATERIALIZED (SELECT "
           "b.protocol_sha256, b.block, coalesce((SELECT x.horizon_s FROM told x WHERE "
           "x.protocol_sha256=b.protocol_sha256 AND x.block=b.block), (SELECT x.horizon_s FROM longest x WHERE "
           "x.protocol_sha256=b.protocol_sha256 AND x.block=b.block)) horizon_s FROM (SELECT DISTINCT "
           "s.protocol_sha256, q.block FROM cell q JOIN session s USING(session_id)) b), "
           // Along the curve: what finishes at a time is over before what is censored there
           "timeline AS MATERIALIZED (SELECT y.session_id, y.block_index, y.condition_id, y.time_s, y.finished, "
           "h.horizon_s, row_number() OVER(PARTITION BY y.session_id, y.block_index, y.condition_id ORDER BY y.time_s, "
           "y.finished DESC) place, count(*) OVER(PARTITION BY y.session_id, y.block_index, y.condition_id) n FROM "
           "lasted y JOIN session s USING(session_id) JOIN horizon h ON h.protocol_sha256=s.protocol_sha256 AND "
           "h.block=y.block), walk(session_id, block_index, condition_id, horizon_s, n, place, share, area, last) AS "
           "(SELECT session_id, block_index, condition_id, horizon_s, n, 0, 1.0, 0.0, 0.0 FROM timeline WHERE place=1 "
           "UNION ALL SELECT y.session_id, y.block_index, y.condition_id, y.horizon_s, y.n, y.place + 1, CASE WHEN "
           "z.finished THEN y.share*(1.0 - 1.0/(y.n - y.place)) ELSE y.share END, y.area + y.share*(z.time_s - "
           "y.last), z.time_s FROM walk y JOIN timeline z ON z.session_id=y.session_id AND "
           "z.block_index=y.block_index AND z.condition_id=y.condition_id AND z.place=y.place + 1 AND "
           "z.time_s<z.horizon_s), restricted AS (SELECT session_id, block_index, condition_id, max(place), area + "
           "share*(horizon_s - last) restricted_mean FROM walk GROUP BY 1, 2, 3) ";
}

const char* const kFromCells =
    "FROM cell t JOIN session s USING(session_id) JOIN participant pa USING(participant_id) JOIN condition c "
    "USING(condition_id) JOIN (SELECT DISTINCT measure FROM protocol_measure WHERE measure NOT GLOB '*_ticks') d LEFT "
    "JOIN result r USING(session_id, block_index, condition_id) LEFT JOIN summary v ON v.session_id=t.session_id AND "
    "v.block_index=t.block_index AND v.condition_id=t.condition_id AND v.measure=d.measure LEFT JOIN restricted w ON "
    "w.session_id=t.session_id AND w.block_index=t.block_index AND w.condition_id=t.condition_id LEFT JOIN horizon h "
    "ON h.protocol_sha256=s.protocol_sha256 AND h.block=t.block";

Columns scoreColumns() {
    return {
        kParticipant,
        kKind,
        kSession,
        {"questionnaire", "q.key", "Key of the questionnaire"},
        {"version", "q.version", "Version of its items and texts"},
        {"language", "q.language", "Language in which it was shown"},
        {"moment", "r.moment", "When it was asked"},
        {"block_index", "r.block_index", "Number of the block, from 0; NA at the session's start and end"},
        {"block",
         "(SELECT t.block FROM trial_plan t WHERE t.session_id=r.session_id AND t.block_index=r.block_index LIMIT "
         "1)",
         kBlock.label},
        {"trial_index", "(SELECT t.trial_index FROM trial_plan t WHERE t.trial_id=r.trial_id)",
         "The trial that it is about, if it is about one"},
        {"condition", "c.condition",
         "The condition that it is about, if it is about one; its levels: see cells_long.csv"},
        {"completed_utc", "r.completed_utc", "When the last answer was given"},
        inView(
            {"counted", "(" + countedSession() + " AND " + kNewestForm + ")",
             "1 if means and reliability count this form: of a counted session (see sessions.csv) the newest one about "
             "its occasion"},
            std::string("{} AND ") + kNotLeftOut),
        {"scale", "z.scale", "Name of the scale"},
        {"score", "z.value", "NA: too many answers are missing", {}, "see scale_formula"},
        {"n_items", "z.n_items", "Answers that enter; one that enters by two scales counts twice"},
        {"n_missing", "z.n_missing", "Of them missing"},
        {"scoring_version", "z.scoring_version", "Counts changes of the formulas"},
        kProtocol};
}

const char* const kFromScores =
    "FROM score z JOIN questionnaire_run r USING(run_id) JOIN session s USING(session_id) JOIN participant pa "
    "USING(participant_id) JOIN questionnaire q USING(questionnaire_sha256) LEFT JOIN condition c USING(condition_id)";

Columns eventColumns() {
    return {kParticipant,
            kKind,
            kSession,
            {"t_s", "e.t_ns/1e9",
             "Session time: 1 ms for every cycle of the haptic loop, missed ones too, from the session's first attempt "
             "on. It runs in attempts and rests only and stands still in between, in instructions, questionnaires and "
             "pauses and between an interruption and the resume, after which it goes on from the last time that was "
             "stored: differences across these are not the time that passed, which t_utc tells where epoch is wall",
             "s"},
            {"t_utc", kEventUtc,
             "When, by the session's epoch (see sessions.csv): by the wall clock, pauses included, or in virtual time "
             "2000-01-01T00:00:00Z + t_s"},
            {"trial_index", "t.trial_index", "Trial that it belongs to"},
            {"attempt_no", "a.attempt_no", "Attempt that it belongs to"},
            {"source", "e.source", "Who reported it"},
            {"event", "e.event", "What happened"},
            typed({"payload_json", "e.payload_json", "More about it, as JSON"})};
}

const char* const kFromEvents =
    "FROM event e JOIN segment g USING(segment_id) JOIN session s USING(session_id) JOIN participant pa "
    "USING(participant_id) LEFT JOIN attempt a ON a.attempt_id=e.attempt_id LEFT JOIN trial_plan t USING(trial_id)";

const char* const kEstimate =
    "up-down: mean of the reversals but the first ones, an even number; psi: where the posterior is highest";

/// Without the fits: these are by likelihood, which SQL has not.
Columns thresholdColumns() {
    return {kParticipant,
            kKind,
            kSession,
            {"block", "f.block", kBlock.label},
            {"condition", "c.condition", "Condition as planned, without the staircase's key"},
            {"staircase", "f.staircase", "Name of the staircase"},
            {"track", "f.track", "Which of the tracks that take turns"},
            {"n_trials", "f.trials", "Trials that told it something and count"},
            {"n_reversals", "CASE WHEN f.invalidated=0 THEN f.reversals END", "Reversals of the track by these alone"},
            {"n_invalidated", "f.invalidated", "Trials that told it something and were invalidated later"},
            {"estimate",
             "CASE WHEN f.invalidated=0 THEN f.estimate END",
             "Threshold by the trials that count, in the key's unit",
             {},
             kEstimate},
            {"estimate_sd",
             "CASE WHEN f.invalidated=0 THEN f.estimate_sd END",
             "How unsure it is",
             {},
             "psi: posterior standard deviation, in levels or, on a logarithmic axis, decades"},
            kProtocol};
}

std::string thresholdParts() {
    return "WITH " + ruleParts() +
           ", answer AS (SELECT t.session_id, t.block, t.condition_id, f.staircase, f.track, f.reversal, "
           "f.estimate, f.estimate_sd, a.attempt_id, a.valid FROM staircase_step f JOIN attempt a USING(attempt_id) "
           "JOIN trial_plan t USING(trial_id) JOIN session s USING(session_id) JOIN participant pa "
           "USING(participant_id) WHERE f.track IS NOT NULL AND f.positive IS NOT NULL AND " +
           takenSession() +
           // Bare columns are of the row with the largest attempt_id
           "), told AS (SELECT session_id, block, condition_id, staircase, track, sum(valid<>0) trials, sum(valid=0) "
           "invalidated, sum(reversal) reversals, max(attempt_id), estimate, estimate_sd FROM answer GROUP BY "
           "session_id, staircase, condition_id, track) ";
}

const char* const kFromThresholds =
    "FROM told f JOIN session s USING(session_id) JOIN participant pa USING(participant_id) JOIN condition c "
    "USING(condition_id)";

std::vector<ViewText> makeTexts() {
    return {{"v_trials", trialColumns(), "start_s", "feedback_given", "WITH " + ruleParts(), kFromTrials},
            {"v_cells", cellColumns(), "n_trials", {}, cellParts(), kFromCells},
            {"v_scores", scoreColumns(), {}, {}, "WITH " + ruleParts(), kFromScores},
            {"v_events", eventColumns(), {}, {}, {}, kFromEvents},
            {"v_thresholds", thresholdColumns(), "n_trials", {}, thresholdParts(), kFromThresholds}};
}

}  // namespace

const ViewText& textOf(StudyView view) {
    static const std::vector<ViewText> all = makeTexts();
    return all[static_cast<std::size_t>(view)];
}

const ViewColumn& viewColumn(StudyView view, std::string_view name) {
    const auto& columns = textOf(view).columns;
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const ViewColumn& column) { return column.name == name; });
    PASSUNG_ASSERT(found != columns.end());
    return *found;
}

const std::string& countedSession() {
    static const std::string text =
        "(pa.status<>'excluded' AND (s.end_state IS 'complete' OR NOT EXISTS(SELECT 1 FROM session o WHERE "
        "o.participant_id=s.participant_id AND o.protocol_sha256=s.protocol_sha256 AND (o.end_state IS 'complete' OR "
        "o.ordinal>s.ordinal))))";
    return text;
}

}  // namespace passung::store
