#include <fmt/format.h>

#include "ui/cli/commands.h"
#include "ui/cli/other_program.h"

namespace passung::cli {

int feasible(const FeasibleArguments& options) {
    const char* form = options.json ? "json" : options.keys ? "keys" : "table";
    return becomeProgram(
        {"passung-feasible", "`./dev build passung-feasible` makes it (needs Debian's libompl-dev)"},
        {options.protocol, form, options.out, std::to_string(options.seed), fmt::format("{}", options.seconds),
         fmt::format("{}", options.import_limits.processor_s), std::to_string(options.import_limits.memory)});
}

}  // namespace passung::cli
