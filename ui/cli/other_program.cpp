#include "ui/cli/other_program.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace passung::cli {

std::filesystem::path findOtherProgram(const char* name) {
    constexpr std::array kPlaces{"", "../release"};
    std::error_code unknown;
    const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
    for (const char* place : kPlaces) {
        const std::filesystem::path program = (folder / place / name).lexically_normal();
        if (access(program.c_str(), X_OK) == 0) return program;
    }
    return {};
}

Errors becomeProgram(const std::filesystem::path& program, const std::vector<std::string>& words) {
    std::vector<std::string> all{program.string()};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> arguments;
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(program.c_str(), arguments.data());
    return {{.message = std::string("cannot be started: ") + std::strerror(errno), .file = program.string()}};
}

}  // namespace passung::cli
