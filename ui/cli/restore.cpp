#include "study/store/transfer/restore.h"

#include <fmt/format.h>

#include "study/run/files/wall_clock.h"
#include "study/store/postgres/pull.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

int restore(const RestoreArguments& options) {
    const auto report =
        store::restoreDatabase(options.database, options.from, run::openOptionsNow(), store::pullSessions);
    if (!report) return fail(report.errors());
    for (const std::string& healed : report->healed) fmt::print("{}: {}: healed\n", options.database, healed);
    const std::string none = report->anew ? "" : ": there is no intact copy of it in " + options.from;
    for (const std::string& damage : report->remaining)
        fmt::print(stderr, "{}: error: {}{}\n", options.database, damage, none);
    for (const std::string& line : report->told) fmt::print("{}\n", line);
    if (report->anew)
        fmt::print("{}: its pages were damaged: made anew from {}; the damaged file is {}\n", options.database,
                   options.from, report->kept);
    else if (report->healed.empty())
        fmt::print("{}: {}nothing was changed\n", options.database,
                   report->remaining.empty() ? "nothing is damaged, " : "");
    return report->remaining.empty() ? 0 : 1;
}

}  // namespace passung::cli
