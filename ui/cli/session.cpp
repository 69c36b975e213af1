#include <fmt/format.h>

#include "study/run/command_socket.h"
#include "study/run/files/wall_clock.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

using session::Command;
using session::CommandKind;

/// No session runs: what concerns finished attempts is possible all the same.
int tellDatabase(const std::string& database, const Command& command) {
    const bool note = command.kind == CommandKind::Note;
    if (!note && (command.kind != CommandKind::Invalidate || !command.attempt)) {
        const char* what = command.kind == CommandKind::Invalidate ? ": which --attempt is meant?" : "";
        return fail({{.message = fmt::format("no session runs on it{}", what), .file = database}});
    }
    auto with = run::openOptionsNow();
    with.create = false;
    auto opened = store::Store::open(database, with);
    if (!opened.store) return fail(opened.errors);
    const auto attempt = command.attempt ? static_cast<std::int64_t>(*command.attempt) : 0;
    const auto done =
        note ? opened.store->addNote(attempt, command.text) : opened.store->invalidateAttempt(attempt, command.text);
    if (!done) return fail(done.errors());
    fmt::print("{}\n", note ? "noted" : fmt::format("attempt {} no longer counts", attempt));
    return 0;
}

}  // namespace

int tellSession(const SessionArguments& options) {
    Command command;
    command.kind =
        session::commandNamed(options.action).value_or(CommandKind::Note);  // the command line has checked it
    command.text = options.text;
    if (options.attempt > 0) command.attempt = session::AttemptId{options.attempt};
    if (session::needsText(command.kind) && command.text.empty())
        return fail({{.message = "needs a text: --text", .file = options.database, .key = options.action}});

    const auto answer = run::tellSession(options.database, command);
    if (!answer) return fail(answer.errors());
    if (!*answer) return tellDatabase(options.database, command);
    if (!(*answer)->accepted)
        return fail({{.message = (*answer)->text, .file = options.database, .key = options.action}});
    fmt::print("{}\n", (*answer)->text);
    return 0;
}

}  // namespace passung::cli
