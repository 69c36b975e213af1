#include "ui/cli/restore_report.h"

#include <fmt/format.h>

namespace passung::cli {

int tellRestore(const std::string& database, const std::string& from, const store::RestoreReport& report) {
    for (const std::string& healed : report.healed) fmt::print("{}: {}: healed\n", database, healed);
    const std::string none = report.anew ? "" : ": there is no intact copy of it in " + from;
    for (const std::string& damage : report.remaining) fmt::print(stderr, "{}: error: {}{}\n", database, damage, none);
    for (const std::string& line : report.told) fmt::print("{}\n", line);
    if (report.anew)
        fmt::print("{}: its pages were damaged: made anew from {}; the damaged file is {}\n", database, from,
                   report.kept);
    else if (report.healed.empty())
        fmt::print("{}: {}nothing was changed\n", database, report.remaining.empty() ? "nothing is damaged, " : "");
    return report.remaining.empty() ? 0 : 1;
}

}  // namespace passung::cli
