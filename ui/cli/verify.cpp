#include "study/store/read/verify.h"

#include <fmt/format.h>

#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

int verify(const VerifyArguments& options) {
    const auto found = store::verifyDatabase(options.database);
    if (!found) return fail(found.errors());
    for (const std::string& damage : found->damages) fmt::print(stderr, "{}: error: {}\n", options.database, damage);
    for (const std::string& name : found->not_hashed)
        fmt::print("{}: {}: not hashed (of an older program, or not over): only checksums could be compared\n",
                   options.database, name);
    fmt::print("{}: {} sessions, {} chunks of samples, {} rows of the study: {}\n", options.database, found->sessions,
               found->chunks, found->rows,
               found->damages.empty()
                   ? "nothing is damaged"
                   : fmt::format("{} damaged; passung restore heals from a copy", found->damages.size()));
    return found->damages.empty() ? 0 : 1;
}

}  // namespace passung::cli
