#include "study/store/read/store_reader.h"

#include "study/store/read/intact_view.h"
#include "study/store/rows/accuracy_rows.h"
#include "study/store/rows/attempt_rows.h"
#include "study/store/rows/audit.h"
#include "study/store/rows/consent_rows.h"
#include "study/store/rows/event_rows.h"
#include "study/store/rows/note_rows.h"
#include "study/store/rows/plan_rows.h"
#include "study/store/rows/questionnaire_rows.h"
#include "study/store/rows/secondary_rows.h"
#include "study/store/rows/stable_stiffness_rows.h"
#include "study/store/rows/staircase_rows.h"
#include "study/store/samples/sample_codec.h"
#include "study/store/schema/open_database.h"
#include "study/store/schema/sqlite.h"
#include "study/store/schema/untouched.h"

namespace passung::store {
namespace {

// Order of protocols wherever it decides about columns or rows.
constexpr std::string_view kByProtocol = " ORDER BY p.name, p.version, p.protocol_sha256";

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

SessionRow readSession(const Statement& row) {
    SessionRow session;
    session.session_id = row.text(0);
    session.participant_id = row.text(1);
    session.kind = row.text(2);
    session.ordinal = row.integer(3);
    session.station = row.text(4);
    session.device_simulated = row.integer(6) != 0;
    session.experimenter = row.optionalText(7);
    session.language = row.text(8);
    session.seed = static_cast<std::uint64_t>(row.integer(9));
    session.rng = row.text(10);
    session.epoch = row.text(11);
    session.started_utc = row.text(12);
    session.ended_utc = row.optionalText(13);
    session.end_state = row.optionalText(14);
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

/// The schema's text, an index that does not fit its table, and rows that belong to none.
std::vector<DamageRow> structureFaults(const Database& database, const std::vector<std::string>& schema_faults,
                                       const std::vector<std::string>& index_faults) {
    std::vector<DamageRow> faults;
    const auto add = [&](const std::string& part, const std::string& what) {
        faults.emplace_back();
        faults.back().part = part;
        faults.back().what = what;
    };
    for (const std::string& fault : schema_faults) add("the file", fault + " is not as it was written");
    for (const std::string& fault : index_faults) add("the file", fault);
    for (const auto& [table, parent] : brokenReferences(database)) add(table, "a row belongs to no row of " + parent);
    return faults;
}

ReadCheck checkFor(Damaged damaged) {
    if (damaged == Damaged::Refused) return ReadCheck::Pages;
    return damaged == Damaged::KnownWhole ? ReadCheck::None : ReadCheck::Structure;
}

/// The same data with its indices made anew, as far as SQLite can: what is found through them is then what is there.
std::unique_ptr<Database> withoutDamagedIndices(const Database& database, const std::string& path) {
    auto copy = privateCopy(database, path);
    rebuildIndices(*copy);
    copy->execute("PRAGMA query_only=ON");
    return copy;
}

}  // namespace

StoreReader::StoreReader(std::string path, std::unique_ptr<Database> database)
    : path_(std::move(path)), database_(std::move(database)) {}
StoreReader::~StoreReader() = default;
StoreReader::StoreReader(StoreReader&&) noexcept = default;

Result<StoreReader> StoreReader::open(const std::string& path, Damaged damaged) {
    const bool leaves_out = damaged == Damaged::LeftOut || damaged == Damaged::LeftOutWithSamples;
    std::vector<std::string> schema_faults, index_faults;
    auto database = openForReading(path, OlderFile::UpgradeCopy, checkFor(damaged), &schema_faults,
                                   leaves_out ? &index_faults : nullptr);
    if (!database) return database.errors();
    std::vector<DamageRow> damages;
    const auto begun = guarded(path, [&] {
        if (leaves_out) damages = structureFaults(**database, schema_faults, index_faults);
        if (!damages.empty()) *database = withoutDamagedIndices(**database, path);
        (*database)->execute("BEGIN; SELECT count(*) FROM schema_revision");
        if (!leaves_out) return Done{};
        const auto rows =
            leaveOutDamaged(**database, damaged == Damaged::LeftOut ? Samples::LeftOut : Samples::LookedAt);
        damages.insert(damages.end(), rows.begin(), rows.end());
        return Done{};
    });
    if (!begun) return begun.errors();
    StoreReader reader(path, *std::move(database));
    reader.damages_ = std::move(damages);
    return reader;
}

Result<std::vector<ProtocolRow>> StoreReader::protocols() const {
    return guarded(path_, [&] {
        return readAll<ProtocolRow>(
            database_->prepare("SELECT protocol_sha256, name, version, title, source_text, expanded_json, app_version "
                               "FROM protocol_version p" +
                               std::string(kByProtocol)),
            [&](const Statement& row) {
                return ProtocolRow{row.text(0), row.text(1), row.text(2), row.text(3),
                                   row.text(4), row.text(5), row.text(6), readMainBlocks(*database_, row.text(5))};
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
    return guarded(path_, [&] { return readConditions(*database_); });
}

Result<std::vector<PlannedCellRow>> StoreReader::plannedCells() const {
    return guarded(path_, [&] { return readPlannedCells(*database_); });
}

Result<std::vector<AnalysisRow>> StoreReader::analyses() const {
    return guarded(path_, [&] { return readAnalyses(*database_); });
}

Result<std::vector<NamedFileRow>> StoreReader::namedFiles() const {
    return guarded(path_, [&] { return readNamedFiles(*database_); });
}

Result<std::vector<QuestionnaireRow>> StoreReader::questionnaires() const {
    return guarded(path_, [&] { return readQuestionnaires(*database_); });
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
                "(SELECT count(*) FROM session s WHERE s.participant_id=p.participant_id), "
                "(SELECT a.action FROM audit a WHERE json_extract(a.detail_json, '$.participant')=p.participant_id "
                "AND a.action IN('withdraw', 'exclude', 'readmit') ORDER BY a.audit_id DESC LIMIT 1) "
                "FROM participant p LEFT JOIN design_slot d USING(participant_id) ORDER BY p.participant_id"),
            [](const Statement& row) {
                return ParticipantRow{row.text(0),
                                      row.text(1),
                                      row.text(2),
                                      row.optionalText(3),
                                      row.text(4),
                                      row.optionalText(5),
                                      row.optionalInteger(6),
                                      row.optionalInteger(7),
                                      row.optionalText(8),
                                      row.integer(9),
                                      row.optionalText(10)};
            });
    });
}

Result<std::vector<ConsentClauseRow>> StoreReader::consentClauses() const {
    return guarded(path_, [&] { return readConsentClauses(*database_); });
}

Result<std::vector<ConsentRow>> StoreReader::consents() const {
    return guarded(path_, [&] { return readConsents(*database_); });
}

Result<std::int64_t> StoreReader::erasedCodesTo(protocol::ParticipantKind kind) const {
    return guarded(path_, [&] { return store::erasedCodesTo(*database_, kind); });
}

Result<AuditReport> StoreReader::audit() const {
    return guarded(path_, [&] { return checkAudit(*database_); });
}

Result<std::vector<SessionRow>> StoreReader::sessions() const {
    return guarded(path_, [&] {
        return readAll<SessionRow>(
            database_->prepare(
                "SELECT s.session_id, s.participant_id, p.kind, s.ordinal, s.station, "
                "(SELECT json_group_array(json_extract(n.device_json, '$.name')) FROM (SELECT device_json FROM segment "
                "WHERE session_id=s.session_id ORDER BY segment_id) n), "
                "(SELECT min(json_extract(n.device_json, '$.simulated')) FROM segment n WHERE "
                "n.session_id=s.session_id), s.experimenter, "
                "s.language, s.seed, s.rng, s.epoch, s.started_utc, s.ended_utc, s.end_state, s.protocol_sha256, "
                "g.app_version, (SELECT count(*) FROM segment n WHERE n.session_id=s.session_id), "
                "(SELECT count(*) FROM trial_plan t WHERE t.session_id=s.session_id), "
                "(SELECT count(*) FROM attempt a JOIN trial_plan t USING(trial_id) WHERE t.session_id=s.session_id), "
                "(SELECT count(*) FROM attempt a JOIN trial_plan t USING(trial_id) WHERE t.session_id=s.session_id "
                "AND a.valid AND p.status<>'excluded') FROM session s JOIN participant p USING(participant_id) JOIN "
                "segment g ON g.segment_id="
                "(SELECT min(n.segment_id) FROM segment n WHERE n.session_id=s.session_id) "
                "ORDER BY s.participant_id, s.ordinal"),
            [&](const Statement& row) {
                SessionRow session = readSession(row);
                session.segment_devices = readArray(*database_, row.text(5));
                return session;
            });
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
    return guarded(path_, [&] { return readEvents(*database_); });
}

Result<std::vector<DetectionRow>> StoreReader::detections() const {
    return guarded(path_, [&] { return readDetections(*database_); });
}

Result<std::vector<StaircaseTrackRow>> StoreReader::staircaseTracks() const {
    return guarded(path_, [&] { return readStaircaseTracks(*database_); });
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
