#include "study/store/write/store.h"

#include <algorithm>

#include "study/store/rows/accuracy_rows.h"
#include "study/store/rows/audit.h"
#include "study/store/rows/contact_geometry_rows.h"
#include "study/store/rows/participant_rows.h"
#include "study/store/rows/protocol_rows.h"
#include "study/store/rows/remarks.h"
#include "study/store/rows/session_json.h"
#include "study/store/rows/slots.h"
#include "study/store/rows/stable_stiffness_rows.h"
#include "study/store/schema/backup.h"
#include "study/store/schema/named_columns.h"
#include "study/store/schema/open_database.h"
#include "study/store/schema/process_lock.h"
#include "study/store/write/admission.h"
#include "study/store/write/earlier_backup.h"
#include "study/store/write/writer_thread.h"

namespace passung::store {
namespace {

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
        throw std::runtime_error("participant " + participant + " already has a slot in another protocol");
    }
    auto slot = findFreeSlot(database, sha256, kind, slots, station, fits);
    for (int round = 0; !slot && round < station.count; ++round) {
        insertSlots(database, sha256, kind.c_str());
        slot = findFreeSlot(database, sha256, kind, slots, station, fits);
    }
    if (!slot) throw std::runtime_error("no slot has the order of " + participant);
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

std::int64_t insertStream(const Database& database, std::int64_t segment_id, const char* name, int numerics,
                          const std::vector<Channel>& channels) {
    const std::string channels_json = channelsJson(channels);
    const std::string encoding = encodingText();
    database
        .prepare(
            "INSERT INTO stream(segment_id, stream, nominal_hz, channels_json, encoding, numerics) "
            "VALUES(?, ?, ?, ?, ?, ?)")
        .bind(segment_id, name, 1.0 / kTickSeconds, channels_json, encoding, numerics)
        .run();
    return database.lastRowId();
}

/// A part of a session that one run of the program makes; from session time `begin_ns` on.
SessionWriter::Rows insertSegment(const Database& database, const SessionStart& start, const OpenOptions& options,
                                  std::int64_t begin_ns) {
    const std::string device = deviceJson(start.device, start.units);
    database
        .prepare(
            "INSERT INTO segment(session_id, app_version, host, device_json, mono_zero_ns, utc_zero, started_utc) "
            "VALUES(?, ?, ?, ?, ?, ?, ?)")
        .bind(start.session_id, options.app_version, nullIfEmpty(start.host), device, start.mono_zero_ns,
              start.clock.at(0), UtcClock(start.clock).stamp(begin_ns).utc)
        .run();
    SessionWriter::Rows rows{start.session_id, database.lastRowId(), {}, std::nullopt};
    for (std::size_t hand = 0; hand < start.hands; ++hand)
        rows.tick_stream_ids.push_back(
            insertStream(database, rows.segment_id, tickStreamName(hand).c_str(), start.numerics, tickChannels()));
    if (start.timing_measured) {
        rows.timing_stream_id =
            insertStream(database, rows.segment_id, "tick_timing", start.numerics, timingChannels());
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
    const char* epoch = start.clock.epoch() == Epoch::Virtual ? "virtual" : "wall";
    insertRow(database, "session", Named{"session_id", start.session_id}, Named{"participant_id", start.participant},
              Named{"protocol_sha256", start.protocol_sha256}, Named{"ordinal", start.ordinal},
              Named{"station", start.station}, Named{"experimenter", nullIfEmpty(start.experimenter)},
              Named{"language", start.language}, Named{"seed", start.seed}, Named{"rng", start.random_name},
              Named{"started_utc", start.clock.at(0)}, Named{"epoch", epoch});
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

Result<std::string> Store::importProtocol(const plan::StudyPlan& draft, const plan::RunChoice& choice) {
    return importOrCheck(draft, choice, true);
}

Result<std::string> Store::checkProtocol(const plan::StudyPlan& draft, const plan::RunChoice& choice) {
    return importOrCheck(draft, choice, false);
}

Result<std::string> Store::importOrCheck(const plan::StudyPlan& draft, const plan::RunChoice& choice, bool keep) {
    const auto meshes = readMeshes(draft);
    if (!meshes) return meshes.errors();
    const auto pictures = readPictures(draft);
    if (!pictures) return pictures.errors();
    return thread_->call([&](const Database& database) {
        return importPlan(database, draft, choice, *meshes, *pictures, options_, keep);
    });
}

Result<std::vector<AccuracyRow>> Store::accuracy(const std::string& protocol_sha256) {
    return thread_->call([&](const Database& database) {
        std::vector<AccuracyRow> rows = readAccuracy(database);
        std::erase_if(rows, [&](const AccuracyRow& row) { return row.protocol_sha256 != protocol_sha256; });
        return rows;
    });
}

Result<std::vector<plan::StableStiffness>> Store::stableStiffness(const std::string& protocol_sha256) {
    return thread_->call([&](const Database& database) { return readStableStiffness(database, protocol_sha256); });
}

Result<std::vector<ContactGeometryRow>> Store::contactGeometry(const std::string& protocol_sha256) {
    return thread_->call([&](const Database& database) { return readContactGeometry(database, protocol_sha256); });
}

Result<Done> Store::keepAccuracy(const std::vector<AccuracyRow>& rows) {
    return thread_->call([&](const Database& database) {
        insertAccuracy(database, rows);
        return Done{};
    });
}

Result<Done> Store::checkAdmission(const std::string& protocol_sha256, const std::string& code,
                                   plan::ParticipantKind kind) {
    return thread_->call([&](const Database& database) {
        requireAdmission(database, protocol_sha256, code, kind);
        return Done{};
    });
}

Result<bool> Store::enrol(const std::string& code, plan::ParticipantKind kind, const std::string& created_utc) {
    return thread_->call([&](const Database& database) {
        Transaction transaction(database);
        const bool fresh = insertParticipant(database, code, kind, created_utc, options_.station);
        transaction.commit();
        return fresh;
    });
}

Result<std::string> Store::nextCode(plan::ParticipantKind kind) {
    return thread_->call([&](const Database& database) {
        Statement find = database.prepare("SELECT 1 FROM participant WHERE participant_id=?");
        // Whoever was erased may have had any code up to there: it must not come to mean somebody else.
        std::int64_t number = erasedCodesTo(database, kind) + 1;
        const auto code = [&] {
            std::string text = plan::participantCode(kind, number);
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

Result<std::string> Store::backup() {
    return thread_->call([&](const Database& database) {
        std::string kept;
        writeBackup(database, thread_->path(), [&](Database&, const std::string& fresh) {
            kept = keepEarlierBackup(backupPath(thread_->path()), fresh);
        });
        return kept;
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
        insertMeasures(database, start.hands);  // the session may have begun with a program that had fewer
        transaction.commit();
        return continueSession(database, start, used_ns, options_);
    });
    if (!rows) return rows.errors();
    return std::make_unique<SessionWriter>(*thread_, *std::move(rows), start.clock);
}

Result<Done> Store::invalidateAttempt(std::int64_t attempt_id, const std::string& reason) {
    return thread_->call([&](const Database& database) {
        Transaction transaction(database);
        invalidateLater(database, attempt_id, reason, options_.now_utc);
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
