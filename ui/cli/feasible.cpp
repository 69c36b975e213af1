#include <fmt/format.h>

#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/other_program.h"

namespace passung::cli {

int feasible(const FeasibleArguments& options) {
    const auto program = findOtherProgram("passung-feasible");
    if (program.empty())
        return fail({{.message = "the program passung-feasible is neither beside this one nor in build/release; "
                                 "`./dev build passung-feasible` makes it (needs Debian's libompl-dev)"}});
    return fail(becomeProgram(
        program, {options.protocol,
                  options.json   ? "json"
                  : options.keys ? "keys"
                                 : "table",
                  options.out, std::to_string(options.seed), fmt::format("{}", options.seconds),
                  fmt::format("{}", options.import_limits.processor_s), std::to_string(options.import_limits.memory)}));
}

}  // namespace passung::cli
