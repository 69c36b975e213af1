#include "study/store/rows/attempt_rows.h"

#include "study/store/rows/contact_energy_rows.h"
#include "study/store/rows/delivery_rows.h"
#include "study/store/rows/presentation_rows.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {
namespace {

constexpr std::string_view kAttemptColumns =
    "SELECT a.attempt_id, s.session_id, s.participant_id, pa.kind, "
    "coalesce((SELECT d.between_group FROM design_slot d WHERE d.participant_id=s.participant_id), 'all'), s.ordinal, "
    // A mouse stands for the device that the condition names.
    "s.station, CASE json_extract(g.device_json, '$.name') WHEN 'mouse' THEN 'mouse' ELSE "
    "coalesce(json_extract(a.params_json, '$.device'), json_extract(g.device_json, '$.name')) END, "
    "t.block_index, t.block, t.phase, t.trial_index, "
    "t.trial_in_block, t.repetition, a.attempt_no, c.condition, c.levels_json, a.start_ns, a.end_ns, a.outcome, "
    // Whoever is excluded counts nowhere; their rows stay as they are.
    "a.valid AND pa.status<>'excluded', "
    "CASE WHEN a.valid AND pa.status='excluded' THEN 'participant excluded' ELSE a.invalid_reason END, a.params_json, "
    "a.stages_json, a.seed, a.state_hash, s.protocol_sha256, g.app_version, "
    "m.loop, m.ticks, m.mean_us, m.sd_us, m.p99_us, m.p999_us, m.max_us, m.overruns, m.dropped_samples, "
    "json_extract(a.params_json, '$.cues.visual'), json_extract(a.params_json, '$.cues.vibrotactile'), "
    "json_extract(a.params_json, '$.cues.audio'), json_extract(a.params_json, '$.cues.full_depth_m'), "
    "json_extract(a.params_json, '$.cues.full_speed_m_per_s'), json_extract(a.params_json, '$.cues.sound_decay_s'), "
    "coalesce(json_extract(a.params_json, '$.cues.masking_noise'), 0), "
    "coalesce(json_extract(a.params_json, '$.kinesthetic'), 1), "
    "coalesce(json_extract(a.params_json, '$.timed_by'), 'program'), "
    "coalesce(json_extract(a.params_json, '$.secondary.stimulus'), 'none'), "
    "(SELECT min(e.t_ns) FROM event e WHERE e.attempt_id=a.attempt_id AND e.event='trial_started'), "
    "coalesce((SELECT p.condition FROM staircase_step f JOIN condition p ON p.condition_id=f.condition_id "
    "WHERE f.attempt_id=a.attempt_id), c.condition), "
    "coalesce((SELECT max(r.numerics) FROM stream r WHERE r.segment_id=a.segment_id AND r.stream='tick'), 0) "
    "FROM attempt a JOIN trial_plan t USING(trial_id) JOIN session s USING(session_id) "
    "JOIN participant pa USING(participant_id) JOIN segment g ON g.segment_id=a.segment_id "
    "JOIN condition c USING(condition_id) LEFT JOIN timing m USING(attempt_id)";

TimingRow readTiming(const Statement& row, int first) {
    TimingRow timing;
    timing.loop = row.text(first);
    timing.ticks = row.integer(first + 1);
    timing.mean_us = row.optionalReal(first + 2);
    timing.sd_us = row.optionalReal(first + 3);
    timing.p99_us = row.optionalReal(first + 4);
    timing.p999_us = row.optionalReal(first + 5);
    timing.max_us = row.optionalReal(first + 6);
    timing.overruns = row.integer(first + 7);
    timing.dropped_samples = row.integer(first + 8);
    return timing;
}

AttemptRow readAttempt(const Database& database, const Statement& row) {
    AttemptRow attempt;
    attempt.attempt_id = row.integer(0);
    attempt.session_id = row.text(1);
    attempt.participant_id = row.text(2);
    attempt.kind = row.text(3);
    attempt.group = row.text(4);
    attempt.session_ordinal = row.integer(5);
    attempt.station = row.text(6);
    attempt.device = row.text(7);
    attempt.block_index = row.integer(8);
    attempt.block = row.text(9);
    attempt.phase = row.text(10);
    attempt.trial_index = row.integer(11);
    attempt.trial_in_block = row.integer(12);
    attempt.repetition = row.integer(13);
    attempt.attempt_no = row.integer(14);
    attempt.condition = row.text(15);
    attempt.levels = readLevels(database, row.text(16));
    attempt.start_ns = row.integer(17);
    attempt.end_ns = row.optionalInteger(18);
    attempt.outcome = row.text(19);
    attempt.valid = row.integer(20) != 0;
    attempt.invalid_reason = row.optionalText(21);
    attempt.params_json = row.text(22);
    attempt.stages_json = row.text(23);
    attempt.seed = static_cast<std::uint64_t>(row.integer(24));
    attempt.state_hash = row.text(25);
    attempt.protocol_sha256 = row.text(26);
    attempt.app_version = row.text(27);
    if (!row.isNull(28)) attempt.timing = readTiming(row, 28);
    if (!row.isNull(37))
        attempt.cues = {row.integer(37) != 0, row.integer(38) != 0, row.integer(39) != 0, row.real(40),
                        row.real(41),         row.real(42),         row.integer(43) != 0};
    attempt.kinesthetic = row.integer(44) != 0;
    attempt.timed_by = row.text(45);
    attempt.stimulus = row.text(46);
    attempt.trial_ns = row.optionalInteger(47);
    attempt.presented_condition = row.text(48);
    attempt.numerics = row.integer(49);
    Statement values =
        database.prepare("SELECT measure, value_num FROM attempt_measure WHERE attempt_id=? AND value_num IS NOT NULL");
    values.bind(attempt.attempt_id);
    while (values.step()) attempt.measures.emplace(values.text(0), values.real(1));
    attempt.contact_energy = readContactEnergy(database, attempt.attempt_id);
    attempt.delivered = readDelivery(database, attempt.attempt_id);
    attempt.presentation = readPresentation(database, attempt.attempt_id);
    return attempt;
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
    const std::string sql = std::string(kAttemptColumns) +
                            " WHERE ?1 IS NULL OR a.attempt_id=?1"
                            " ORDER BY s.participant_id, s.ordinal, t.trial_index, a.attempt_no";
    Statement statement = database.prepare(sql);
    statement.bind(only);
    std::vector<AttemptRow> rows;
    while (statement.step()) rows.push_back(readAttempt(database, statement));
    return rows;
}

}  // namespace passung::store
