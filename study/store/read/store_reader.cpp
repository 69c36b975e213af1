#include "study/store/read/store_reader.h"

#include "study/store/read/intact_view.h"
#include "study/store/rows/accuracy_rows.h"
#include "study/store/rows/attempt_rows.h"
#include "study/store/rows/audit.h"
#include "study/store/rows/consent_rows.h"
#include "study/store/rows/contact_geometry_rows.h"
#include "study/store/rows/event_rows.h"
#include "study/store/rows/exact_overlap_rows.h"
#include "study/store/rows/note_rows.h"
#include "study/store/rows/plan_rows.h"
#include "study/store/rows/questionnaire_rows.h"
#include "study/store/rows/secondary_rows.h"
#include "study/store/rows/stable_stiffness_rows.h"
#include "study/store/rows/staircase_rows.h"
#include "study/store/samples/sample_codec.h"
#include "study/store/schema/named_columns.h"
#include "study/store/schema/open_database.h"
#include "study/store/schema/untouched.h"
#include "study/store/schema/view_columns.h"

namespace passung::store {
namespace {

// Order of protocols wherever it decides about columns or rows.
const std::string kByProtocol = " ORDER BY p.name, p.version, p.protocol_sha256";

std::vector<std::string> readArray(const Database& database, const std::string& json) {
    std::vector<std::string> items;
    Statement each = database.prepare("SELECT value FROM json_each(?)");
    each.bind(json);
    while (each.step()) items.push_back(each.text(0));
    return items;
}

/// What the runs of a session say of their real devices, each once, in order: a list in JSON.
std::string ofUnits(const char* key) {
    return std::string("(SELECT json_group_array(v) FROM (SELECT json_extract(u.value, '$.") + key +
           "') AS v, min(n.segment_id * 100 + u.key) AS at FROM segment n, json_each(n.device_json, '$.units') u "
           "WHERE n.session_id=s.session_id GROUP BY v ORDER BY at))";
}

/// Makes the columns of a session; those of its devices are read by `database`.
Selection<SessionRow> sessionColumns(const Database& database) {
    using Row = SessionRow;
    return {{"s.session_id", &Row::session_id},
            {"s.participant_id", &Row::participant_id},
            {"pa.kind", &Row::kind},
            {"s.ordinal", &Row::ordinal},
            {"s.station", &Row::station},
            {"(SELECT json_group_array(json_extract(n.device_json, '$.name')) FROM (SELECT device_json FROM segment "
             "WHERE session_id=s.session_id ORDER BY segment_id) n)",
             [&database](const Statement& row, int column, Row& to) {
                 to.segment_devices = readArray(database, row.text(column));
             }},
            {"(SELECT min(json_extract(n.device_json, '$.simulated')) FROM segment n WHERE n.session_id=s.session_id)",
             &Row::device_simulated},
            {ofUnits("backend"), [&database](const Statement& row, int column,
                                             Row& to) { to.device_backends = readArray(database, row.text(column)); }},
            {ofUnits("serial"), [&database](const Statement& row, int column,
                                            Row& to) { to.device_serials = readArray(database, row.text(column)); }},
            {"s.experimenter", &Row::experimenter},
            {"s.language", &Row::language},
            {"s.seed", &Row::seed},
            {"s.rng", &Row::rng},
            {"s.epoch", &Row::epoch},
            {"s.started_utc", &Row::started_utc},
            {"s.ended_utc", &Row::ended_utc},
            {"s.end_state", &Row::end_state},
            {"s.protocol_sha256", &Row::protocol_sha256},
            {"g.app_version", &Row::app_version},
            {"(SELECT count(*) FROM segment n WHERE n.session_id=s.session_id)", &Row::segments},
            {"(SELECT count(*) FROM trial_plan t WHERE t.session_id=s.session_id)", &Row::planned_trials},
            {"(SELECT count(*) FROM attempt a JOIN trial_plan t USING(trial_id) WHERE t.session_id=s.session_id)",
             &Row::attempts},
            {"(SELECT count(*) FROM attempt a JOIN trial_plan t USING(trial_id) WHERE t.session_id=s.session_id "
             "AND a.valid AND pa.status<>'excluded')",
             &Row::valid_attempts},
            {countedSession(), &Row::counted}};
}

Selection<ParticipantRow> participantColumns() {
    using Row = ParticipantRow;
    return {{"p.participant_id", &Row::participant_id},
            {"p.kind", &Row::kind},
            {"p.status", &Row::status},
            {"p.status_reason", &Row::status_reason},
            {"p.created_utc", &Row::created_utc},
            {"d.between_group", &Row::group},
            {"d.sequence_index", &Row::sequence_index},
            {"d.replicate", &Row::replicate},
            {"d.protocol_sha256", &Row::place_sha256},
            {"(SELECT count(*) FROM session s WHERE s.participant_id=p.participant_id)", &Row::sessions},
            {"(SELECT a.action FROM audit a WHERE json_extract(a.detail_json, '$.participant')=p.participant_id "
             "AND a.action IN('withdraw', 'exclude', 'readmit') ORDER BY a.audit_id DESC LIMIT 1)",
             &Row::standing_by}};
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
            leaveOutDamaged(**database, damaged == Damaged::LeftOut ? SampleCheck::LeftOut : SampleCheck::LookedAt);
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
        const Selection<ProtocolRow> columns = {
            {"protocol_sha256", &ProtocolRow::sha256},  {"name", &ProtocolRow::name},
            {"version", &ProtocolRow::version},         {"title", &ProtocolRow::title},
            {"source_text", &ProtocolRow::source_text}, {"expanded_json", &ProtocolRow::expanded_json},
            {"app_version", &ProtocolRow::app_version}};
        auto rows = columns.all(*database_, "FROM protocol_version p" + kByProtocol);
        for (ProtocolRow& row : rows) row.main_blocks = readMainBlocks(*database_, row.expanded_json);
        return rows;
    });
}

Result<std::vector<MeshRow>> StoreReader::meshes() const {
    return guarded(path_, [&] {
        const Selection<MeshRow> columns = {{"m.protocol_sha256", &MeshRow::protocol_sha256},
                                            {"m.mesh", &MeshRow::mesh},
                                            {"m.sha256", &MeshRow::sha256},
                                            {"m.bytes", &MeshRow::bytes}};
        return columns.all(
            *database_, "FROM mesh_file m JOIN protocol_version p USING(protocol_sha256)" + kByProtocol + ", m.mesh");
    });
}

Result<std::vector<AccuracyRow>> StoreReader::accuracy() const {
    return guarded(path_, [&] { return readAccuracy(*database_); });
}

Result<std::vector<plan::StableStiffness>> StoreReader::stableStiffness(const std::string& protocol_sha256) const {
    return guarded(path_, [&] { return readStableStiffness(*database_, protocol_sha256); });
}

Result<std::vector<ContactGeometryRow>> StoreReader::contactGeometry(const std::string& protocol_sha256) const {
    return guarded(path_, [&] { return readContactGeometry(*database_, protocol_sha256); });
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
        const Selection<FactorRow> columns = {{"f.protocol_sha256", &FactorRow::protocol_sha256},
                                              {"f.factor", &FactorRow::factor},
                                              {"f.kind", &FactorRow::kind},
                                              {"f.unit", &FactorRow::unit},
                                              {"f.levels_json", [&](const Statement& row, int column, FactorRow& to) {
                                                   to.levels = readArray(*database_, row.text(column));
                                               }}};
        return columns.all(
            *database_, "FROM factor f JOIN protocol_version p USING(protocol_sha256)" + kByProtocol + ", f.position");
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

Result<std::vector<DataRuleRow>> StoreReader::dataRules() const {
    return guarded(path_, [&] { return readDataRules(*database_); });
}

Result<std::vector<NamedFileRow>> StoreReader::namedFiles() const {
    return guarded(path_, [&] { return readNamedFiles(*database_); });
}

Result<std::vector<QuestionnaireRow>> StoreReader::questionnaires() const {
    return guarded(path_, [&] { return readQuestionnaires(*database_); });
}

Result<std::vector<MeasureRow>> StoreReader::measures() const {
    return guarded(path_, [&] {
        const Selection<MeasureRow> columns = {
            {"measure", &MeasureRow::measure},
            {"label", &MeasureRow::label},
            {"unit", &MeasureRow::unit},
            {"formula", &MeasureRow::formula},
            {"formula_version", &MeasureRow::formula_version},
            {"EXISTS(SELECT 1 FROM protocol_measure d WHERE d.measure=measure.measure)", &MeasureRow::declared}};
        return columns.all(*database_, "FROM measure ORDER BY position, measure");
    });
}

Result<std::vector<ParticipantRow>> StoreReader::participants() const {
    return guarded(path_, [&] {
        return participantColumns().all(
            *database_, "FROM participant p LEFT JOIN design_slot d USING(participant_id) ORDER BY p.participant_id");
    });
}

Result<std::vector<ConsentClauseRow>> StoreReader::consentClauses() const {
    return guarded(path_, [&] { return readConsentClauses(*database_); });
}

Result<std::vector<ConsentRow>> StoreReader::consents() const {
    return guarded(path_, [&] { return readConsents(*database_); });
}

Result<std::int64_t> StoreReader::erasedCodesTo(plan::ParticipantKind kind) const {
    return guarded(path_, [&] { return store::erasedCodesTo(*database_, kind); });
}

Result<AuditReport> StoreReader::audit() const {
    return guarded(path_, [&] { return checkAudit(*database_); });
}

Result<std::vector<SessionRow>> StoreReader::sessions() const {
    return guarded(path_, [&] {
        return sessionColumns(*database_)
            .all(*database_,
                 "FROM session s JOIN participant pa USING(participant_id) JOIN segment g ON g.segment_id="
                 "(SELECT min(n.segment_id) FROM segment n WHERE n.session_id=s.session_id) "
                 "ORDER BY s.participant_id, s.ordinal");
    });
}

Result<std::vector<AttemptRow>> StoreReader::attempts() const {
    return guarded(path_, [&] { return readAttempts(*database_, std::nullopt); });
}

Result<std::vector<measures::TickOverlap>> StoreReader::overlaps(std::int64_t attempt_id) const {
    return guarded(path_, [&] { return readExactOverlaps(*database_, attempt_id); });
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
    std::vector<EventRow> events;
    const auto read = eachEvent([&events](const EventRow& event) { events.push_back(event); });
    if (!read) return read.errors();
    return events;
}

Result<Done> StoreReader::eachEvent(const std::function<void(const EventRow&)>& take) const {
    return guarded(path_, [&] {
        store::eachEvent(*database_, take);
        return Done{};
    });
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

Result<std::vector<Extra>> StoreReader::extras() const {
    return guarded(path_, [&] {
        std::vector<Extra> found;
        for (const Extra extra : kExtras) {
            Statement known = database_->prepare("SELECT 1 FROM stream WHERE stream GLOB ? || '*' LIMIT 1");
            if (known.bind(extraStreamName(extra, 0)).step()) found.push_back(extra);
        }
        return found;
    });
}

Result<std::vector<TickRecord>> StoreReader::records(std::int64_t attempt_id, std::size_t hand) const {
    return guarded(path_, [&] {
        std::vector<TickRecord> records;
        const auto require = [&](const Result<Done>& done) {
            if (!done)
                throw std::runtime_error("attempt " + std::to_string(attempt_id) + ": " + done.errors()[0].message);
        };
        for (const Chunk& chunk : readChunks(*database_, attempt_id, tickStreamName(hand).c_str(), unpackTicks))
            require(decodeTicks(chunk, records));
        for (const Extra extra : kExtras) {
            const auto unpack = [extra](const Chunk& chunk, std::string_view encoding) {
                return unpackExtra(extra, chunk, encoding);
            };
            for (const Chunk& chunk : readChunks(*database_, attempt_id, extraStreamName(extra, hand).c_str(), unpack))
                require(decodeExtra(extra, chunk, records));
        }
        if (hand > 0) return records;
        for (const Chunk& chunk : readChunks(*database_, attempt_id, "tick_timing", unpackTiming))
            require(decodeTiming(chunk, records));
        return records;
    });
}

}  // namespace passung::store
