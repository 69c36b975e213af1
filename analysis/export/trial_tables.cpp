#include "analysis/export/trial_tables.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "analysis/export/shared_columns.h"

namespace passung::exporter {
namespace {

using store::AttemptRow;

std::string feedbackOf(const AttemptRow& a) {
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
bool mayLack(const AttemptRow& of, const std::vector<store::DamageRow>& damages) {
    return std::any_of(damages.begin(), damages.end(), [&](const store::DamageRow& damage) {
        if (isBesideAttempts(damage.part)) return false;
        if (!damage.session_ordinal) return damage.part == "condition";
        return damage.participant_id == of.participant_id && damage.session_ordinal == of.session_ordinal;
    });
}

/// By attempt.
std::map<std::int64_t, Course> coursesOf(const StudyData& study) {
    std::vector<const AttemptRow*> made;
    for (const AttemptRow& attempt : study.attempts) made.push_back(&attempt);
    std::sort(made.begin(), made.end(), [](const auto* a, const auto* b) {
        return std::tie(a->session_id, a->start_ns, a->attempt_id) <
               std::tie(b->session_id, b->start_ns, b->attempt_id);
    });
    std::map<std::pair<std::string, std::int64_t>, std::pair<std::int64_t, const AttemptRow*>> blocks;
    std::map<std::int64_t, Course> courses;
    for (const AttemptRow* attempt : made) {
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
std::optional<std::string> notCounted(const AttemptRow& a, const std::set<std::string>& excluded,
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
class TrialLookup {
public:
    explicit TrialLookup(const StudyData& study) : courses_(coursesOf(study)), counted_(countedSessions(study)) {
        for (const store::ParticipantRow& person : study.participants)
            if (person.status == "excluded") excluded_.insert(person.participant_id);
    }

    const Course& courseOf(const AttemptRow& attempt) const { return courses_.at(attempt.attempt_id); }
    std::optional<std::string> notCountedBecause(const AttemptRow& attempt) const {
        return notCounted(attempt, excluded_, counted_);
    }

private:
    std::map<std::int64_t, Course> courses_;
    std::set<std::string> counted_, excluded_;
};

/// Columns before the factors. Refers to `study` and `lookup`.
ColumnsOf<AttemptRow> leadingColumns(const StudyData& study, const TrialLookup& lookup) {
    ColumnsOf<AttemptRow> columns = whoColumns<AttemptRow>();
    append(
        columns,
        {sessionColumn<AttemptRow>(),
         {"station", "Place where the session ran", "text", &AttemptRow::station},
         {"device", "Haptic device of the attempt", "text", &AttemptRow::device},
         blockIndexColumn<AttemptRow>(),
         blockColumn<AttemptRow>(),
         {"phase",
          "Phase of the block",
          "text",
          &AttemptRow::phase,
          {.levels = {"practice", "main", "catch", "adaptive"}}},
         trialIndexColumn(),
         {"trial_in_block", "Number of the trial in the block, from 0", "integer", &AttemptRow::trial_in_block},
         {"repetition", "Pass through the block's conditions, from 1", "integer", &AttemptRow::repetition},
         attemptNumberColumn(),
         sequenceColumn<AttemptRow>(study),
         {"order_position",
          "Place of the attempt among those of its block in this session as they were made, from 1; NA: not known, as "
          "missing.csv lists an attempt of the session",
          "integer", [&lookup](const AttemptRow& attempt) { return lookup.courseOf(attempt).position; }},
         conditionColumn(),
         {"previous_condition",
          "Condition of the attempt made before it in the same block; NA: there is none, or order_position is not "
          "known",
          "text", [&lookup](const AttemptRow& attempt) { return lookup.courseOf(attempt).previous; }}});
    return columns;
}

std::optional<std::int64_t> durationOf(const AttemptRow& attempt) {
    if (!attempt.end_ns) return std::nullopt;
    return *attempt.end_ns - attempt.start_ns;
}

/// Columns between the factors and the measures. Refers to `lookup`.
ColumnsOf<AttemptRow> resultColumns(const TrialLookup& lookup) {
    return {
        {"start_s",
         "Start of the attempt in session time: see t_s of events.csv",
         "number",
         [](const AttemptRow& attempt) { return secondsCell(attempt.start_ns); },
         {.unit = "s"}},
        {"start_tick",
         "Tick of the attempt's samples at which the trial began: measures take the samples from there on; NA: it "
         "never began, or cycles were missed and samples before it are missing",
         "integer", &AttemptRow::start_tick},
        {"end_tick",
         "Tick at which the trial ended, by success, failure, time-out or abort: measures take the samples up to the "
         "one before it; later ones are of the loop running out. NA: as start_tick, or it has not ended",
         "integer", &AttemptRow::end_tick},
        {"duration_s",
         "From the start of the attempt to its end",
         "number",
         [](const AttemptRow& attempt) { return secondsCell(durationOf(attempt)); },
         {.unit = "s", .formula = "end - start"}},
        {"outcome",
         "How the attempt ended; crashed: the program ended first; running: it has not ended yet",
         "text",
         &AttemptRow::outcome,
         {.levels = {"success", "failure", "timeout", "aborted", "crashed", "running"}}},
        validColumn(),
        {"invalid_reason", "Why the attempt may not be analysed", "text", &AttemptRow::invalid_reason},
        {"counted",
         "1 if cells_long.csv and the wide tables count the attempt",
         "0/1",
         [&lookup](const AttemptRow& attempt) { return !lookup.notCountedBecause(attempt); },
         {.levels = {"0", "1"},
          .formula = "valid = 1, phase = main, outcome success, failure or timeout, and counted = 1 of the session in "
                     "sessions.csv"}},
        {"not_counted_because", "Why they do not count it; NA: they do", "text",
         [&lookup](const AttemptRow& attempt) { return lookup.notCountedBecause(attempt); }}};
}

ColumnOf<AttemptRow> trialMeasureColumn(const store::MeasureRow& measure) {
    const Column described = measureColumn(measure);
    return {described.name,
            described.label,
            described.type,
            [name = measure.measure](const AttemptRow& attempt) {
                const auto found = attempt.measures.find(name);
                return found == attempt.measures.end() ? kMissing : cell(found->second);
            },
            {.unit = described.unit, .formula = described.formula, .formula_version = described.formula_version}};
}

/// Columns after the measures.
ColumnsOf<AttemptRow> closingColumns() {
    return {
        {"feedback_given",
         "What reached the participant of the condition's feedback, joined by +: kinesthetic (force), visual, "
         "vibrotactile, audio, masking_noise; none. Given is what a device rendered, a window drew or a loudspeaker "
         "played at least once in the attempt, and to simulated participants what their senses were handed; where "
         "nothing touched, neither force nor cue was. NA: not known, as of attempts that did not end",
         "text", feedbackOf},
        {"timed_by",
         "Who said when the trial began and ended; simulated participants have their part of the experimenter "
         "simulated "
         "too",
         "text",
         &AttemptRow::timed_by,
         {.levels = {"program", "experimenter", "clock"}}},
        protocolColumn<AttemptRow>(kInFolder),
        {"app_version", "Version of the program", "text", &AttemptRow::app_version}};
}

/// All columns of trials.csv. Refers to `study` and `lookup`.
ColumnsOf<AttemptRow> trialColumns(const StudyData& study, const TrialLookup& lookup) {
    ColumnsOf<AttemptRow> columns = leadingColumns(study, lookup);
    appendFactors(columns, study, &AttemptRow::levels);
    append(columns, resultColumns(lookup));
    for (const store::MeasureRow& measure : study.measures) columns.push_back(trialMeasureColumn(measure));
    append(columns, closingColumns());
    return columns;
}

}  // namespace

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

std::vector<Column> trialColumns(const StudyData& study) {
    return descriptions(trialColumns(study, TrialLookup(study)));
}

Table makeTrials(const StudyData& study) {
    const TrialLookup lookup(study);
    return makeTable("trials.csv", "One row per attempt at a trial, whatever became of it.",
                     trialColumns(study, lookup), study.attempts);
}

}  // namespace passung::exporter
