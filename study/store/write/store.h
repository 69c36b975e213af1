#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "core/base/device_unit.h"
#include "core/base/random.h"
#include "core/base/result.h"
#include "study/design/trial_order.h"
#include "study/plan/participant.h"
#include "study/plan/run_choice.h"
#include "study/store/read/unfinished.h"
#include "study/store/rows/rows.h"
#include "study/store/schema/identity.h"
#include "study/store/schema/open_options.h"
#include "study/store/schema/utc_clock.h"
#include "study/store/write/session_writer.h"

namespace passung::store {

class WriterThread;
class ProcessLock;

/// A participant's place in the counterbalancing.
struct Slot {
    std::int64_t sequence_index = 0;  // row of the square
    std::int64_t replicate = 0;
    std::int64_t number = 0;  // replicate · rows + sequence_index: the slot of design::SessionKey
    std::size_t group = 0;    // of plan::groupNames()
};

struct SessionStart {
    std::string session_id;  // see sessionId()
    std::string participant;
    std::string protocol_sha256;
    int ordinal = 1;
    std::string station = "local";
    std::string experimenter;  // empty: none
    std::string language = "en";
    std::uint64_t seed = 0;
    std::string random_name = kRandomName;
    UtcClock clock = UtcClock::virtualEpoch();
    DeviceDescription device;
    std::vector<DeviceUnit> units = {};  // real ones that the session is performed on; none: simulated
    std::string host;                    // description of the machine; leave empty in virtual time
    std::int64_t mono_zero_ns = 0;
    bool timing_measured = false;  // a real clock runs: store every tick's computing time too
    int numerics = 0;              // core/tick/numerics.h: which arithmetic the ticks follow
    std::size_t hands = 1;         // most of any condition's scene
};

/// A study's database, open for writing by this process alone. Every function may be called from any thread and
/// returns when its data is durable; all of them run in one writer thread.
class Store {
public:
    struct Opened;

    /// Opens or creates the file, checks its integrity, upgrades its schema and marks what a killed process left.
    /// A file of a newer program is never written: NewerCompatible and NewerIncompatible come without a store.
    static Opened open(const std::string& path, const OpenOptions& options);
    ~Store();
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;

    /// Stores the protocol with its text, factors, conditions, measures, the SHA-256 of every mesh file that it names
    /// and a free slot for every planned participant. Returns the SHA-256 of the text. Importing the same text again
    /// changes nothing; another seed than that of the sessions of this protocol is refused, and so is a mesh or
    /// questionnaire file with another content. Of a try-out neither consent nor questionnaires are stored.
    Result<std::string> importProtocol(const plan::StudyPlan& draft, const plan::RunChoice& choice = {});
    /// The same answer, but nothing is stored.
    Result<std::string> checkProtocol(const plan::StudyPlan& draft, const plan::RunChoice& choice = {});

    /// What was measured and picked for the protocol's accuracy = "auto", by candidate; none if it never ran so.
    Result<std::vector<AccuracyRow>> accuracy(const std::string& protocol_sha256);
    /// Keeps that for good. A protocol that has it already is an error.
    Result<Done> keepAccuracy(const std::vector<AccuracyRow>& rows);

    /// Stable stiffness of the devices as the plan had it when it was first imported: what the protocol's stiffnesses
    /// mean in this database, for good. None in protocols from before revision 4.
    Result<std::vector<plan::StableStiffness>> stableStiffness(const std::string& protocol_sha256);
    Result<std::vector<ContactGeometryRow>> contactGeometry(const std::string& protocol_sha256);

    /// Checks whether somebody of this kind, enrolled or not, may begin a session of the protocol. Nothing is stored.
    /// Errors: excluded, withdrawn, or a required clause of consent without a yes.
    Result<Done> checkAdmission(const std::string& protocol_sha256, const std::string& code,
                                plan::ParticipantKind kind);

    /// True if the participant is new, false if already enrolled with this kind; another kind is an error, and so is a
    /// code that does not begin with the kind's letter (of several stations: with theirs behind it), or that an erased
    /// participant may have had.
    Result<bool> enrol(const std::string& code, plan::ParticipantKind kind, const std::string& created_utc);

    /// The first unused code of the kind: P001, P002 … for real participants; of several stations PB001, PB002 ….
    Result<std::string> nextCode(plan::ParticipantKind kind);

    /// The participant's slot: the one they have, else the first free one in the order of design::placesOf(), its
    /// stratum the kind of participant; a further round of it if none is free. It is theirs for good once a session
    /// completes; as long as none does, a session that does not complete gives it back. Refused to whoever has
    /// completed the protocol. Each kind of participant has slots of its own, so that simulated people never use up a
    /// slot.
    /// `fits`: which free slots may be taken; empty: all.
    Result<Slot> assignSlot(const std::string& protocol_sha256, const std::string& participant,
                            const std::function<bool(const Slot&)>& fits = {});

    /// 1 for a participant's first session.
    Result<int> nextOrdinal(const std::string& participant);

    /// The session of the protocol that the participant is to do next, from 1: one more than they completed.
    Result<int> nextPart(const std::string& protocol_sha256, const std::string& participant);

    /// Writes session, segment and the complete plan of trials in one transaction. Refused to a participant who has
    /// completed this protocol, and with another seed than the protocol's earlier sessions. The writer must not outlive
    /// the store.
    Result<std::unique_ptr<SessionWriter>> createSession(const SessionStart& start,
                                                         std::span<const design::PlannedTrial> plan);

    /// A session that did not complete, by its id or (empty) the newest one; not one whose participant takes part no
    /// more or has begun another one since.
    Result<Unfinished> unfinished(const std::string& session_id);

    /// Goes on with it in a segment of its own at session time `used_ns`; `start` as for createSession.
    Result<std::unique_ptr<SessionWriter>> resumeSession(const SessionStart& start, std::int64_t used_ns);

    /// Copies the database as it is now (see backupPath()). Returns under which name an earlier copy was kept, because
    /// it has what the new one lacks or has damaged; empty: under none.
    Result<std::string> backup();
    /// What people add when no session runs: an attempt no longer counts; a note about its session (0: the newest one).
    Result<Done> invalidateAttempt(std::int64_t attempt_id, const std::string& reason);
    Result<Done> addNote(std::int64_t attempt_id, const std::string& text);

private:
    friend class ParticipantRecords;
    Result<std::string> importOrCheck(const plan::StudyPlan& draft, const plan::RunChoice& choice, bool keep);
    Store(OpenOptions options, std::unique_ptr<ProcessLock> lock, std::unique_ptr<WriterThread> thread);

    OpenOptions options_;
    std::unique_ptr<ProcessLock> lock_;
    std::unique_ptr<WriterThread> thread_;  // ends before the lock is released
};

/// What came of opening; `store` is null and `errors` tells why unless it is Current, Upgraded or Created.
struct Store::Opened {
    OpenOutcome outcome = OpenOutcome::Failed;
    std::unique_ptr<Store> store;
    RecoveryReport recovery;
    Errors errors;
};

}  // namespace passung::store
