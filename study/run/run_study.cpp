#include "study/run/run_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <thread>

#include "core/base/digest.h"
#include "core/base/regular_file.h"
#include "core/tick/numerics.h"
#include "devices/simulated/presets.h"
#include "study/measures/measures.h"
#include "study/person/simulated_person.h"
#include "study/plan/language.h"
#include "study/plan/plan_contents.h"
#include "study/run/command_socket.h"
#include "study/run/files/builds.h"
#include "study/run/files/known_names.h"
#include "study/run/files/stored_plans.h"
#include "study/run/log/logged_run.h"
#include "study/run/log/logged_sink.h"
#include "study/run/machine/auto_accuracy.h"
#include "study/run/machine/calibration.h"
#include "study/run/machine/host.h"
#include "study/run/machine/stability_report.h"
#include "study/run/person/at_device.h"
#include "study/run/person/simulated_answers.h"
#include "study/run/person/simulated_timer.h"
#include "study/session/participant_order.h"
#include "study/store/schema/identity.h"

namespace passung::run {

namespace {

/// For the log.
std::string sessionText(const session::SessionSetup& setup, const DeviceDescription& device) {
    return fmt::format("session begins: {}, {} trials, device {} ({})",
                       setup.timing_measured ? "real time" : "virtual time", setup.trials.size(), device.name,
                       device.label);
}

/// For the log.
const char* openingText(store::OpenOutcome outcome) {
    switch (outcome) {
        case store::OpenOutcome::Current:
            return "store opened";
        case store::OpenOutcome::Upgraded:
            return "store opened, its schema upgraded";
        case store::OpenOutcome::Created:
            return "store created";
        default:
            return "store not opened";
    }
}

/// A simulated person has no use for a text.
class SimulatedReader : public session::InstructionReader {
public:
    std::optional<session::PageRead> read(const session::Page&) override { return session::PageRead{"simulated", {}}; }
};

/// One participant: enrolled, given a slot, and through all trials.
class StudyRun {
public:
    StudyRun(plan::FrozenPlan plan, const RunOptions& options, const session::SessionListener& listener,
             store::Store& store, std::string protocol_sha256, UnitRack& rack)
        : plan_(std::move(plan)),
          options_(options),
          listener_(listener),
          store_(store),
          sha256_(std::move(protocol_sha256)),
          rack_(rack) {}

    /// All sessions that are left to do; of a participant named by code the next one.
    Result<RunEnd> participant(int number) {
        const store::UtcClock clock = clockNow();
        std::string code = options_.participant;
        if (code.empty()) {
            auto next = store_.nextCode(kind());
            if (!next) return next.errors();
            code = *next;
        }
        // Whoever is not admitted leaves no trace; only a decision on consent that is asked for here needs a code
        // first.
        if (!options_.ask_consent)
            if (const auto admitted = store_.checkAdmission(sha256_, code, kind()); !admitted) return admitted.errors();
        if (auto enrolled = store_.enrol(code, kind(), clock.at(0)); !enrolled) {
            return enrolled.errors();
        }
        if (options_.ask_consent) {
            const auto asked = askForConsent(store_, options_.database, *plan_, code, options_.language, clock.at(0),
                                             options_.ask_consent);
            if (!asked) return asked.errors();
        }
        auto slot = store_.assignSlot(sha256_, code);
        if (!slot) return slot.errors();
        auto part = store_.nextPart(sha256_, code);
        if (!part) return part.errors();
        const int last = options_.participant.empty() ? plan::sessionsOf(*plan_) : *part;
        listener_(session::ParticipantBegins{code, number, options_.simulated});
        for (int p = *part; p <= last; ++p)
            if (auto end = session(code, {static_cast<std::size_t>(slot->number), slot->group}, p);
                !end || *end == RunEnd::Interrupted)
                return end;
        return RunEnd::Complete;
    }

    Result<RunEnd> resume(const store::Unfinished& session) {
        if (session.age_s)
            if (const auto old = session::tooOld(plan_->resume, *session.age_s))
                return Error{.message = fmt::format("{}, session {}: {}", session.participant, session.ordinal, *old),
                             .file = options_.database};
        // The place that the interruption freed may have another owner by now: one with the same order will do.
        const auto part = store_.nextPart(sha256_, session.participant);
        if (!part) return part.errors();
        const auto fits = [&](const store::Slot& slot) {
            const session::DesignPlace place{static_cast<std::size_t>(slot.number), slot.group};
            const auto trials = session::planTrials(*plan_, place, session.participant, *part);
            return trials && *trials == session.trials;
        };
        if (const auto slot = store_.assignSlot(sha256_, session.participant, fits); !slot) return slot.errors();
        listener_(session::ParticipantBegins{session.participant});

        LoopApparatus& apparatus = apparatusOf(session.participant);
        const store::UtcClock clock = clockNow(session.used_ns, session.latest_utc);
        const auto start = startOf(session.session_id, session.participant, session.ordinal, clock, apparatus);
        auto writer = store_.resumeSession(start, session.used_ns);
        if (!writer) return writer.errors();

        auto resumed = session::resumption(*plan_, session.trials, session.attempts, session.crashed, session.forms,
                                           session.steps);
        resumed.start_ns = session.used_ns;
        resumed.quality = session.quality;
        (*writer)->appendEvent(
            {.attempt = {}, .t_ns = session.used_ns, .source = "session", .event = "session_resumed"});
        resumed.change.reason = "done again after an interruption";
        listener_(resumed);
        if (const auto done = (*writer)->reorder(resumed.change); !done) return done.errors();
        return perform({plan_, session.trials, session.participant, plan_->seed, measured(), session.ordinal,
                        options_.wait, std::move(resumed)},
                       apparatus, **writer);
    }

private:
    bool measured() const { return options_.clock == Clock::RealTime; }

    plan::ParticipantKind kind() const {
        return options_.performer == nullptr ? plan::ParticipantKind::Simulated : options_.performer->kind();
    }

    store::UtcClock clockNow(std::int64_t used_ns = 0, const std::string& latest_utc = {}) const {
        return measured() ? store::UtcClock::running(options_.now, used_ns, latest_utc)
                          : store::UtcClock::virtualEpoch();
    }

    /// One for all sessions, so that its parts are built once.
    LoopApparatus& apparatusOf(const std::string& code) {
        const simulated::DeviceParams* device = simulated::findPreset(plan_->conditions.front().device);
        const person::SimulatedPerson person = person::personOf(plan_->name, code, plan_->seed);
        if (apparatus_)
            apparatus_->passTo(person);
        else
            apparatus_.emplace(*device, person, options_.clock, options_.performer, options_.import_limits,
                               options_.told, &rack_);
        return *apparatus_;
    }

    store::SessionStart startOf(std::string session_id, std::string code, int ordinal, const store::UtcClock& clock,
                                const LoopApparatus& apparatus) const {
        store::SessionStart start;
        start.session_id = std::move(session_id);
        start.participant = std::move(code);
        start.protocol_sha256 = sha256_;
        start.ordinal = ordinal;
        start.station = options_.station.name;
        start.experimenter = options_.experimenter;
        start.language = options_.language;
        start.seed = plan_->seed;
        start.clock = clock;
        start.device = apparatus.device();
        start.units = rack_.units();
        if (measured()) start.host = hostText();
        start.timing_measured = measured();
        start.numerics = tick::kNumerics;
        start.hands = plan::mostHands(*plan_);
        return start;
    }

    Result<RunEnd> session(const std::string& code, const session::DesignPlace& place, int part) {
        auto ordinal = store_.nextOrdinal(code);
        if (!ordinal) return ordinal.errors();
        LoopApparatus& apparatus = apparatusOf(code);
        const auto start =
            startOf(store::sessionId(plan_->name, code, *ordinal, plan_->seed), code, *ordinal, clockNow(), apparatus);
        const auto trials = session::planTrials(*plan_, place, code, part);
        if (!trials) return trials.errors();
        auto writer = store_.createSession(start, *trials);
        if (!writer) return writer.errors();
        return perform({plan_, *trials, code, plan_->seed, measured(), *ordinal, options_.wait}, apparatus, **writer);
    }

    Result<RunEnd> perform(session::SessionSetup setup, LoopApparatus& apparatus, session::TrialSink& sink) {
        const std::string code = setup.participant;
        SimulatedAnswers simulated(*plan_, code);
        setup.answers = options_.answers != nullptr ? options_.answers : &simulated;
        // In virtual time nobody can say when a trial begins and ends.
        const bool simulates =
            kind() == plan::ParticipantKind::Simulated && (options_.answers == nullptr || !measured());
        SimulatedReader reader;
        setup.reader = options_.reader != nullptr ? options_.reader : &reader;
        if (kind() != plan::ParticipantKind::Simulated) {
            setup.answers = options_.performer->answers();
            setup.reader = options_.performer->reader();
        }
        setup.shown = options_.performer != nullptr && !options_.performer->screens().empty();
        setup.language = options_.language;
        if (measured())
            setup.calibrated_utc = [](const std::string& device) {
                const auto when = calibratedAt(device);
                return when ? store::UtcClock::wall(*when).at(0) : std::string();
            };
        SimulatedTimer timer(person::personOf(plan_->name, code, plan_->seed));
        if (simulates) setup.timer = &timer;  // else somebody is there to say it
        if (options_.log != nullptr) options_.log->tell(sessionText(setup, apparatus.device()));
        if (options_.performer != nullptr) options_.performer->begins(apparatus, setup);
        struct Over {  // whatever is thrown: before the apparatus goes
            Performer* performer;
            ~Over() {
                if (performer != nullptr) performer->over();
            }
        } const over{options_.performer};
        LoggedSink logged_sink(sink, options_.log);
        apparatus.rearm();
        session::Session session(std::move(setup), apparatus, logged_sink, listener_);
        conduct(session, apparatus);
        if (session.state() == session::SessionState::Failed) return session.errors();
        if (session.state() == session::SessionState::Interrupted) return RunEnd::Interrupted;
        listener_(session::SessionOver{code, session.isWhole()});
        return RunEnd::Complete;
    }

    /// Until it is over: commands, then a step; while it waits, commands only.
    void conduct(session::Session& session, LoopApparatus& apparatus) {
        auto commands = CommandSocket::listen(options_.database, [&apparatus] { apparatus.halt(); });
        if (!commands && options_.warns) listener_(session::Warned{toString(commands.errors().front())});
        const std::int64_t began = unixMilliseconds();
        auto told = session::SessionState::BetweenTrials;
        while (!session.isOver()) {
            const auto state = session.state();
            const bool waits = state == session::SessionState::Ready || state == session::SessionState::Paused;
            if (waits && told != state) {
                session::SessionWaits event{session.view(), ""};
                if (const std::string& device = event.view.awaited_device; !device.empty())
                    event.advice = calibrationAdvice(device, plan_->stable_stiffness, began);
                else
                    event.advice = apparatus.deviceNotReady(false);
                listener_(event);
            }
            told = state;
            if (commands)
                (*commands)->serve([&](const session::Command& c) { return session.command(c); }, waits);
            else if (waits)
                std::this_thread::sleep_for(CommandSocket::kServeWait);
            if (options_.performer != nullptr) options_.performer->betweenSteps(session);
            if (options_.interrupted && options_.interrupted())
                session.interrupt("interrupted");
            else
                session.advance();
        }
    }

    plan::FrozenPlan plan_;
    const RunOptions& options_;
    const session::SessionListener& listener_;
    store::Store& store_;
    std::string sha256_;
    UnitRack& rack_;
    std::optional<LoopApparatus> apparatus_;
};

store::Store::Opened openForRun(const RunOptions& options, const session::SessionListener& listener,
                                bool create = true) {
    auto with = openOptionsNow(options.now());
    with.create = create;
    with.group = options.group;
    with.station = options.station;
    auto opened = store::Store::open(options.database, with);
    if (options.log != nullptr) {
        if (opened.store) options.log->begin();
        options.log->tell(openingText(opened.outcome));
    }
    if (!opened.store) return opened;
    if (const auto& left = opened.recovery; !left.empty())
        listener(session::RecoveredCrash{left.crashed_attempts, left.crashed_sessions});
    if (options.warns && !opened.recovery.later_utc.empty())
        listener(session::Warned{"this machine's clock is behind: the database holds the time " +
                                 opened.recovery.later_utc +
                                 "; orders and durations do not depend on it, stored dates will"});
    return opened;
}

/// What is kept for the session, its questionnaires as the protocol was imported with them, whatever became of their
/// files.
Result<KeptPlan> keptFor(const store::Unfinished& session, const store::StoreReader& reader,
                         const plan::StudyPlan& draft) {
    auto kept = keptPlan(reader, session.protocol_sha256);
    if (!kept) return kept;
    auto texts = reader.questionnaireTexts(session.protocol_sha256);
    if (!texts) return texts.errors();
    const auto folder = std::filesystem::path(draft.source_path).parent_path();
    kept->questionnaires = [folder, texts = *std::move(texts)](const std::string& path) -> Result<std::string> {
        for (const auto& [file, text] : texts)
            if ((folder / file).string() == path) return text;
        return Error{.message = "is not stored with the protocol"};
    };
    kept->language = session.language;
    return kept;
}

void backUp(store::Store& store, const RunOptions& options, const session::SessionListener& listener) {
    if (!options.backup) return;
    const auto kept = store.backup();
    if (!kept && options.log != nullptr) options.log->fail("no backup", kept.errors());
    if (!options.warns) return;
    if (!kept)
        listener(session::Warned{"no backup copy was made: " + kept.errors().front().message});
    else if (!kept->empty())
        listener(session::Warned{
            "the earlier backup has what the database lacks or has damaged (passung verify): kept as " + *kept});
}

bool isPerson(const std::string& code) {
    const auto kind = plan::kindOfCode(code);
    return kind && *kind != plan::ParticipantKind::Simulated;
}

/// Somebody takes part, whoever the code or the performer says.
bool isForPerson(const std::string& code, const RunOptions& options) {
    return isPerson(code) ||
           (options.performer != nullptr && options.performer->kind() != plan::ParticipantKind::Simulated);
}

/// Nobody is there to take part under this code: a person needs a device that a person can move.
bool lacksDevice(const std::string& code, const RunOptions& options) {
    if (!isPerson(code)) return false;
    if (options.performer == nullptr) return !options.real.anyReal();
    return options.performer->kind() != plan::kindOfCode(code);
}

/// Why nobody but a simulated participant can run the plan here under this code; empty: somebody can, or is simulated.
Errors whyNotPeople(const plan::StudyPlan& plan, const std::string& code, const RunOptions& options) {
    Errors why;
    if (isForPerson(code, options)) why = missingOutputs(plan, code.empty() ? "a person" : code);
    if (lacksDevice(code, options))
        for (Error& missing : missingDevices(plan, code)) why.push_back(std::move(missing));
    return why;
}

/// The station's real devices, if a person takes part who holds them. Errors: one is not there, or none for this plan.
Result<UnitRack> rackFor(const plan::StudyPlan& plan, const std::string& code, const RunOptions& options) {
    if (!isForPerson(code, options) || !options.real.anyReal()) return UnitRack{};
    if (options.clock != Clock::RealTime)
        return Error{.message = "real devices run in real time: add --real-time", .file = options.real.file};
    auto rack = UnitRack::open(options.real.devices, options.real.file);
    if (!rack) return rack;
    if (Errors why = rack->whyNot(plan); !why.empty()) return why;
    return rack;
}

/// Elsewhere the session would take a slot that is not its station's.
Error otherStation(const store::Unfinished& session, const RunOptions& options) {
    const bool only = session.station == store::Station{}.name;
    return Error{.message = fmt::format("{}, session {}: {}", session.participant, session.ordinal,
                                        only ? "ran without --station: resume it without"
                                             : "ran at station " + session.station + ": name --station " +
                                                   session.station + " and --stations, as for run"),
                 .file = options.database};
}

Result<RunEnd> runSessions(const plan::StudyPlan& draft, RunOptions options, const session::SessionListener& listener) {
    if (Errors why = whyNotPeople(draft, options.participant, options); !why.empty()) return why;
    if (Errors unstable = beyondBorder(draft, knownDevices()); !unstable.empty()) return unstable;
    const auto language = plan::chooseLanguage(draft, options.language);
    if (!language) return language.errors();
    options.language = *language;
    auto rack = rackFor(draft, options.participant, options);
    if (!rack) return rack.errors();
    std::optional<AtDevice> at_device;
    if (!rack->empty() && options.performer == nullptr)
        options.performer = &at_device.emplace(*plan::kindOfCode(options.participant), options.answers, options.reader);
    // A calibration that fails must leave nothing behind: neither a new database nor the protocol in an old one.
    std::vector<store::AccuracyRow> measured;
    const auto measure = [&]() -> Result<Done> {
        const auto builds = openBuilds(options.import_limits, options.told);
        const auto report = [&](const std::string& step, double share) {
            listener(session::MeasuringAccuracy{step, share});
        };
        auto rows = measureAccuracy(draft, sha256Hex(draft.source_text), report, builds.get());
        if (!rows) return rows.errors();
        measured = std::move(*rows);
        return Done{};
    };
    const bool calibrates = asksForAccuracy(draft);
    std::error_code none;
    if (calibrates && !std::filesystem::exists(options.database, none))
        if (const auto done = measure(); !done) return done.errors();
    auto opened = openForRun(options, listener);
    if (!opened.store) return opened.errors;
    if (calibrates && measured.empty()) {
        const auto known = opened.store->checkProtocol(draft, options.choice);
        if (!known) return known.errors();
        const auto there = opened.store->accuracy(*known);
        if (!there) return there.errors();
        if (there->empty())
            if (const auto done = measure(); !done) return done.errors();
    }
    auto sha256 = opened.store->importProtocol(draft, options.choice);
    if (!sha256) return sha256.errors();
    if (!measured.empty()) {
        if (const auto done = opened.store->keepAccuracy(measured); !done) return done.errors();
        listener(session::PickedAccuracy{describePick(measured)});
    }
    const auto kept = opened.store->accuracy(*sha256);
    if (!kept) return kept.errors();
    if (options.clock == Clock::RealTime && options.warns && !kept->empty()) {
        const auto builds = openBuilds(options.import_limits, options.told);
        const auto slow = tooSlowHere(draft, *kept, builds.get());
        if (!slow) return slow.errors();
        for (const std::string& what : *slow) listener(session::Warned{what});
    }
    const auto stable = opened.store->stableStiffness(*sha256);
    if (!stable) return stable.errors();
    const auto geometry = opened.store->contactGeometry(*sha256);
    if (!geometry) return geometry.errors();
    const auto plan = freeze(draft, {*sha256, *stable, *kept, *geometry, readFile, options.language}, options.choice,
                             options.import_limits);
    if (!plan) return plan.errors();
    if (options.warns)
        for (const std::string& difference : stiffnessDifferences(draft.stable_stiffness, (*plan)->stable_stiffness))
            listener(session::Warned{difference});
    if (Errors unstable = beyondBorder(**plan, knownDevices()); !unstable.empty()) return unstable;
    StudyRun run(*plan, options, listener, *opened.store, *sha256, *rack);
    Result<RunEnd> end = RunEnd::Complete;
    for (int i = 0; i < options.simulated && end && *end == RunEnd::Complete; ++i) end = run.participant(i + 1);
    backUp(*opened.store, options, listener);
    return end;
}

Result<RunEnd> resumeSession(const ResumeOptions& resume, RunOptions options,
                             const session::SessionListener& listener) {
    auto opened = openForRun(options, listener, false);
    if (!opened.store) return opened.errors;
    const auto session = opened.store->unfinished(resume.session);
    if (!session) return session.errors();
    if (session->station != options.station.name) return otherStation(*session, options);
    const auto reader = store::StoreReader::open(options.database);
    if (!reader) return reader.errors();
    StoredPlans plans(*reader, resume.meshes, options.import_limits);
    const auto draft = plans.draft(session->protocol_sha256);
    if (!draft) return draft.errors();
    const auto kept = keptFor(*session, *reader, *draft);
    if (!kept) return kept.errors();
    const auto plan = freeze(*draft, *kept, {.seed = session->seed}, options.import_limits);
    if (!plan) return plan.errors();
    if (Errors why = whyNotPeople(**plan, session->participant, options); !why.empty()) return why;
    if (Errors unstable = beyondBorder(**plan, knownDevices()); !unstable.empty()) return unstable;
    options.clock = session->virtual_time ? Clock::Virtual : Clock::RealTime;
    options.language = session->language;
    auto rack = rackFor(**plan, session->participant, options);
    if (!rack) return rack.errors();
    std::optional<AtDevice> at_device;
    if (!rack->empty() && options.performer == nullptr)
        options.performer =
            &at_device.emplace(*plan::kindOfCode(session->participant), options.answers, options.reader);
    StudyRun run(*plan, options, listener, *opened.store, session->protocol_sha256, *rack);
    const auto end = run.resume(*session);
    backUp(*opened.store, options, listener);
    return end;
}

void logStart(const RunOptions& options, const std::string& what) {
    if (options.log == nullptr) return;
    for (const std::string& who : {options.participant, options.experimenter}) options.log->leaveOut(who);
    options.log->tell(what);
}

}  // namespace

Result<RunEnd> runStudy(const plan::StudyPlan& draft, RunOptions options, const session::SessionListener& listener) {
    logStart(options, "run of protocol " + sha256Hex(draft.source_text));
    return logged(options.log, listener,
                  [&](const session::SessionListener& with) { return runSessions(draft, options, with); });
}

Result<RunEnd> resumeStudy(const ResumeOptions& resume, RunOptions options, const session::SessionListener& listener) {
    logStart(options, "resumption");
    return logged(options.log, listener,
                  [&](const session::SessionListener& with) { return resumeSession(resume, options, with); });
}

}  // namespace passung::run
