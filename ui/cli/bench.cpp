#include <vector>

#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/other_program.h"

namespace passung::cli {

int bench(const BenchArguments& options) {
    const auto program = findOtherProgram("passung-bench");
    if (program.empty())
        return fail(
            {{.message = "the program passung-bench is neither beside this one nor in build/release; it "
                         "links the engines we are compared with and is built by ./dev build (or ./dev test)"}});
    std::vector<std::string> words;
    if (!options.out.empty()) words.insert(words.end(), {"--out", options.out});
    if (!options.filter.empty()) words.insert(words.end(), {"--filter", options.filter});
    if (options.check) words.emplace_back("--check");
    return fail(becomeProgram(program, words));
}

}  // namespace passung::cli
