#include "study/store/store_reader.h"

#include "study/store/accuracy_rows.h"
#include "study/store/audit.h"
#include "study/store/consent_rows.h"
#include "study/store/contact_energy_rows.h"
#include "study/store/note_rows.h"
#include "study/store/open_database.h"
#include "study/store/questionnaire_rows.h"
#include "study/store/sample_codec.h"
#include "study/store/secondary_rows.h"
#include "study/store/sqlite.h"
#include "study/store/stable_stiffness_rows.h"
#include "study/store/staircase_rows.h"

namespace passung::store {
namespace {

// Order of protocols wherever it decides about columns or rows.
constexpr std::string_view kByProtocol = " ORDER BY p.name, p.version, p.protocol_sha256";

std::optional<std::string> optionalText(const Statement& row, int column) {
    if (row.isNull(column)) return std::nullopt;
    return row.text(column);
}

/// `{"factor": "label", …}` in the order in which it was written.
Levels readLevels(const Database& database, const std::string& levels_json) {
    Levels levels;
    Statement each = database.prepare("SELECT key, value FROM json_each(?)");
    each.bind(levels_json);
    while (each.step()) levels.emplace_back(each.text(0), each.text(1));
    return levels;
}

std::vector<std::string> readArray(const Database& database, const std::string& json) {
    std::vector<std::string> items;
    Statement each = database.prepare("SELECT value FROM json_each(?)");
    each.bind(json);
    while (each.step()) items.push_back(each.text(0));
    return items;
}

template <class Row, class Read>
std::vector<Row> readAll(Statement statement, Read read) {
    std::vector<Row> rows;
    while (statement.step()) rows.push_back(read(statement));
    return rows;
}

constexpr std::string_view kAttemptColumns =
    "SELECT a.attempt_id, s.session_id, s.participant_id, pa.kind, "
    "coalesce((SELECT d.between_group FROM design_slot d WHERE d.participant_id=s.participant_id), 'all'), s.ordinal, "
    "s.station, coalesce(json_extract(a.params_json, '$.device'), json_extract(g.device_json, '$.name')), "
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
    "WHERE f.attempt_id=a.attempt_id), c.condition) "
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
    attempt.invalid_reason = optionalText(row, 21);
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
    Statement values =
        database.prepare("SELECT measure, value_num FROM attempt_measure WHERE attempt_id=? AND value_num IS NOT NULL");
    values.bind(attempt.attempt_id);
    while (values.step()) attempt.measures.emplace(values.text(0), values.real(1));
    attempt.contact_energy = readContactEnergy(database, attempt.attempt_id);
    return attempt;
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

SessionRow readSession(const Statement& row) {
    SessionRow session;
    session.session_id = row.text(0);
    session.participant_id = row.text(1);
    session.kind = row.text(2);
    session.ordinal = row.integer(3);
    session.station = row.text(4);
    session.device = row.text(5);
    session.device_simulated = row.integer(6) != 0;
    session.experimenter = optionalText(row, 7);
    session.language = row.text(8);
    session.seed = static_cast<std::uint64_t>(row.integer(9));
    session.rng = row.text(10);
    session.epoch = row.text(11);
    session.started_utc = row.text(12);
    session.ended_utc = optionalText(row, 13);
    session.end_state = optionalText(row, 14);
    session.protocol_sha256 = row.text(15);
    session.app_version = row.text(16);
    session.segments = row.integer(17);
    session.planned_trials = row.integer(18);
    session.attempts = row.integer(19);
    session.valid_attempts = row.integer(20);
    return session;
}

/// The chunks of one attempt in one stream, unpacked, ascending. Throws where one is damaged.
template <class Unpack>
std::vector<Chunk> readChunks(const Database& database, std::int64_t attempt_id, const char* stream, Unpack unpack) {
    Statement row = database.prepare(
        "SELECT c.first_tick, c.n, c.crc32, c.data, stream.encoding FROM sample_chunk c JOIN stream USING(stream_id) "
        "WHERE c.attempt_id=? AND stream.stream=? ORDER BY c.first_tick");
    row.bind(attempt_id, stream);
    std::vector<Chunk> chunks;
    while (row.step()) {
        const std::span<const std::byte> data = row.blob(3);
        auto chunk = unpack(
            {row.integer(0), row.integer(1), static_cast<std::uint32_t>(row.integer(2)), {data.begin(), data.end()}},
            row.text(4));
        if (!chunk)
            throw std::runtime_error("attempt " + std::to_string(attempt_id) + ": " + chunk.errors()[0].message);
        chunks.push_back(*std::move(chunk));
    }
    return chunks;
}

}  // namespace

StoreReader::StoreReader(std::string path, std::unique_ptr<Database> database)
    : path_(std::move(path)), database_(std::move(database)) {}
StoreReader::~StoreReader() = default;
StoreReader::StoreReader(StoreReader&&) noexcept = default;

Result<StoreReader> StoreReader::open(const std::string& path) {
    auto database = openForReading(path);
    if (!database) return database.errors();
    const auto begun = guarded(path, [&] {
        (*database)->execute("BEGIN; SELECT count(*) FROM schema_revision");
        return Done{};
    });
    if (!begun) return begun.errors();
    return StoreReader(path, *std::move(database));
}

Result<std::vector<ProtocolRow>> StoreReader::protocols() const {
    return guarded(path_, [&] {
        return readAll<ProtocolRow>(
            database_->prepare("SELECT protocol_sha256, name, version, title, source_text, expanded_json, app_version "
                               "FROM protocol_version p" +
                               std::string(kByProtocol)),
            [](const Statement& row) {
                return ProtocolRow{row.text(0), row.text(1), row.text(2), row.text(3),
                                   row.text(4), row.text(5), row.text(6)};
            });
    });
}

Result<std::vector<MeshRow>> StoreReader::meshes() const {
    return guarded(path_, [&] {
        return readAll<MeshRow>(
            database_->prepare("SELECT m.protocol_sha256, m.mesh, m.sha256, m.bytes FROM mesh_file m "
                               "JOIN protocol_version p USING(protocol_sha256)" +
                               std::string(kByProtocol) + ", m.mesh"),
            [](const Statement& row) {
                return MeshRow{row.text(0), row.text(1), row.text(2), row.integer(3)};
            });
    });
}

Result<std::vector<AccuracyRow>> StoreReader::accuracy() const {
    return guarded(path_, [&] { return readAccuracy(*database_); });
}

Result<std::vector<protocol::StableStiffness>> StoreReader::stableStiffness(const std::string& protocol_sha256) const {
    return guarded(path_, [&] { return readStableStiffness(*database_, protocol_sha256); });
}

Result<std::map<std::string, std::string>> StoreReader::questionnaireTexts(const std::string& protocol_sha256) const {
    return guarded(path_, [&] {
        std::map<std::string, std::string> texts;
        Statement rows = database_->prepare(
            "SELECT json_extract(value, '$.file'), json_extract(value, '$.source.definition'), "
            "json_extract(value, '$.texts'), json_extract(value, '$.source.texts') "
            "FROM protocol_version, json_each(expanded_json, '$.questionnaires') WHERE protocol_sha256=?");
        rows.bind(protocol_sha256);
        while (rows.step()) {
            texts[rows.text(0)] = rows.text(1);
            if (!rows.text(2).empty()) texts[rows.text(2)] = rows.text(3);
        }
        return texts;
    });
}

Result<std::vector<FactorRow>> StoreReader::factors() const {
    return guarded(path_, [&] {
        return readAll<FactorRow>(
            database_->prepare("SELECT f.protocol_sha256, f.factor, f.kind, f.unit, f.levels_json "
                               "FROM factor f JOIN protocol_version p USING(protocol_sha256)" +
                               std::string(kByProtocol) + ", f.position"),
            [&](const Statement& row) {
                return FactorRow{row.text(0), row.text(1), row.text(2), row.text(3),
                                 readArray(*database_, row.text(4))};
            });
    });
}

Result<std::vector<ConditionRow>> StoreReader::conditions() const {
    return guarded(path_, [&] {
        return readAll<ConditionRow>(
            database_->prepare("SELECT c.protocol_sha256, c.condition, c.levels_json "
                               "FROM condition c JOIN protocol_version p USING(protocol_sha256) WHERE c.position < "
                               "coalesce(json_extract(p.expanded_json, '$.planned_conditions'), c.position + 1)" +
                               std::string(kByProtocol) + ", c.position"),
            [&](const Statement& row) {
                return ConditionRow{row.text(0), row.text(1), readLevels(*database_, row.text(2))};
            });
    });
}
Result<std::vector<StaircaseTrackRow>> StoreReader::staircaseTracks() const {
    return guarded(path_, [&] { return readStaircaseTracks(*database_); });
}


Result<std::vector<MeasureRow>> StoreReader::measures() const {
    return guarded(path_, [&] {
        return readAll<MeasureRow>(
            database_->prepare("SELECT measure, label, unit, formula, formula_version, "
                               "EXISTS(SELECT 1 FROM protocol_measure d WHERE d.measure=measure.measure) "
                               "FROM measure ORDER BY position, measure"),
            [](const Statement& row) {
                return MeasureRow{row.text(0), row.text(1),    row.text(2),
                                  row.text(3), row.integer(4), row.integer(5) != 0};
            });
    });
}

Result<std::vector<ParticipantRow>> StoreReader::participants() const {
    return guarded(path_, [&] {
        return readAll<ParticipantRow>(
            database_->prepare(
                "SELECT p.participant_id, p.kind, p.status, p.status_reason, p.created_utc, d.between_group, "
                "d.sequence_index, d.replicate, d.protocol_sha256, "
                "(SELECT count(*) FROM session s WHERE s.participant_id=p.participant_id) "
                "FROM participant p LEFT JOIN design_slot d USING(participant_id) ORDER BY p.participant_id"),
            [](const Statement& row) {
                return ParticipantRow{row.text(0),
                                      row.text(1),
                                      row.text(2),
                                      optionalText(row, 3),
                                      row.text(4),
                                      optionalText(row, 5),
                                      row.optionalInteger(6),
                                      row.optionalInteger(7),
                                      optionalText(row, 8),
                                      row.integer(9)};
            });
    });
}

Result<std::vector<ConsentClauseRow>> StoreReader::consentClauses() const {
    return guarded(path_, [&] { return readConsentClauses(*database_); });
}

Result<std::vector<ConsentRow>> StoreReader::consents() const {
    return guarded(path_, [&] { return readConsents(*database_); });
}

Result<AuditReport> StoreReader::audit() const {
    return guarded(path_, [&] { return checkAudit(*database_); });
}

Result<std::vector<SessionRow>> StoreReader::sessions() const {
    return guarded(path_, [&] {
        return readAll<SessionRow>(
            database_->prepare(
                "SELECT s.session_id, s.participant_id, p.kind, s.ordinal, s.station, "
                "json_extract(g.device_json, '$.name'), json_extract(g.device_json, '$.simulated'), s.experimenter, "
                "s.language, s.seed, s.rng, s.epoch, s.started_utc, s.ended_utc, s.end_state, s.protocol_sha256, "
                "g.app_version, (SELECT count(*) FROM segment n WHERE n.session_id=s.session_id), "
                "(SELECT count(*) FROM trial_plan t WHERE t.session_id=s.session_id), "
                "(SELECT count(*) FROM attempt a JOIN trial_plan t USING(trial_id) WHERE t.session_id=s.session_id), "
                "(SELECT count(*) FROM attempt a JOIN trial_plan t USING(trial_id) WHERE t.session_id=s.session_id "
                "AND a.valid AND p.status<>'excluded') FROM session s JOIN participant p USING(participant_id) JOIN "
                "segment g ON g.segment_id="
                "(SELECT min(n.segment_id) FROM segment n WHERE n.session_id=s.session_id) "
                "ORDER BY s.participant_id, s.ordinal"),
            readSession);
    });
}

Result<std::vector<AttemptRow>> StoreReader::attempts() const {
    return guarded(path_, [&] { return readAttempts(*database_, std::nullopt); });
}

Result<AttemptRow> StoreReader::attempt(std::int64_t attempt_id) const {
    return guarded(path_, [&] {
        std::vector<AttemptRow> rows = readAttempts(*database_, attempt_id);
        if (rows.empty()) throw std::runtime_error("there is no attempt " + std::to_string(attempt_id));
        return std::move(rows.front());
    });
}

Result<std::vector<NoteRow>> StoreReader::notes() const {
    return guarded(path_, [&] { return readNotes(*database_); });
}

Result<std::vector<EventRow>> StoreReader::events() const {
    return guarded(path_, [&] {
        return readAll<EventRow>(
            database_->prepare(
                "SELECT s.participant_id, p.kind, s.ordinal, e.t_ns, t.trial_index, a.attempt_no, e.source, "
                "e.event, e.payload_json FROM event e JOIN segment g USING(segment_id) "
                "JOIN session s USING(session_id) JOIN participant p USING(participant_id) "
                "LEFT JOIN attempt a ON a.attempt_id=e.attempt_id "
                "LEFT JOIN trial_plan t USING(trial_id) "
                "ORDER BY s.participant_id, s.ordinal, g.segment_id, e.t_ns, e.event_id"),
            [](const Statement& row) {
                return EventRow{row.text(0),
                                row.text(1),
                                row.integer(2),
                                row.integer(3),
                                row.optionalInteger(4),
                                row.optionalInteger(5),
                                row.text(6),
                                row.text(7),
                                row.text(8)};
            });
    });
}

Result<std::vector<DetectionRow>> StoreReader::detections() const {
    return guarded(path_, [&] { return readDetections(*database_); });
}

Result<std::vector<StaircaseStepRow>> StoreReader::staircaseSteps() const {
    return guarded(path_, [&] { return readStaircaseSteps(*database_); });
}

Result<std::vector<QuestionnaireRunRow>> StoreReader::questionnaireRuns() const {
    return guarded(path_, [&] { return readQuestionnaireRuns(*database_); });
}

Result<std::vector<TickRecord>> StoreReader::records(std::int64_t attempt_id) const {
    return guarded(path_, [&] {
        std::vector<TickRecord> records;
        const auto require = [&](const Result<Done>& done) {
            if (!done)
                throw std::runtime_error("attempt " + std::to_string(attempt_id) + ": " + done.errors()[0].message);
        };
        for (const Chunk& chunk : readChunks(*database_, attempt_id, "tick", unpackTicks))
            require(decodeTicks(chunk, records));
        for (const Chunk& chunk : readChunks(*database_, attempt_id, "tick_timing", unpackTiming))
            require(decodeTiming(chunk, records));
        return records;
    });
}

}  // namespace passung::store
