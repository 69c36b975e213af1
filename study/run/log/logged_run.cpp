#include "study/run/log/logged_run.h"

#include <fmt/format.h>

namespace passung::app {

namespace {

/// `listener` and, before it, the log. Codes and outcomes stay out.
RunListener listensToo(StudyLog& log, const RunListener& listener) {
    RunListener both = listener;
    both.recovered = [&](const store::RecoveryReport& report) {
        log.warn(fmt::format("an earlier run was cut off: {} attempts, {} sessions", report.crashed_attempts.size(),
                             report.crashed_sessions.size()));
        if (listener.recovered) listener.recovered(report);
    };
    both.calibrated = [&](const std::string& picked) {
        log.tell("accuracy measured and kept");
        if (listener.calibrated) listener.calibrated(picked);
    };
    if (listener.warned)  // what nobody hears of is not looked for
        both.warned = [&](const std::string& warning) {
            log.warn(warning);
            listener.warned(warning);
        };
    both.session = [&](const std::string& participant, int number, int of) {
        log.tell(fmt::format("participant {} of {}", number, of));
        if (listener.session) listener.session(participant, number, of);
    };
    both.resumed = [&](const session::Resumption& resumed) {
        log.tell(fmt::format("session resumed: {} of {} trials are finished", resumed.agenda.finished(),
                             resumed.agenda.planned()));
        if (listener.resumed) listener.resumed(resumed);
    };
    both.waits = [&](const session::SessionView& view, const std::string& advice) {
        if (!view.awaited_device.empty()) log.tell(fmt::format("device {} is to be put in place", view.awaited_device));
        log.tell(view.state == session::SessionState::Ready ? "session ready" : "session paused");
        if (listener.waits) listener.waits(view, advice);
    };
    both.session_over = [&](const std::string& participant, bool whole) {
        log.tell(whole ? "session complete" : "session over, not complete");
        if (listener.session_over) listener.session_over(participant, whole);
    };
    return both;
}

}  // namespace

Result<RunEnd> logged(StudyLog* log, const RunListener& listener,
                      const std::function<Result<RunEnd>(const RunListener&)>& perform) {
    if (log == nullptr) return perform(listener);
    try {
        const auto end = perform(listensToo(*log, listener));
        if (!end)
            log->fail("run failed", end.errors());
        else
            log->tell(*end == RunEnd::Complete ? "run complete" : "run interrupted");
        return end;
    } catch (const std::exception& thrown) {
        log->fail("run failed", {{.message = thrown.what()}});
        throw;
    }
}

}  // namespace passung::app
