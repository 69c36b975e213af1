#include "study/store/transfer/merge.h"

#include <fmt/format.h>

#include "study/run/files/wall_clock.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/places.h"

namespace passung::cli {

int merge(const MergeArguments& options) {
    if (const auto fine = refuseOverwriting(options.out, options.databases); !fine) return fail(fine.errors());
    auto open = run::openOptionsNow();
    open.group = options.group;
    const auto report = store::mergeDatabases(options.databases, options.out, open);
    if (!report) return fail(report.errors());
    for (const std::string& session : report->unfinished)
        fmt::print("{}: left out: it runs, or was killed and its database not opened since\n", session);
    for (const std::string& person : report->moved_places)
        fmt::print("{}: the same row of the square in a further replicate, for another one has the slot\n", person);
    for (const std::string& person : report->erased)
        fmt::print("{}: passung participant withdraw --scope erase removes them\n", person);
    for (const std::string& healed : report->healed) fmt::print("{}: {}: healed\n", options.out, healed);
    for (const std::string& damage : report->damaged) fmt::print(stderr, "error: damaged: {}\n", damage);
    for (const std::string& conflict : report->conflicts) fmt::print("{}\n", conflict);
    fmt::print("{}: {} sessions added, {} brought up to date, {} known\n", options.out, report->sessions,
               report->replaced, report->known);
    if (const auto reader = store::StoreReader::open(options.out)) printTakenPlaces(*reader);
    return report->damaged.empty() ? 0 : 1;
}

}  // namespace passung::cli
