#include "study/store/store.h"

#include <algorithm>

#include "study/measures/measures.h"
#include "study/protocol/document.h"
#include "study/protocol/json.h"
#include "study/store/accuracy_rows.h"
#include "study/store/admission.h"
#include "study/store/audit.h"
#include "study/store/backup.h"
#include "study/store/consent_rows.h"
#include "study/store/digest.h"
#include "study/store/open_database.h"
#include "study/store/participant_rows.h"
#include "study/store/picture_rows.h"
#include "study/store/process_lock.h"
#include "study/store/questionnaire_rows.h"
#include "study/store/remarks.h"
#include "study/store/revisions.h"
#include "study/store/session_json.h"
#include "study/store/slots.h"
#include "study/store/stable_stiffness_rows.h"
#include "study/store/writer_thread.h"

namespace passung::store {
namespace {

std::string levelsJson(const protocol::Factor& factor) {
    std::vector<std::string> labels;
    for (const protocol::Level& level : factor.levels) labels.push_back(protocol::jsonText(level.label));
    return protocol::jsonList(labels);
}

/// Rows of the counterbalancing that the plan's orders take turns with.
std::int64_t sequenceCount(const protocol::StudyPlan& plan) {
    return static_cast<std::int64_t>(design::sequencesOf(protocol::designOf(plan)));
}

void insertFactors(const Database& database, const std::string& sha256, const protocol::StudyPlan& plan) {
    Statement insert = database.prepare("INSERT INTO factor VALUES(?, ?, ?, 'text', ?, ?, ?, ?)");
    std::int64_t position = 0;
    for (const protocol::Factor& factor : plan.factors) {
        const auto unit = factor.unit.empty() ? std::nullopt : std::optional(factor.unit);
        const std::string levels = levelsJson(factor);
        insert.bind(sha256, factor.name, protocol::factorKindName(factor.kind), unit, factor.name, position++, levels)
            .run();
    }
}

void insertConditions(const Database& database, const std::string& sha256, const protocol::StudyPlan& plan) {
    Statement insert =
        database.prepare("INSERT INTO condition(protocol_sha256, condition, levels_json, position) VALUES(?, ?, ?, ?)");
    std::int64_t position = 0;
    for (const protocol::Condition& condition : plan.conditions) {
        insert.bind(sha256, condition.name, condition.levels_json, position++).run();
    }
}

/// Measures belong to the whole file: one formula per name, or the numbers of one column would mean two things. Those
/// that the file does not know yet, from before this program had them, are added.
void insertMeasures(const Database& database) {
    Statement insert = database.prepare("INSERT INTO measure VALUES(?, ?, ?, 'number', ?, ?, ?)");
    Statement find = database.prepare("SELECT formula_version FROM measure WHERE measure=?");
    std::int64_t position = 0;
    for (const measures::Definition& definition : measures::definitions()) {
        if (!find.bind(definition.name).step()) {
            insert
                .bind(definition.name, definition.label, definition.unit, definition.formula, definition.version,
                      position)
                .run();
        } else if (find.integer(0) != definition.version) {
            throw std::runtime_error("the database holds the measure " + definition.name + " by version " +
                                     find.text(0) + " of its formula, this program computes version " +
                                     std::to_string(definition.version) + ": use a new database");
        }
        ++position;
    }
}

void declareMeasures(const Database& database, const std::string& sha256, const protocol::StudyPlan& plan) {
    Statement declare = database.prepare("INSERT INTO protocol_measure VALUES(?, ?)");
    for (const measures::Definition& definition : measures::definitions()) {
        const bool declared = plan.measures.empty() || std::find(plan.measures.begin(), plan.measures.end(),
                                                                 definition.name) != plan.measures.end();
        if (declared) declare.bind(sha256, definition.name).run();
    }
}

/// Rows of the square and everybody's order follow from the seed: one protocol has one seed in a database.
void requireSeed(const Database& database, const std::string& sha256, std::uint64_t seed) {
    Statement find = database.prepare("SELECT seed FROM session WHERE protocol_sha256=? AND seed<>? LIMIT 1");
    if (!find.bind(sha256, seed).step()) return;
    throw std::runtime_error("the sessions of this protocol in this database have seed " +
                             std::to_string(static_cast<std::uint64_t>(find.integer(0))) + ", not " +
                             std::to_string(seed) + ": use that seed or another database");
}

/// The plan's JSON must say the seed in force, which may be another than the protocol's own.
void storeSeed(const Database& database, const std::string& sha256, std::uint64_t seed) {
    database
        .prepare(
            "UPDATE protocol_version SET expanded_json=json_replace(expanded_json, '$.seed', json(?2)) "
            "WHERE protocol_sha256=?1 AND json_extract(expanded_json, '$.seed')<>?3")
        .bind(sha256, std::to_string(seed), seed)
        .run();
}

struct MeshContent {
    std::string mesh, sha256;
    std::int64_t bytes;
};

Result<std::vector<MeshContent>> readMeshes(const protocol::StudyPlan& plan) {
    std::vector<MeshContent> meshes;
    for (const protocol::MeshSource& mesh : plan.meshes) {
        const auto bytes = protocol::readFile(mesh.path);
        if (!bytes) return bytes.errors();
        meshes.push_back({mesh.name, sha256Hex(*bytes), static_cast<std::int64_t>(bytes->size())});
    }
    return meshes;
}

/// The text of a protocol stands for its meshes too: data of one protocol must be of one geometry.
void requireMeshes(const Database& database, const std::string& sha256, const std::vector<MeshContent>& meshes) {
    Statement find = database.prepare("SELECT sha256 FROM mesh_file WHERE protocol_sha256=? AND mesh=?");
    for (const MeshContent& mesh : meshes) {
        if (find.bind(sha256, mesh.mesh).step() && find.text(0) == mesh.sha256) continue;
        throw std::runtime_error("the mesh file " + mesh.mesh +
                                 " has changed since this protocol was stored: restore it, or give the protocol a new "
                                 "version");
    }
}

/// One file holds one study, and a version of it is one text: else rows of two designs could not be told apart.
void requireSameStudy(const Database& database, const protocol::StudyPlan& plan) {
    Statement other = database.prepare("SELECT name FROM protocol_version WHERE name<>? LIMIT 1");
    if (other.bind(plan.name).step()) {
        throw std::runtime_error("holds the study " + other.text(0) + ", not " + plan.name +
                                 ": one database per study, name another with --db");
    }
    Statement same = database.prepare("SELECT 1 FROM protocol_version WHERE name=? AND version=? LIMIT 1");
    if (same.bind(plan.name, plan.version).step()) {
        throw std::runtime_error("the protocol has changed since version " + plan.version +
                                 " of it was stored here: restore its text, or give the protocol a new version");
    }
}

std::string importPlan(const Database& database, const protocol::StudyPlan& plan,
                       const std::vector<MeshContent>& meshes, const std::vector<PictureContent>& pictures,
                       const OpenOptions& options, bool keep) {
    const std::string sha256 = sha256Hex(plan.source_text);
    Transaction transaction(database);
    if (database.prepare("SELECT 1 FROM protocol_version WHERE protocol_sha256=?").bind(sha256).step()) {
        requireSeed(database, sha256, plan.seed);
        requireMeshes(database, sha256, meshes);
        requirePictures(database, sha256, pictures);
        requireQuestionnaires(database, sha256, plan);
        storeSeed(database, sha256, plan.seed);
        insertMeasures(database);
        if (keep) transaction.commit();
        return sha256;
    }
    requireSameStudy(database, plan);
    database.prepare("INSERT INTO protocol_version VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(sha256, plan.name, plan.version, plan.source_text, plan.expanded_json, schemaNumber(),
              options.app_version, options.now_utc, plan.title, sequenceCount(plan))
        .run();
    storeSeed(database, sha256, plan.seed);
    Statement insert_mesh = database.prepare("INSERT INTO mesh_file VALUES(?, ?, ?, ?)");
    for (const MeshContent& mesh : meshes) insert_mesh.bind(sha256, mesh.mesh, mesh.sha256, mesh.bytes).run();
    insertPictures(database, sha256, pictures);
    insertFactors(database, sha256, plan);
    insertConditions(database, sha256, plan);
    insertQuestionnaires(database, plan);
    insertMeasures(database);
    declareMeasures(database, sha256, plan);
    Statement insert_stable = database.prepare("INSERT INTO stable_stiffness VALUES(?, ?, ?, ?, ?)");
    for (const protocol::StableStiffness& stable : plan.stable_stiffness)
        insert_stable.bind(sha256, stable.device, stable.linear, stable.rotational, stable.origin).run();
    insertConsentClauses(database, sha256, plan.consent);
    while (slotCount(database, sha256) < plan.participants)
        insertSlots(database, sha256, protocol::participantKindName(protocol::ParticipantKind::Real));
    if (keep) transaction.commit();
    return sha256;
}

Slot slotOf(const Statement& row, const SlotDesign& design) {
    const std::int64_t index = row.integer(1);
    const std::int64_t replicate = row.integer(2);
    const auto group = std::find(design.groups.begin(), design.groups.end(), row.text(3)) - design.groups.begin();
    return {index, replicate, replicate * static_cast<std::int64_t>(design.allocation.sequences) + index,
            static_cast<std::size_t>(group)};
}

std::string kindOf(const Database& database, const std::string& participant) {
    Statement find = database.prepare("SELECT kind FROM participant WHERE participant_id=?");
    if (!find.bind(participant).step()) throw std::runtime_error("participant " + participant + " is not enrolled");
    return find.text(0);
}

void refuseComplete(const Database& database, const std::string& sha256, const std::string& participant) {
    Statement find = database.prepare(
        "SELECT max(ordinal) FROM session WHERE protocol_sha256=?1 AND participant_id=?2 AND end_state='complete' "
        "HAVING count(*) >= (SELECT coalesce(json_extract(expanded_json, '$.sessions'), 1) FROM protocol_version "
        "WHERE protocol_sha256=?1)");
    if (!find.bind(sha256, participant).step()) return;
    throw std::runtime_error("participant " + participant + " has completed this protocol in session " + find.text(0) +
                             "; nobody takes part twice");
}

/// The first free slot of the station that fits and its row; nothing if there is none. Slots are numbered as a single
/// station takes them; another one takes each with a row that lies its first one further.
std::optional<std::pair<std::int64_t, Slot>> findFreeSlot(const Database& database, const std::string& sha256,
                                                          const std::string& kind, const SlotDesign& slots,
                                                          const Station& station,
                                                          const std::function<bool(const Slot&)>& fits) {
    const auto first = design::firstRow(
        slots.rows, {static_cast<std::size_t>(station.index), static_cast<std::size_t>(station.count)});
    Statement free = database.prepare(
        "SELECT d.slot_id, d.sequence_index, d.replicate, d.between_group FROM design_slot d LEFT JOIN design_slot "
        "turn "
        "ON (turn.protocol_sha256, turn.kind, turn.between_group, turn.replicate)="
        "(d.protocol_sha256, d.kind, d.between_group, d.replicate) AND turn.sequence_index=(d.sequence_index + ?5) % "
        "?6 "
        "WHERE d.protocol_sha256=?1 AND d.kind=?2 AND d.state='free' AND d.replicate % ?3=?4 "
        "ORDER BY coalesce(turn.slot_id, d.slot_id)");
    free.bind(sha256, kind, station.count, station.index, slots.allocation.sequences - first,
              slots.allocation.sequences);
    while (free.step())
        if (const Slot slot = slotOf(free, slots); !fits || fits(slot)) return std::pair(free.integer(0), slot);
    return std::nullopt;
}

Slot takeSlot(const Database& database, const std::string& sha256, const std::string& participant,
              const Station& station, const std::function<bool(const Slot&)>& fits) {
    Transaction transaction(database);
    const SlotDesign slots = slotDesignOf(database, sha256);
    const std::string kind = kindOf(database, participant);
    refuseComplete(database, sha256, participant);
    requireAdmission(database, sha256, participant);
    Statement own = database.prepare(
        "SELECT protocol_sha256, sequence_index, replicate, between_group FROM design_slot WHERE participant_id=?");
    if (own.bind(participant).step()) {
        if (own.text(0) == sha256) return slotOf(own, slots);
        throw std::runtime_error("participant " + participant + " already has a place in another protocol");
    }
    auto slot = findFreeSlot(database, sha256, kind, slots, station, fits);
    for (int round = 0; !slot && round < station.count; ++round) {
        insertSlots(database, sha256, kind.c_str());
        slot = findFreeSlot(database, sha256, kind, slots, station, fits);
    }
    if (!slot) throw std::runtime_error("no place of the design has the order of " + participant);
    database.prepare("UPDATE design_slot SET state='assigned', participant_id=?, station=? WHERE slot_id=?")
        .bind(participant, station.name, slot->first)
        .run();
    transaction.commit();
    return slot->second;
}

void insertTrialPlan(const Database& database, const SessionStart& start, std::span<const design::PlannedTrial> plan) {
    std::vector<std::int64_t> condition_ids;
    Statement conditions =
        database.prepare("SELECT condition_id FROM condition WHERE protocol_sha256=? ORDER BY position");
    conditions.bind(start.protocol_sha256);
    while (conditions.step()) condition_ids.push_back(conditions.integer(0));
    Statement insert = database.prepare(
        "INSERT INTO trial_plan(session_id, trial_index, block_index, block, trial_in_block, phase, condition_id, "
        "repetition) VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
    for (const design::PlannedTrial& trial : plan) {
        insert
            .bind(start.session_id, trial.trial_index, trial.block_index, trial.block, trial.trial_in_block,
                  trial.phase, condition_ids.at(trial.condition), trial.repetition)
            .run();
    }
}

std::int64_t insertStream(const Database& database, std::int64_t segment_id, const char* name,
                          const std::vector<Channel>& channels) {
    const std::string channels_json = channelsJson(channels);
    const std::string encoding = encodingText();
    database
        .prepare("INSERT INTO stream(segment_id, stream, nominal_hz, channels_json, encoding) VALUES(?, ?, ?, ?, ?)")
        .bind(segment_id, name, 1.0 / kTickSeconds, channels_json, encoding)
        .run();
    return database.lastRowId();
}

/// A part of a session that one run of the program makes; from session time `begin_ns` on.
SessionWriter::Rows insertSegment(const Database& database, const SessionStart& start, const OpenOptions& options,
                                  std::int64_t begin_ns) {
    const std::string device = deviceJson(start.device);
    database
        .prepare(
            "INSERT INTO segment(session_id, app_version, host, device_json, mono_zero_ns, utc_zero, started_utc) "
            "VALUES(?, ?, ?, ?, ?, ?, ?)")
        .bind(start.session_id, options.app_version, nullIfEmpty(start.host), device, start.mono_zero_ns,
              start.clock.at(0), start.clock.at(begin_ns))
        .run();
    SessionWriter::Rows rows{start.session_id, database.lastRowId(), 0, std::nullopt};
    rows.tick_stream_id = insertStream(database, rows.segment_id, "tick", tickChannels());
    if (start.timing_measured) {
        rows.timing_stream_id = insertStream(database, rows.segment_id, "tick_timing", timingChannels());
    }
    database
        .prepare(
            "UPDATE participant SET status='active', status_reason=NULL "
            "WHERE participant_id=? AND status='enrolled'")
        .bind(start.participant)
        .run();
    return rows;
}

SessionWriter::Rows insertSession(const Database& database, const SessionStart& start,
                                  std::span<const design::PlannedTrial> plan, const OpenOptions& options) {
    Transaction transaction(database);
    requireSeed(database, start.protocol_sha256, start.seed);
    refuseComplete(database, start.protocol_sha256, start.participant);
    requireAdmission(database, start.protocol_sha256, start.participant);
    database.prepare("INSERT INTO session VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, NULL, NULL, ?)")
        .bind(start.session_id, start.participant, start.protocol_sha256, start.ordinal, start.station,
              nullIfEmpty(start.experimenter), start.language, start.seed, start.random_name, start.clock.at(0),
              start.clock.epoch() == Epoch::Virtual ? "virtual" : "wall")
        .run();
    insertTrialPlan(database, start, plan);
    const auto rows = insertSegment(database, start, options, 0);
    transaction.commit();
    return rows;
}

SessionWriter::Rows continueSession(const Database& database, const SessionStart& start, std::int64_t begin_ns,
                                    const OpenOptions& options) {
    Transaction transaction(database);
    requireAdmission(database, start.protocol_sha256, start.participant);
    reopenSession(database, start.session_id);
    const auto rows = insertSegment(database, start, options, begin_ns);
    transaction.commit();
    return rows;
}

}  // namespace

Store::Store(OpenOptions options, std::unique_ptr<ProcessLock> lock, std::unique_ptr<WriterThread> thread)
    : options_(std::move(options)), lock_(std::move(lock)), thread_(std::move(thread)) {}

Store::~Store() = default;

Store::Opened Store::open(const std::string& path, const OpenOptions& options) {
    Opened opened;
    auto lock = ProcessLock::take(path);
    if (!lock) {
        opened.errors = lock.errors();
        return opened;
    }
    OpenedDatabase file = openForWriting(path, options);
    opened.outcome = file.outcome;
    opened.recovery = std::move(file.recovery);
    opened.errors = std::move(file.errors);
    if (file.database) {
        opened.store.reset(new Store(options, std::make_unique<ProcessLock>(*std::move(lock)),
                                     std::make_unique<WriterThread>(path, std::move(file.database))));
    }
    return opened;
}

Result<std::string> Store::importProtocol(const protocol::StudyPlan& plan) { return importOrCheck(plan, true); }

Result<std::string> Store::checkProtocol(const protocol::StudyPlan& plan) { return importOrCheck(plan, false); }

Result<std::string> Store::importOrCheck(const protocol::StudyPlan& plan, bool keep) {
    const auto meshes = readMeshes(plan);
    if (!meshes) return meshes.errors();
    const auto pictures = readPictures(plan);
    if (!pictures) return pictures.errors();
    return thread_->call(
        [&](const Database& database) { return importPlan(database, plan, *meshes, *pictures, options_, keep); });
}

Result<std::vector<AccuracyRow>> Store::accuracy(const std::string& protocol_sha256) {
    return thread_->call([&](const Database& database) {
        std::vector<AccuracyRow> rows = readAccuracy(database);
        std::erase_if(rows, [&](const AccuracyRow& row) { return row.protocol_sha256 != protocol_sha256; });
        return rows;
    });
}

Result<std::vector<protocol::StableStiffness>> Store::stableStiffness(const std::string& protocol_sha256) {
    return thread_->call([&](const Database& database) { return readStableStiffness(database, protocol_sha256); });
}

Result<Done> Store::keepAccuracy(const std::vector<AccuracyRow>& rows) {
    return thread_->call([&](const Database& database) {
        insertAccuracy(database, rows);
        return Done{};
    });
}

Result<bool> Store::enrol(const std::string& code, protocol::ParticipantKind kind, const std::string& created_utc) {
    return thread_->call([&](const Database& database) {
        Transaction transaction(database);
        const bool fresh = insertParticipant(database, code, kind, created_utc, options_.station);
        transaction.commit();
        return fresh;
    });
}

Result<std::string> Store::nextCode(protocol::ParticipantKind kind) {
    return thread_->call([&](const Database& database) {
        Statement find = database.prepare("SELECT 1 FROM participant WHERE participant_id=?");
        // Whoever was erased may have had any code up to there: it must not come to mean somebody else.
        std::int64_t number = erasedCodesTo(database, kind) + 1;
        const auto code = [&] {
            std::string text = protocol::participantCode(kind, number);
            return options_.station.count > 1 ? text.insert(1, options_.station.name) : text;
        };
        while (find.bind(code()).step()) ++number;
        return code();
    });
}

Result<Slot> Store::assignSlot(const std::string& protocol_sha256, const std::string& participant,
                               const std::function<bool(const Slot&)>& fits) {
    return thread_->call([&](const Database& database) {
        return takeSlot(database, protocol_sha256, participant, options_.station, fits);
    });
}

Result<Done> Store::backup() {
    return thread_->call([&](const Database& database) {
        writeBackup(database, thread_->path());
        return Done{};
    });
}

Result<int> Store::nextPart(const std::string& protocol_sha256, const std::string& participant) {
    return thread_->call([&](const Database& database) {
        Statement find = database.prepare(
            "SELECT count(*) + 1 FROM session WHERE protocol_sha256=? AND participant_id=? AND end_state='complete'");
        find.bind(protocol_sha256, participant).step();
        return static_cast<int>(find.integer(0));
    });
}

Result<int> Store::nextOrdinal(const std::string& participant) {
    return thread_->call([&](const Database& database) {
        Statement find = database.prepare("SELECT coalesce(max(ordinal), 0) + 1 FROM session WHERE participant_id=?");
        find.bind(participant).step();
        return static_cast<int>(find.integer(0));
    });
}

Result<std::unique_ptr<SessionWriter>> Store::createSession(const SessionStart& start,
                                                            std::span<const design::PlannedTrial> plan) {
    auto rows = thread_->call([&](const Database& database) { return insertSession(database, start, plan, options_); });
    if (!rows) return rows.errors();
    return std::make_unique<SessionWriter>(*thread_, *std::move(rows), start.clock);
}

Result<Unfinished> Store::unfinished(const std::string& session_id) {
    return thread_->call([&](const Database& database) {
        Unfinished session = readUnfinished(database, session_id, options_.now_utc);
        requireAdmission(database, session.protocol_sha256, session.participant);
        return session;
    });
}

Result<std::unique_ptr<SessionWriter>> Store::resumeSession(const SessionStart& start, std::int64_t used_ns) {
    auto rows = thread_->call([&](const Database& database) {
        Transaction transaction(database);
        insertMeasures(database);  // the session may have begun with a program that had fewer
        transaction.commit();
        return continueSession(database, start, used_ns, options_);
    });
    if (!rows) return rows.errors();
    return std::make_unique<SessionWriter>(*thread_, *std::move(rows), start.clock);
}

Result<Done> Store::invalidateAttempt(std::int64_t attempt_id, const std::string& reason) {
    return thread_->call([&](const Database& database) {
        Transaction transaction(database);
        invalidateLater(database, attempt_id, reason);
        transaction.commit();
        return Done{};
    });
}

Result<Done> Store::addNote(std::int64_t attempt_id, const std::string& text) {
    return thread_->call([&](const Database& database) {
        Transaction transaction(database);
        noteLater(database, attempt_id, text, options_.now_utc);
        transaction.commit();
        return Done{};
    });
}

}  // namespace passung::store
