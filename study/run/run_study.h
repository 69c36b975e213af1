#pragma once

#include <functional>
#include <string>

#include "core/base/result.h"
#include "study/plan/run_choice.h"
#include "study/run/files/mesh_importer.h"
#include "study/run/files/wall_clock.h"
#include "study/run/log/study_log.h"
#include "study/run/loop_apparatus.h"
#include "study/run/person/taking_part.h"
#include "study/run/units/station_devices.h"
#include "study/session/session.h"
#include "study/store/write/store.h"

namespace passung::run {

struct RunOptions {
    std::string database;
    std::string participant;  // code of one participant; empty: the next free codes of simulated ones
    store::Station station;
    int simulated = 1;  // how many simulated participants, one after another
    plan::RunChoice choice;
    Clock clock = Clock::Virtual;
    bool backup = true;                               // copy the database when the run ends, however it does
    bool group = false;                               // share the database, as of store::OpenOptions
    bool wait = false;                                // every session begins with the command Start
    std::function<bool()> interrupted;                // asked every few ticks: true ends the run; empty: never
    std::string language;                             // participants are spoken to in; empty: the protocol's first
    session::QuestionnaireSource* answers = nullptr;  // who answers questionnaires; nullptr: a simulated person
    session::InstructionReader* reader = nullptr;     // who reads instructions; nullptr: a simulated person
    AskConsent ask_consent;                           // empty: nobody is asked here
    std::string experimenter;                         // who conducts the session; empty: not said
    Performer* performer = nullptr;                   // who takes part or watches; null: nobody
    store::UtcClock::Now now = unixMilliseconds;      // in real time; virtual time has none
    ImportLimits import_limits;                       // of every mesh file
    BuildWatch told;                                  // what of a part is being built
    StudyLog* log = nullptr;                          // of the database; null: none is kept
    StationDevices real;                              // devices of this station, which people hold
    bool warns = false;  // looks for what is unusual and tells of it (session::Warned); else nothing is looked for
};

/// How a run ended that met no error.
enum class RunEnd { Complete, Interrupted };

/// While a session runs, an experimenter may command it through CommandSocket.
/// Performs the study, as freeze() makes it of its draft, with simulated participants on the simulated device, each a
/// session of all planned trials, into the database; a participant whose code is that of a person is refused, for want
/// of a device, unless the performer brings one for a participant of that kind, or the station has real ones: people
/// hold these, in real time, as long as sessions run. Questionnaires may be answered by somebody all the same: that is
/// a rehearsal, and its data is marked simulated. Whatever was finished before an error stays in it. An interruption
/// stores the running trial as aborted and closes the session as aborted, both with the reason "interrupted". What
/// contact.accuracy = "auto" asks for is picked when the protocol first runs in this database, and kept there; before
/// later runs in real time a machine that is too slow for it is warned of. Errors before anything is stored: a language
/// that is none of plan::languagesOf(draft).
Result<RunEnd> runStudy(const plan::StudyPlan& draft, RunOptions options, const session::SessionListener& listener);

struct ResumeOptions {
    std::string session;  // id; empty: the newest one that did not complete
    std::string meshes;   // folder that the protocol's mesh paths start from; empty: here, else beside the database
};

/// Goes on with an interrupted session of the database by its protocol's [resume], in the clock and language that it
/// had. Of `options`, participant, simulated, choice, clock and language do not matter. Later trials are what the
/// uninterrupted session's would have been.
Result<RunEnd> resumeStudy(const ResumeOptions& resume, RunOptions options, const session::SessionListener& listener);

}  // namespace passung::run
