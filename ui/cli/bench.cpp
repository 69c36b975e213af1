#include <string>
#include <vector>

#include "ui/cli/commands.h"
#include "ui/cli/other_program.h"

namespace passung::cli {

int bench(const BenchArguments& options) {
    std::vector<std::string> words;
    if (!options.out.empty()) words.insert(words.end(), {"--out", options.out});
    if (!options.filter.empty()) words.insert(words.end(), {"--filter", options.filter});
    if (options.check) words.emplace_back("--check");
    return becomeProgram({"passung-bench",
                          "it links the engines we are compared with and is built by ./dev build (or "
                          "./dev test)"},
                         words);
}

}  // namespace passung::cli
