#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <set>

#include "analysis/export/summary.h"
#include "study/run/files/protocol_files.h"
#include "study/run/machine/stability_report.h"
#include "study/run/run_study.h"
#include "study/session/plan_text.h"
#include "study/store/read/store_reader.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/station.h"
#include "ui/cli/terminal.h"

namespace passung::cli {

namespace {

/// One line per durable attempt to whoever started the program, in one write so that lines never mix.
void acknowledge(int fd, const session::AttemptEnded& ended) {
    const auto attempt = static_cast<std::int64_t>(ended.id);
    const std::string line = fmt::format("{} {}\n", attempt, measures::outcomeName(ended.outcome));
    if (write(fd, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
        std::fprintf(stderr, "warning: the acknowledgement of attempt %lld was not taken\n",
                     static_cast<long long>(attempt));
    }
}

void tellRecovery(const std::string& database, const session::RecoveredCrash& left) {
    for (const auto& attempt : left.attempts) {
        fmt::print("{}: {}: was running when an earlier run was killed; kept and marked as crashed\n", database,
                   attempt);
    }
    for (const auto& session : left.sessions) {
        fmt::print("{}: {}: ended with an earlier run that was killed; marked as crashed\n", database, session);
    }
    std::fflush(stdout);  // it is said only once: it must not be lost if this run is killed too
}

volatile std::sig_atomic_t stop_asked = 0;

/// The first SIGINT or SIGTERM asks the run to end; a second one of its kind ends the program at once.
void listenForSignals() {
    struct sigaction action {};
    action.sa_handler = [](int) { stop_asked = 1; };
    action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

/// What cannot be logged is warned of.
run::StudyLog logOf(const std::string& database) {
    return {database, "passung", [database](const std::string& problem) { warn(database, {problem}); }};
}

/// Tells of a run while it goes on, and counts what it has told.
class RunTeller {
public:
    /// `study`: the file that warnings are about; `acknowledge_fd` below 0: nobody waits for acknowledgements.
    RunTeller(std::string study, std::string database, int acknowledge_fd)
        : study_(std::move(study)), database_(std::move(database)), acknowledge_fd_(acknowledge_fd) {}

    void operator()(const session::RecoveredCrash& left) { tellRecovery(database_, left); }
    void operator()(const session::MeasuringAccuracy& now) { progress_.show(progressBar(now.step, now.share)); }
    void operator()(const session::PickedAccuracy& picked) {
        progress_.show("");
        fmt::print("accuracy = \"auto\": measured on this machine, kept in {} for the whole study\n{}\n", database_,
                   picked.text);
    }
    void operator()(const session::Warned& warned) { warn(study_, {warned.text}); }
    void operator()(const session::ParticipantBegins& begins) {
        code_ = begins.participant;
        participant_ = fmt::format("{} ({} of {})", code_, begins.number, begins.planned);
        progress_.show(participant_ + ": preparing");
        count_ = {};
    }
    void operator()(const session::Resumption& resumed) {
        count_.finished = count_.earlier = resumed.agenda.finished();
        count_.planned = resumed.agenda.planned() - resumed.agenda.leftOut();
        for (const session::EarlierTrial& trial : resumed.earlier)
            if (trial.succeeded()) count_.succeeded.insert(resumed.agenda.trial(trial.place).trial_index);
    }
    void operator()(const session::SessionView&) {}
    /// Told by the run's own thread and by those that build for it meanwhile.
    void operator()(const scene::BuildStep& step) {
        progress_.show((participant_.empty() ? "" : participant_ + ": ") + buildWords(step));
    }
    void operator()(const session::AttemptEnded& ended) {
        if (acknowledge_fd_ >= 0) acknowledge(acknowledge_fd_, ended);
        count_.finished = ended.finished;
        count_.planned = ended.planned;
        const bool counts = ended.valid && ended.outcome != measures::Outcome::Aborted;
        count_.succeeded.erase(ended.trial_index);
        if (counts && ended.outcome == measures::Outcome::Success) count_.succeeded.insert(ended.trial_index);
        count_.invalid += counts ? 0 : 1;
        progress_.show(fmt::format("{}: trial {} of {}, {} succeeded", participant_, ended.finished, ended.planned,
                                   count_.succeeded.size()));
    }
    void operator()(const session::SessionWaits& waits) {
        progress_.show("");
        const std::string& device = waits.view.awaited_device;
        if (device.empty() && !waits.advice.empty()) fmt::print("{}: {}\n", participant_, waits.advice);
        if (!device.empty())
            fmt::print("{}: the next trial is on {}: put it in place{}{}\n", participant_, device,
                       waits.advice.empty() ? "" : "; ", waits.advice);
        fmt::print("{}: {}\n", participant_,
                   waits.view.permission(session::CommandKind::Start).given()
                       ? "waits for `passung session start`"
                       : "paused; `passung session continue` goes on");
        std::fflush(stdout);
    }
    void operator()(const session::SessionOver& over) {
        progress_.show("");
        fmt::print("{}: {} trials{}, {} succeeded{}\n", participant_, count_.planned,
                   count_.earlier == 0 ? "" : fmt::format(", {} of them earlier", count_.earlier),
                   count_.succeeded.size(), count_.invalid == 0 ? "" : fmt::format(", {} invalid", count_.invalid));
        if (!over.whole) fmt::print("{}: the session is not complete; its slot is free again\n", participant_);
        std::fflush(stdout);
        count_ = {};  // of the participant's next session
    }

    /// The run was interrupted: what is done of it, and how it goes on.
    std::string interruption() {
        progress_.show("");
        return fmt::format(
            "interrupted: {} trials of {} are finished; the running one and the session are stored as aborted; "
            "`passung resume` goes on with it. Its slot is free again: `passung run` with --participant "
            "{} begins a new session of all trials",
            count_.finished, count_.planned, code_);
    }

private:
    struct Count {                         // of a session's trials
        std::set<std::int64_t> succeeded;  // by the last attempt at each
        std::size_t finished = 0, planned = 0, earlier = 0, invalid = 0;
    };

    std::string study_, database_;
    int acknowledge_fd_;
    std::string code_, participant_;
    Count count_;
    ProgressLine progress_;
};

using PerformSessions = std::function<Result<run::RunEnd>(const run::RunOptions&, const session::SessionListener&)>;

/// Lets `go` perform sessions and tells of them; `study` is the file that warnings are about, `answers` who answers
/// questionnaires.
int tell(const std::string& study, run::RunOptions what, int acknowledge_fd, const std::string& answers,
         const PerformSessions& go) {
    listenForSignals();
    Terminal terminal;
    TerminalAnswers at_terminal(terminal, answers);
    TerminalReader pages(terminal, answers);
    what.interrupted = [&terminal] { return stop_asked != 0 || terminal.ended(); };
    if (answers != "simulated") {
        what.answers = &at_terminal;
        what.reader = &pages;
        what.ask_consent = [&](const plan::ConsentClause& clause, const std::string& text) {
            return askConsent(terminal, what.interrupted, clause, text);
        };
    }
    run::StudyLog log = logOf(what.database);
    what.log = &log;
    what.warns = true;
    RunTeller teller(study, what.database, acknowledge_fd);
    what.told = [&teller](const scene::BuildStep& step) { teller(step); };
    const auto end = go(what, [&teller](const session::SessionEvent& event) { std::visit(teller, event); });
    if (!end) return fail(end.errors());
    if (*end == run::RunEnd::Interrupted) return fail({{.message = teller.interruption(), .file = what.database}});

    const auto reader = store::StoreReader::open(what.database);
    if (!reader) return fail(reader.errors());
    const auto table = exporter::summaryTable(*reader);
    if (!table) return fail(table.errors());
    fmt::print("\n{}", *table);
    return 0;
}

}  // namespace

int run(const RunArguments& options) {
    ProgressLine progress;
    auto plan = progress.whileReading(options.protocol,
                                      [&] { return run::readProtocol(options.protocol, options.import_limits); });
    if (!plan) {
        if (!options.database.empty()) logOf(options.database).fail("protocol refused", plan.errors());
        return fail(plan.errors());
    }
    warn(options.protocol, session::planWarnings(*plan));

    run::RunOptions what;
    what.database = options.database.empty() ? plan->name + ".db" : options.database;
    what.participant = options.participant;
    what.simulated = options.participant.empty() ? options.simulated : 1;
    const auto station = stationOf(options.station);
    if (!station) return fail(station.errors());
    what.station = *station;
    what.backup = !options.no_backup;
    what.group = options.group;
    what.wait = options.wait;
    what.choice.seed = options.seed;
    what.clock = options.real_time ? run::Clock::RealTime : run::Clock::Virtual;

    what.language = options.language;
    what.import_limits = options.import_limits;
    auto real = run::stationDevices(options.station_file);
    if (!real) return fail(real.errors());
    what.real = *std::move(real);
    return tell(options.protocol, what, options.acknowledge_fd, options.answers,
                [&](const auto& with, const auto& listener) { return run::runStudy(*plan, with, listener); });
}

int resume(const ResumeArguments& options) {
    run::RunOptions what;
    what.database = options.database;
    const auto station = stationOf(options.station);
    if (!station) return fail(station.errors());
    what.station = *station;
    what.backup = !options.no_backup;
    what.import_limits = options.import_limits;
    auto real = run::stationDevices(options.station_file);
    if (!real) return fail(real.errors());
    what.real = *std::move(real);
    return tell(options.database, what, options.acknowledge_fd, options.answers,
                [&](const auto& with, const auto& listener) {
                    return run::resumeStudy({options.session, options.meshes}, with, listener);
                });
}

}  // namespace passung::cli
