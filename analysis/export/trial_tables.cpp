#include "analysis/export/trial_tables.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "study/plan/participant.h"

namespace passung::exporter {
namespace {

/// Columns of trials.csv before the factors.
std::vector<Column> leadingColumns() {
    std::vector<Column> columns = whoColumns();
    const std::vector<Column> more = {
        {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
        {"station", "Place where the session ran", "", "text", "", 1, {}},
        {"device", "Haptic device of the attempt", "", "text", "", 1, {}},
        {"block_index", "Number of the block, from 0", "", "integer", "", 1, {}},
        {"block", "Name of the block", "", "text", "", 1, {}},
        {"phase", "Phase of the block", "", "text", "", 1, {"practice", "main", "catch", "adaptive"}},
        {"trial_index", "Number of the trial in the session, from 0", "", "integer", "", 1, {}},
        {"trial_in_block", "Number of the trial in the block, from 0", "", "integer", "", 1, {}},
        {"repetition", "Pass through the block's conditions, from 1", "", "integer", "", 1, {}},
        {"attempt_no", "Number of the attempt at this trial, from 1", "", "integer", "", 1, {}},
        sequenceColumn(),
        {"order_position",
         "Place of the attempt among those of its block in this session as they were made, from 1; NA: not known, as "
         "missing.csv lists an attempt of the session",
         "",
         "integer",
         "",
         1,
         {}},
        {"condition", "Name of the condition: its levels joined by /", "", "text", "", 1, {}},
        {"previous_condition",
         "Condition of the attempt made before it in the same block; NA: there is none, or order_position is not known",
         "",
         "text",
         "",
         1,
         {}},
    };
    columns.insert(columns.end(), more.begin(), more.end());
    return columns;
}

/// Columns of trials.csv between the factors and the measures.
std::vector<Column> resultColumns() {
    return {
        {"start_s", "Start of the attempt in session time: see t_s of events.csv", "s", "number", "", 1, {}},
        {"start_tick",
         "Tick of the attempt's samples at which the trial began: measures take the samples from there on; NA: it "
         "never began, or cycles were missed and samples before it are missing",
         "",
         "integer",
         "",
         1,
         {}},
        {"end_tick",
         "Tick at which the trial ended, by success, failure, time-out or abort: measures take the samples up to the "
         "one before it; later ones are of the loop running out. NA: as start_tick, or it has not ended",
         "",
         "integer",
         "",
         1,
         {}},
        {"duration_s", "From the start of the attempt to its end", "s", "number", "end - start", 1, {}},
        {"outcome",
         "How the attempt ended; crashed: the program ended first; running: it has not ended yet",
         "",
         "text",
         "",
         1,
         {"success", "failure", "timeout", "aborted", "crashed", "running"}},
        {"valid", "1 if the attempt may be analysed", "", "0/1", "", 1, {"0", "1"}},
        {"invalid_reason", "Why the attempt may not be analysed", "", "text", "", 1, {}},
        {"counted",
         "1 if cells_long.csv and the wide tables count the attempt",
         "",
         "0/1",
         "valid = 1, phase = main, outcome success, failure or timeout, and counted = 1 of the session in sessions.csv",
         1,
         {"0", "1"}},
        {"not_counted_because", "Why they do not count it; NA: they do", "", "text", "", 1, {}},
    };
}

/// Columns of trials.csv after the measures.
std::vector<Column> closingColumns() {
    return {
        {"feedback_given",
         "What reached the participant of the condition's feedback, joined by +: kinesthetic (force), visual, "
         "vibrotactile, audio, masking_noise; none. Given is what a device rendered, a window drew or a loudspeaker "
         "played at least once in the attempt, and to simulated participants what their senses were handed; where "
         "nothing touched, neither force nor cue was. NA: not known, as of attempts that did not end",
         "",
         "text",
         "",
         1,
         {}},
        {"timed_by",
         "Who said when the trial began and ended; simulated participants have their part of the experimenter "
         "simulated "
         "too",
         "",
         "text",
         "",
         1,
         {"program", "experimenter", "clock"}},
        {"protocol_sha256", "SHA-256 of the protocol's text, see protocol/", "", "text", "", 1, {}},
        {"app_version", "Version of the program", "", "text", "", 1, {}},
    };
}

void append(std::vector<Column>& columns, const std::vector<Column>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
}

std::string feedbackOf(const store::AttemptRow& a) {
    if (!a.delivered) return kMissing;
    std::string text;
    const auto add = [&](std::int64_t count, const char* name) {
        if (count > 0) text += (text.empty() ? "" : "+") + std::string(name);
    };
    add(a.delivered->force, "kinesthetic");
    add(a.delivered->visual, "visual");
    add(a.delivered->vibration, "vibrotactile");
    add(a.delivered->sound, "audio");
    add(a.delivered->masking, "masking_noise");
    return text.empty() ? "none" : text;
}

/// What a row says of its attempt's place in the session; nothing if other attempts may be missing.
struct Course {
    std::optional<std::int64_t> position;  // in the block, from 1
    std::string previous = kMissing;
};

/// Parts of a session that go missing without its attempts.
bool isBesideAttempts(const std::string& part) {
    return part.starts_with("form ") || part.ends_with(", samples") || part.ends_with(", event") ||
           part.ends_with(", order_step") || part == "note" || part == "later changes";
}

/// May attempts of the session be missing for what is damaged?
bool mayLack(const store::AttemptRow& of, const std::vector<store::DamageRow>& damages) {
    return std::any_of(damages.begin(), damages.end(), [&](const store::DamageRow& damage) {
        if (isBesideAttempts(damage.part)) return false;
        if (!damage.session_ordinal) return damage.part == "condition";
        return damage.participant_id == of.participant_id && damage.session_ordinal == of.session_ordinal;
    });
}

/// By attempt.
std::map<std::int64_t, Course> coursesOf(const StudyData& study) {
    std::vector<const store::AttemptRow*> made;
    for (const store::AttemptRow& attempt : study.attempts) made.push_back(&attempt);
    std::sort(made.begin(), made.end(), [](const auto* a, const auto* b) {
        return std::tie(a->session_id, a->start_ns, a->attempt_id) <
               std::tie(b->session_id, b->start_ns, b->attempt_id);
    });
    std::map<std::pair<std::string, std::int64_t>, std::pair<std::int64_t, const store::AttemptRow*>> blocks;
    std::map<std::int64_t, Course> courses;
    for (const store::AttemptRow* attempt : made) {
        if (mayLack(*attempt, study.damages)) {
            courses[attempt->attempt_id] = {};
            continue;
        }
        auto& [count, last] = blocks[{attempt->session_id, attempt->block_index}];
        courses[attempt->attempt_id] = {++count, last != nullptr ? last->condition : std::string(kMissing)};
        last = attempt;
    }
    return courses;
}

/// Why the means leave the attempt out; nothing if they count it.
std::optional<std::string> notCounted(const store::AttemptRow& a, const std::set<std::string>& excluded,
                                      const std::set<std::string>& counted_sessions) {
    if (excluded.count(a.participant_id) != 0) return "the participant is excluded";
    if (a.phase != "main")
        return a.phase == "adaptive" ? "trial of a staircase: see thresholds.csv"
               : a.phase == "catch"  ? "catch trial"
                                     : a.phase;
    if (!a.valid) return "not valid: " + a.invalid_reason.value_or("no reason is stored");
    if (!a.counts()) return a.outcome;
    if (counted_sessions.count(a.session_id) == 0) return "a complete or later session of the participant counts";
    return std::nullopt;
}

/// What all rows of trials.csv look up.
class TrialRows {
public:
    explicit TrialRows(const StudyData& study)
        : study_(study), courses_(coursesOf(study)), counted_(countedSessions(study)) {
        for (const store::ParticipantRow& person : study.participants)
            if (person.status == "excluded") excluded_.insert(person.participant_id);
    }

    std::vector<std::string> row(const store::AttemptRow& a) const {
        const Course& course = courses_.at(a.attempt_id);
        std::vector<std::string> row = {a.participant_id,
                                        a.kind,
                                        a.group,
                                        cell(a.session_ordinal),
                                        a.station,
                                        a.device,
                                        cell(a.block_index),
                                        a.block,
                                        a.phase,
                                        cell(a.trial_index),
                                        cell(a.trial_in_block),
                                        cell(a.repetition),
                                        cell(a.attempt_no),
                                        sequenceOf(study_, a.participant_id),
                                        cell(course.position),
                                        a.condition,
                                        course.previous};
        for (const FactorColumn& factor : study_.factors) row.push_back(levelOf(a.levels, factor.factor));
        std::optional<std::int64_t> duration;
        if (a.end_ns) duration = *a.end_ns - a.start_ns;
        const auto because = notCounted(a, excluded_, counted_);
        row.insert(row.end(), {secondsCell(a.start_ns), cell(a.start_tick), cell(a.end_tick), secondsCell(duration),
                               a.outcome, cell(a.valid), cell(a.invalid_reason), cell(!because), cell(because)});
        for (const store::MeasureRow& measure : study_.measures) {
            const auto found = a.measures.find(measure.measure);
            row.push_back(found == a.measures.end() ? kMissing : cell(found->second));
        }
        row.insert(row.end(), {feedbackOf(a), a.timed_by, a.protocol_sha256, a.app_version});
        return row;
    }

private:
    const StudyData& study_;
    std::map<std::int64_t, Course> courses_;
    std::set<std::string> counted_, excluded_;
};

}  // namespace

std::vector<Column> whoColumns() {
    return {
        {"participant_id", "Code of the participant", "", "text", "", 1, {}},
        {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
        {"group",
         "Group of the between-subjects factors; all if there is none; NA: the place was given back, see "
         "order_sequence",
         "",
         "text",
         "",
         1,
         {}}};
}

Column sequenceColumn() {
    return {"order_sequence",
            "Row of the counterbalancing that the participant has, from 0: sequence_index of participants.csv; NA: the "
            "place was given back, as after a session that did not complete and by exclusion",
            "",
            "integer",
            "",
            1,
            {}};
}

void appendFactors(std::vector<Column>& columns, const StudyData& study) {
    for (const FactorColumn& factor : study.factors) {
        columns.push_back({factor.column, "Factor " + factor.factor + " (" + factor.kind + ")", factor.unit, "text", "",
                           1, factor.levels});
    }
}

Column measureColumn(const store::MeasureRow& measure) {
    return {measure.measure,
            measure.label,
            measure.unit == "1" ? "" : measure.unit,
            "number",
            measure.formula,
            measure.formula_version,
            {}};
}

std::string columnPart(const std::string& condition) {
    std::string part = condition;
    for (char& c : part) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                           c == '-' || c == '_';
        if (!plain) c = '_';
    }
    return part;
}

std::vector<Column> fixedColumns() {
    std::vector<Column> columns = leadingColumns();
    append(columns, resultColumns());
    append(columns, closingColumns());
    return columns;
}

Table makeTrials(const StudyData& study) {
    Table table{"trials.csv", "One row per attempt at a trial, whatever became of it.", leadingColumns(), {}};
    appendFactors(table.columns, study);
    append(table.columns, resultColumns());
    for (const store::MeasureRow& measure : study.measures) table.columns.push_back(measureColumn(measure));
    append(table.columns, closingColumns());
    const TrialRows rows(study);
    for (const store::AttemptRow& attempt : study.attempts) table.rows.push_back(rows.row(attempt));
    return table;
}

}  // namespace passung::exporter
