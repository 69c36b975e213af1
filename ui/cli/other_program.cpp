#include "ui/cli/other_program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "ui/cli/console.h"

namespace passung::cli {
namespace {

/// Empty if there is none.
std::filesystem::path find(const char* name) {
    constexpr std::array kPlaces{"", "../release"};
    std::error_code unknown;
    const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
    for (const char* place : kPlaces) {
        const std::filesystem::path program = (folder / place / name).lexically_normal();
        if (access(program.c_str(), X_OK) == 0) return program;
    }
    return {};
}

}  // namespace

int becomeProgram(const OtherProgram& program, const std::vector<std::string>& words) {
    const std::string path = find(program.name).string();
    if (path.empty())
        return fail({{.message = fmt::format("the program {} is neither beside this one nor in build/release; {}",
                                             program.name, program.made_by)}});
    std::vector<std::string> all{path};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> arguments;
    arguments.reserve(all.size() + 1);
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(path.c_str(), arguments.data());
    return fail({{.message = std::string("cannot be started: ") + std::strerror(errno), .file = path}});
}

int becomePostgres(const char* command, const std::string& database, const std::string& server) {
    return becomeProgram({"passung-postgres", "`./dev build passung-postgres` makes it"}, {command, database, server});
}

}  // namespace passung::cli
