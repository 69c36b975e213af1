#include "study/run/log/logged_run.h"

#include <fmt/format.h>

namespace passung::run {

namespace {

/// What the log is told of each event. Codes and outcomes stay out.
struct LoggedEvent {
    StudyLog& log;

    void operator()(const session::RecoveredCrash& left) const {
        log.warn(fmt::format("an earlier run was cut off: {} attempts, {} sessions", left.attempts.size(),
                             left.sessions.size()));
    }
    void operator()(const session::PickedAccuracy&) const { log.tell("accuracy measured and kept"); }
    void operator()(const session::Warned& warned) const { log.warn(warned.text); }
    void operator()(const session::ParticipantBegins& begins) const {
        log.tell(fmt::format("participant {} of {}", begins.number, begins.planned));
    }
    void operator()(const session::Resumption& resumed) const {
        log.tell(fmt::format("session resumed: {} of {} trials are finished", resumed.agenda.finished(),
                             resumed.agenda.planned()));
    }
    void operator()(const session::SessionWaits& waits) const {
        const session::SessionView& view = waits.view;
        if (!view.awaited_device.empty()) log.tell(fmt::format("device {} is to be put in place", view.awaited_device));
        log.tell(view.state == session::SessionState::Ready ? "session ready" : "session paused");
    }
    void operator()(const session::SessionOver& over) const {
        log.tell(over.whole ? "session complete" : "session over, not complete");
    }
    void operator()(const session::MeasuringAccuracy&) const {}
    void operator()(const session::SessionView&) const {}
    void operator()(const session::AttemptEnded&) const {}  // LoggedSink tells of it
};

}  // namespace

Result<RunEnd> logged(StudyLog* log, const session::SessionListener& listener,
                      const std::function<Result<RunEnd>(const session::SessionListener&)>& perform) {
    const session::SessionListener both = [&](const session::SessionEvent& event) {
        if (log != nullptr) std::visit(LoggedEvent{*log}, event);
        if (listener) listener(event);
    };
    if (log == nullptr) return perform(both);
    try {
        const auto end = perform(both);
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

}  // namespace passung::run
