#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/participant.h"
#include "study/plan/study_plan.h"
#include "study/session/participant_order.h"
#include "study/store/read/store_reader.h"
#include "ui/presenter/design_balance.h"

namespace passung::presenter {

/// WithdrawnWithData: their data counts nowhere either. Excluded: by the experimenter.
enum class Standing { TakesPart, Withdrawn, WithdrawnWithData, Excluded };

/// What somebody last decided on a clause. OtherWords: on a text that the protocol no longer has.
enum class Decision { NotAsked, OtherWords, Yes, No, Withdrawn };

/// How a stored session ended. Open: it runs, or its program was killed and nobody has opened the database since.
enum class SessionEnd { Open, Complete, Aborted, Crashed };

struct SessionEntry {
    std::string id, started_utc;
    int ordinal = 1;
    SessionEnd state = SessionEnd::Open;
    std::int64_t planned = 0, attempts = 0, valid = 0;
    bool in_form = false;  // the last thing in it is a questionnaire that was not handed in
};

struct ParticipantEntry {
    std::string code, enrolled_utc;
    plan::ParticipantKind kind = plan::ParticipantKind::Real;
    Standing standing = Standing::TakesPart;
    std::string reason;                         // of the standing
    std::optional<session::DesignPlace> place;  // in this version's design
    std::vector<Decision> consent;              // by clause
    std::vector<SessionEntry> sessions;         // by ordinal
    std::int64_t forms = 0;                     // questionnaires that were answered

    std::int64_t attempts() const;
    int complete() const;
    /// Sessions that ended before their last trial.
    int interrupted() const;
    /// The session that can be gone on with; null: none.
    const SessionEntry* resumable() const;
};

/// A slot; real participants take them in this order.
struct PlaceEntry {
    session::DesignPlace at;
    std::string owner;  // empty: free
    bool done = false;  // its owner completed a session
};

/// Who takes part in a study, as an experimenter looks after them.
struct Participants {
    std::vector<plan::ConsentClause> clauses;
    std::vector<std::string> groups;
    std::vector<ParticipantEntry> people;  // by code
    std::vector<PlaceEntry> places;
    DesignBalance balance;                    // of the real participants who have a place
    int sessions = 1;                         // of each participant
    bool for_people = true;                   // every cue of the study has an output here
    bool other_version = false;               // the database holds the study, but not this version of it
    std::array<std::int64_t, 3> erased_to{};  // by kind: codes up to this number are not given again

    const ParticipantEntry* find(const std::string& code) const;
};

/// Of a study without a database: nobody is enrolled.
Participants noParticipants(const plan::StudyPlan& plan);
Result<Participants> readParticipants(const plan::StudyPlan& plan, const store::StoreReader& reader);

/// Why something cannot be done with a participant now.
enum class PersonWhy {
    Possible,
    SessionRuns,         // any, on this computer
    TakesNoPart,         // withdrawn or excluded
    Simulated,           // a person at the mouse cannot stand in
    AllDone,             // every session is complete
    NothingInterrupted,  // to resume
    NotOut,              // takes part already
    OwnWish,             // who withdrew is not taken back
    OutAlready,          // of the study
    NeedsReason,
    NeedsCode,         // the code is to be typed to confirm
    CueWithoutOutput,  // of the study's: nothing here can give it to a person
};
PersonWhy whyNotStart(const Participants& participants, const ParticipantEntry& person, bool session_runs);
PersonWhy whyNotResume(const Participants& participants, const ParticipantEntry& person, bool session_runs);
PersonWhy whyNotReadmit(const ParticipantEntry& person, const std::string& reason, bool session_runs);

/// Why a code cannot be enrolled.
enum class CodeWhy { Possible, NotACode, WrongLetter, Taken, MayBeErased };
CodeWhy whyNotEnrol(const Participants& participants, const std::string& code, plan::ParticipantKind kind);

/// The first code that may be given to the next participant of this kind.
std::string proposedCode(const Participants& participants, plan::ParticipantKind kind);

}  // namespace passung::presenter
