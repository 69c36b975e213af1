#include "study/store/postgres/push.h"

#include <fmt/format.h>

#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

int push(const PushArguments& options) {
    const auto report = store::pushDatabase(options.database, options.to);
    if (!report) return fail(report.errors());
    for (const std::string& session : report->unfinished)
        fmt::print("{}: left out: it runs, or was killed and its database not opened since\n", session);
    for (const std::string& damage : report->damaged)
        fmt::print(stderr, "{}: error: {}: damaged here and not pushed; passung restore heals from a copy\n",
                   options.database, damage);
    for (const std::string& session : report->newer_there)
        fmt::print(stderr,
                   "{}: error: {}: not pushed: there are rows of it that this file lacks; push the newer "
                   "copy, or passung merge of both\n",
                   options.database, session);
    for (const std::string& code : report->erased_there)
        fmt::print(
            "{}: was erased here and is deleted there; VACUUM FULL takes the last bytes out of PostgreSQL's tables, "
            "not "
            "out of its backups and archived logs\n",
            code);
    for (const std::string& code : report->left_out)
        fmt::print("{}: left out: was erased there; passung participant withdraw --scope erase removes them here\n",
                   code);
    for (const std::string& people : report->shared_places)
        fmt::print("{}: have one slot; passung merge would part them\n", people);
    fmt::print("{}: {} sessions added, {} brought up to date, {} known{}\n", options.database, report->sessions,
               report->replaced, report->known,
               report->healed == 0 ? "" : fmt::format(", {} healed that were damaged there", report->healed));
    return report->newer_there.empty() && report->damaged.empty() ? 0 : 1;
}

}  // namespace passung::cli
