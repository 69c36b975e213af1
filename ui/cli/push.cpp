#include "study/store/push.h"

#include <fmt/format.h>

#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

int push(const PushOptions& options) {
    const auto report = store::pushDatabase(options.database, options.to);
    if (!report) return fail(report.errors());
    for (const std::string& session : report->unfinished)
        fmt::print("{}: left out: it runs, or was killed and its database not opened since\n", session);
    fmt::print("{}: {} sessions added, {} brought up to date, {} known\n", options.database, report->sessions,
               report->replaced, report->known);
    return 0;
}

}  // namespace passung::cli
