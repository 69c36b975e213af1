#include "study/store/rows/attempt_rows.h"

#include "study/store/rows/assembly_step_rows.h"
#include "study/store/rows/contact_energy_rows.h"
#include "study/store/rows/delivery_rows.h"
#include "study/store/rows/presentation_rows.h"
#include "study/store/schema/named_columns.h"
#include "study/store/schema/view_columns.h"

namespace passung::store {
namespace {

constexpr const char* kFromAttempts =
    " FROM attempt a JOIN trial_plan t USING(trial_id) JOIN session s USING(session_id) "
    "JOIN participant pa USING(participant_id) JOIN segment g ON g.segment_id=a.segment_id "
    "JOIN condition c USING(condition_id) LEFT JOIN timing m USING(attempt_id)";

/// Of the view's column of this name.
const std::string& sqlOf(const char* column) { return viewColumn(StudyView::Trials, column).sql; }

/// Makes the columns of an attempt; those of its condition's levels are read from `database`.
Selection<AttemptRow> attemptColumns(const Database& database) {
    using Row = AttemptRow;
    return {{"a.attempt_id", &Row::attempt_id},
            {"s.session_id", &Row::session_id},
            {"s.participant_id", &Row::participant_id},
            {"pa.kind", &Row::kind},
            {"coalesce((SELECT d.between_group FROM design_slot d WHERE d.participant_id=s.participant_id), 'all')",
             &Row::group},
            {"s.ordinal", &Row::session_ordinal},
            {"s.station", &Row::station},
            {sqlOf("device"), &Row::device},
            {"t.block_index", &Row::block_index},
            {"t.block", &Row::block},
            {"t.phase", &Row::phase},
            {"t.trial_index", &Row::trial_index},
            {"t.trial_in_block", &Row::trial_in_block},
            {"t.repetition", &Row::repetition},
            {"a.attempt_no", &Row::attempt_no},
            {"c.condition", &Row::condition},
            {"c.levels_json", [&database](const Statement& row, int column,
                                          Row& to) { to.levels = readLevels(database, row.text(column)); }},
            {"a.start_ns", &Row::start_ns},
            {"a.end_ns", &Row::end_ns},
            {"a.outcome", &Row::outcome},
            {sqlOf("valid"), &Row::valid},
            {sqlOf("invalid_reason"), &Row::invalid_reason},
            {sqlOf("not_counted_because"), &Row::not_counted_because},
            {sqlOf("feedback_given"), &Row::feedback_given},
            {"CASE WHEN ?1 IS NULL THEN '' ELSE a.params_json END", &Row::params_json},
            {"CASE WHEN ?1 IS NULL THEN '' ELSE a.stages_json END", &Row::stages_json},
            {"a.seed", &Row::seed},
            {"a.state_hash", &Row::state_hash},
            {"s.protocol_sha256", &Row::protocol_sha256},
            {"g.app_version", &Row::app_version},
            {"coalesce(json_extract(a.params_json, '$.kinesthetic'), 1)", &Row::kinesthetic},
            {sqlOf("timed_by"), &Row::timed_by},
            {"coalesce(json_extract(a.params_json, '$.secondary.stimulus'), 'none')", &Row::stimulus},
            {"(SELECT min(e.t_ns) FROM event e WHERE e.attempt_id=a.attempt_id AND e.event='trial_started')",
             &Row::trial_ns},
            {"coalesce((SELECT p.condition FROM staircase_step f JOIN condition p ON p.condition_id=f.condition_id "
             "WHERE f.attempt_id=a.attempt_id), c.condition)",
             &Row::presented_condition},
            {"coalesce((SELECT max(r.numerics) FROM stream r WHERE r.segment_id=a.segment_id AND r.stream='tick'), 0)",
             &Row::numerics}};
}

const Selection<TimingRow>& timingColumns() {
    static const Selection<TimingRow> columns = {{"m.loop", &TimingRow::loop},
                                                 {"m.ticks", &TimingRow::ticks},
                                                 {"m.mean_us", &TimingRow::mean_us},
                                                 {"m.sd_us", &TimingRow::sd_us},
                                                 {"m.p99_us", &TimingRow::p99_us},
                                                 {"m.p999_us", &TimingRow::p999_us},
                                                 {"m.max_us", &TimingRow::max_us},
                                                 {"m.overruns", &TimingRow::overruns},
                                                 {"m.dropped_samples", &TimingRow::dropped_samples},
                                                 {"m.processor_mean_us", &TimingRow::processor_mean_us},
                                                 {"m.processor_p99_us", &TimingRow::processor_p99_us},
                                                 {"m.processor_p999_us", &TimingRow::processor_p999_us},
                                                 {"m.processor_max_us", &TimingRow::processor_max_us}};
    return columns;
}

const Selection<measures::CueSettings>& cueColumns() {
    using measures::CueSettings;
    static const Selection<CueSettings> columns = {
        {"json_extract(a.params_json, '$.cues.visual')", &CueSettings::visual},
        {"json_extract(a.params_json, '$.cues.vibrotactile')", &CueSettings::vibration},
        {"json_extract(a.params_json, '$.cues.audio')", &CueSettings::sound},
        {"json_extract(a.params_json, '$.cues.full_depth_m')", &CueSettings::full_depth},
        {"json_extract(a.params_json, '$.cues.full_speed_m_per_s')", &CueSettings::full_speed},
        {"json_extract(a.params_json, '$.cues.sound_decay_s')", &CueSettings::sound_decay},
        {"coalesce(json_extract(a.params_json, '$.cues.masking_noise'), 0)", &CueSettings::masking}};
    return columns;
}

/// Adds what other tables hold of the attempt.
void readParts(const Database& database, AttemptRow& attempt) {
    Statement values = database.prepare("SELECT measure, value_num FROM attempt_measure WHERE attempt_id=?");
    values.bind(attempt.attempt_id);
    while (values.step()) {
        if (const auto value = values.optionalReal(1))
            attempt.measures.emplace(values.text(0), *value);
        else
            attempt.undefined_measures.push_back(values.text(0));
    }
    attempt.steps = readAssemblySteps(database, attempt.attempt_id);
    attempt.contact_energy = readContactEnergy(database, attempt.attempt_id);
    attempt.delivered = readDelivery(database, attempt.attempt_id);
    attempt.presentation = readPresentation(database, attempt.attempt_id);
}

}  // namespace

Levels readLevels(const Database& database, const std::string& levels_json) {
    Levels levels;
    Statement each = database.prepare("SELECT key, value FROM json_each(?)");
    each.bind(levels_json);
    while (each.step()) levels.emplace_back(each.text(0), each.text(1));
    return levels;
}

std::vector<AttemptRow> readAttempts(const Database& database, std::optional<std::int64_t> only) {
    const Selection<AttemptRow> columns = attemptColumns(database);
    const int timing = columns.size(), cues = timing + timingColumns().size();
    const std::string sql = "SELECT " + columns.text() + ", " + timingColumns().text() + ", " + cueColumns().text() +
                            kFromAttempts +
                            " WHERE ?1 IS NULL OR a.attempt_id=?1"
                            " ORDER BY s.participant_id, s.ordinal, t.trial_index, a.attempt_no";
    Statement statement = database.prepare(sql);
    statement.bind(only);
    std::vector<AttemptRow> rows;
    while (statement.step()) {
        AttemptRow attempt = columns.read(statement);
        if (!statement.isNull(timing)) attempt.timing = timingColumns().read(statement, timing);
        if (!statement.isNull(cues)) attempt.cues = cueColumns().read(statement, cues);
        readParts(database, attempt);
        rows.push_back(std::move(attempt));
    }
    return rows;
}

}  // namespace passung::store
