#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "passung-bench";

/// Beside the program, or where ./dev build puts both.
constexpr std::array kPlaces{"", "../release"};

fs::path findBench() {
    std::error_code unknown;
    const fs::path folder = fs::read_symlink("/proc/self/exe", unknown).parent_path();
    for (const char* place : kPlaces) {
        const fs::path program = (folder / place / kName).lexically_normal();
        if (access(program.c_str(), X_OK) == 0) return program;
    }
    return {};
}

}  // namespace

int bench(const BenchArguments& options) {
    const fs::path program = findBench();
    if (program.empty())
        return fail(
            {{.message = "the program passung-bench is neither beside this one nor in build/release; it "
                         "links the engines we are compared with and is built by ./dev build (or ./dev test)"}});
    std::vector<std::string> words{program.string()};
    if (!options.out.empty()) words.insert(words.end(), {"--out", options.out});
    if (!options.filter.empty()) words.insert(words.end(), {"--filter", options.filter});
    if (options.check) words.emplace_back("--check");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    // Its exit code becomes ours.
    execv(program.c_str(), arguments.data());
    return fail({{.message = std::string("cannot be started: ") + std::strerror(errno), .file = program.string()}});
}

}  // namespace passung::cli
