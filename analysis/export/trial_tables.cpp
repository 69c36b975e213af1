#include "analysis/export/trial_tables.h"

#include <algorithm>
#include <map>
#include <memory>
#include <tuple>

#include "analysis/export/shared_columns.h"

namespace passung::exporter {
namespace {

using store::AttemptRow;

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

/// What all rows of trials.csv look up.
class TrialLookup {
public:
    explicit TrialLookup(const StudyData& study) : courses_(coursesOf(study)) {}

    const Course& courseOf(const AttemptRow& attempt) const { return courses_.at(attempt.attempt_id); }

private:
    std::map<std::int64_t, Course> courses_;
};

/// Columns before the factors. Refers to `study` and `lookup`.
ColumnsOf<AttemptRow> leadingColumns(const StudyData& study, const TrialLookup& lookup) {
    ColumnsOf<AttemptRow> columns = whoColumns<AttemptRow>();
    append(columns, {sessionColumn<AttemptRow>(),
                     {ofTrials("station"), "text", &AttemptRow::station},
                     {ofTrials("device"), "text", &AttemptRow::device},
                     blockIndexColumn<AttemptRow>(),
                     blockColumn<AttemptRow>(),
                     {ofTrials("phase"), "text", &AttemptRow::phase, {"practice", "main", "catch", "adaptive"}},
                     trialIndexColumn(),
                     {ofTrials("trial_in_block"), "integer", &AttemptRow::trial_in_block},
                     {ofTrials("repetition"), "integer", &AttemptRow::repetition},
                     attemptNumberColumn(),
                     sequenceColumn<AttemptRow>(study),
                     {ofTrials("order_position"), "integer",
                      [&lookup](const AttemptRow& attempt) { return lookup.courseOf(attempt).position; }},
                     conditionColumn(),
                     {ofTrials("previous_condition"), "text",
                      [&lookup](const AttemptRow& attempt) { return lookup.courseOf(attempt).previous; }}});
    return columns;
}

std::optional<std::int64_t> durationOf(const AttemptRow& attempt) {
    if (!attempt.end_ns) return std::nullopt;
    return *attempt.end_ns - attempt.start_ns;
}

/// Columns between the factors and the measures.
ColumnsOf<AttemptRow> resultColumns() {
    return {
        {ofTrials("start_s"), "number", [](const AttemptRow& attempt) { return secondsCell(attempt.start_ns); }},
        {ofTrials("start_tick"), "integer", &AttemptRow::start_tick},
        {ofTrials("end_tick"), "integer", &AttemptRow::end_tick},
        {ofTrials("duration_s"), "number", [](const AttemptRow& attempt) { return secondsCell(durationOf(attempt)); }},
        {ofTrials("outcome"),
         "text",
         &AttemptRow::outcome,
         {"success", "failure", "timeout", "aborted", "crashed", "running"}},
        validColumn(),
        {ofTrials("invalid_reason"), "text", &AttemptRow::invalid_reason},
        {ofTrials("counted"),
         "0/1",
         [](const AttemptRow& attempt) { return !attempt.not_counted_because; },
         {"0", "1"}},
        {ofTrials("not_counted_because"), "text", &AttemptRow::not_counted_because}};
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
    return {{ofTrials("feedback_given"), "text", &AttemptRow::feedback_given},
            {ofTrials("timed_by"), "text", &AttemptRow::timed_by, {"program", "experimenter", "clock"}},
            protocolColumn<AttemptRow>(kInFolder),
            {ofTrials("app_version"), "text", &AttemptRow::app_version}};
}

/// All columns of trials.csv. Refers to `study` and `lookup`.
ColumnsOf<AttemptRow> trialColumns(const StudyData& study, const TrialLookup& lookup) {
    ColumnsOf<AttemptRow> columns = leadingColumns(study, lookup);
    appendFactors(columns, study, &AttemptRow::levels);
    append(columns, resultColumns());
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
    const auto lookup = std::make_shared<const TrialLookup>(study);
    return makeAttemptTable<AttemptRow>(study, "trials.csv", "One row per attempt at a trial, whatever became of it.",
                                        trialColumns(study, *lookup),
                                        [lookup](const AttemptRow& attempt, const auto& take) { take(attempt); });
}

}  // namespace passung::exporter
