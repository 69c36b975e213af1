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
void acknowledge(int fd, session::AttemptId attempt, measures::Outcome outcome) {
    const std::string line = fmt::format("{} {}\n", static_cast<std::int64_t>(attempt), measures::outcomeName(outcome));
    if (write(fd, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
        std::fprintf(stderr, "warning: the acknowledgement of attempt %lld was not taken\n",
                     static_cast<long long>(attempt));
    }
}

void tellRecovery(const std::string& database, const store::RecoveryReport& report) {
    for (const auto& attempt : report.crashed_attempts) {
        fmt::print("{}: {}: was running when an earlier run was killed; kept and marked as crashed\n", database,
                   attempt);
    }
    for (const auto& session : report.crashed_sessions) {
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
app::StudyLog logOf(const std::string& database) {
    return {database, "passung", [database](const std::string& problem) { warn(database, {problem}); }};
}

using Perform = std::function<Result<app::RunEnd>(const app::RunOptions&, const app::RunListener&)>;

/// Lets `go` perform sessions and tells of them; `study` is the file that warnings are about, `answers` who answers
/// questionnaires.
int tell(const std::string& study, app::RunOptions what, int acknowledge_fd, const std::string& answers,
         const Perform& go) {
    listenForSignals();
    Terminal terminal;
    TerminalAnswers at_terminal(terminal, answers);
    TerminalReader pages(terminal, answers);
    what.interrupted = [&terminal] { return stop_asked != 0 || terminal.ended(); };
    if (answers != "simulated") {
        what.answers = &at_terminal;
        what.reader = &pages;
        what.ask_consent = [&](const protocol::ConsentClause& clause, const std::string& text) {
            return askConsent(terminal, what.interrupted, clause, text);
        };
    }
    app::StudyLog log = logOf(what.database);
    what.log = &log;
    std::string code, participant;
    std::set<std::int64_t> succeeded;  // trials, by the last attempt at each
    std::size_t finished = 0, planned = 0, earlier = 0, invalid = 0;
    ProgressLine progress;
    app::RunListener listener;
    listener.recovered = [&](const store::RecoveryReport& report) { tellRecovery(what.database, report); };
    listener.calibrating = [&](const std::string& step, double share) { progress.show(progressBar(step, share)); };
    listener.calibrated = [&](const std::string& picked) {
        progress.show("");
        fmt::print("accuracy = \"auto\": measured on this machine, kept in {} for the whole study\n{}\n", what.database,
                   picked);
    };
    listener.warned = [&](const std::string& warning) { warn(study, {warning}); };
    listener.session = [&](const std::string& who, int number, int of) {
        code = who;
        participant = fmt::format("{} ({} of {})", code, number, of);
        progress.show(participant + ": preparing");
        succeeded.clear();
        finished = planned = earlier = invalid = 0;
    };
    listener.resumed = [&](const session::Resumption& resumed) {
        finished = earlier = resumed.agenda.finished();
        planned = resumed.agenda.planned() - resumed.agenda.leftOut();
        for (const session::EarlierTrial& trial : resumed.earlier)
            if (trial.succeeded()) succeeded.insert(resumed.agenda.trial(trial.place).trial_index);
    };
    listener.trial = [&](const session::TrialProgress& trial) {
        finished = trial.finished;
        planned = trial.planned;
        const bool counts = trial.valid && trial.outcome != measures::Outcome::Aborted;
        succeeded.erase(trial.trial.trial_index);
        if (counts && trial.outcome == measures::Outcome::Success) succeeded.insert(trial.trial.trial_index);
        invalid += counts ? 0 : 1;
        progress.show(
            fmt::format("{}: trial {} of {}, {} succeeded", participant, finished, trial.planned, succeeded.size()));
    };
    listener.waits = [&](const session::SessionView& view, const std::string& advice) {
        progress.show("");
        if (!view.awaited_device.empty())
            fmt::print("{}: the next trial is on {}: put it in place{}{}\n", participant, view.awaited_device,
                       advice.empty() ? "" : "; ", advice);
        fmt::print("{}: {}\n", participant,
                   view.permission(session::CommandKind::Start).given() ? "waits for `passung session start`"
                                                                        : "paused; `passung session continue` goes on");
        std::fflush(stdout);
    };
    listener.session_over = [&](const std::string&, bool whole) {
        progress.show("");
        fmt::print("{}: {} trials{}, {} succeeded{}\n", participant, planned,
                   earlier == 0 ? "" : fmt::format(", {} of them earlier", earlier), succeeded.size(),
                   invalid == 0 ? "" : fmt::format(", {} invalid", invalid));
        if (!whole) {
            fmt::print("{}: the session is not complete; its place in the design is free again\n", participant);
        }
        std::fflush(stdout);
        succeeded.clear();
        finished = planned = earlier = invalid = 0;  // of the participant's next session
    };
    if (acknowledge_fd >= 0) {
        listener.acknowledge = [&](session::AttemptId attempt, measures::Outcome outcome) {
            acknowledge(acknowledge_fd, attempt, outcome);
        };
    }
    const auto end = go(what, listener);
    if (!end) return fail(end.errors());
    if (*end == app::RunEnd::Interrupted) {
        progress.show("");
        return fail({{.message = fmt::format(
                          "interrupted: {} trials of {} are finished; the running one and the session are "
                          "stored as aborted; `passung resume` goes on with it. Its place in the design is free "
                          "again: `passung run` with --participant {} begins a new session of all trials",
                          finished, planned, code),
                      .file = what.database}});
    }

    const auto reader = store::StoreReader::open(what.database);
    if (!reader) return fail(reader.errors());
    const auto table = exporter::summaryTable(*reader);
    if (!table) return fail(table.errors());
    fmt::print("\n{}", *table);
    return 0;
}

}  // namespace

int run(const RunOptions& options) {
    auto plan = app::readProtocol(options.protocol, options.import_limits);
    if (!plan) {
        if (!options.database.empty()) logOf(options.database).fail("protocol refused", plan.errors());
        return fail(plan.errors());
    }
    warn(options.protocol, session::planWarnings(*plan));
    if (options.seed) plan->seed = *options.seed;

    app::RunOptions what;
    what.database = options.database.empty() ? plan->name + ".db" : options.database;
    what.participant = options.participant;
    what.simulated = options.participant.empty() ? options.simulated : 1;
    const auto station = stationOf(options.station);
    if (!station) return fail(station.errors());
    what.station = *station;
    what.backup = !options.no_backup;
    what.group = options.group;
    what.wait = options.wait;
    what.clock = options.real_time ? app::Clock::RealTime : app::Clock::Virtual;

    what.language = options.language;
    what.import_limits = options.import_limits;
    return tell(options.protocol, what, options.acknowledge_fd, options.answers,
                [&](const auto& with, const auto& listener) { return app::runStudy(*plan, with, listener); });
}

int resume(const ResumeOptions& options) {
    app::RunOptions what;
    what.database = options.database;
    const auto station = stationOf(options.station);
    if (!station) return fail(station.errors());
    what.station = *station;
    what.backup = !options.no_backup;
    what.import_limits = options.import_limits;
    return tell(options.database, what, options.acknowledge_fd, options.answers,
                [&](const auto& with, const auto& listener) {
                    return app::resumeStudy({options.session, options.meshes}, with, listener);
                });
}

}  // namespace passung::cli
