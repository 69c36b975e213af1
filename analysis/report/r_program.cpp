#include "analysis/report/r_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>

namespace passung::report {
namespace {

/// How Rscript ended.
struct Ended {
    int status = 0;
    std::string output;
};

/// This process' variables with a locale of UTF-8: R writes letters of others as codes elsewhere.
std::vector<std::string> variables() {
    std::vector<std::string> all = {"LC_ALL=C.UTF-8"};
    for (char** variable = environ; *variable != nullptr; ++variable)
        if (!std::string_view(*variable).starts_with("LC_ALL=")) all.emplace_back(*variable);
    return all;
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

/// Everything that comes through the pipe's end `from`.
std::string readAll(int from) {
    std::string text;
    std::array<char, 4096> buffer{};
    for (;;) {
        const ssize_t got = read(from, buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return text;
        text.append(buffer.data(), static_cast<std::size_t>(got));
    }
}

/// Runs an expression of R in `folder`; its output is what goes to `stream`. Nothing if there is no R.
std::optional<Ended> runR(const std::filesystem::path& folder, const std::string& expression, int stream) {
    std::vector<std::string> words = {"Rscript", "--vanilla", "-e", expression}, around = variables();
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    for (const int other : {STDOUT_FILENO, STDERR_FILENO})
        if (other != stream) posix_spawn_file_actions_addopen(&files, other, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, ends[1], stream);
    posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
    pid_t child = -1;
    const int failure =
        posix_spawnp(&child, "Rscript", &files, nullptr, pointersTo(words).data(), pointersTo(around).data());
    posix_spawn_file_actions_destroy(&files);
    close(ends[1]);
    Ended ended;
    if (failure == 0) {
        ended.output = readAll(ends[0]);
        while (waitpid(child, &ended.status, 0) < 0 && errno == EINTR) {
        }
    }
    close(ends[0]);
    if (failure != 0 || (WIFEXITED(ended.status) && WEXITSTATUS(ended.status) == 127)) return std::nullopt;
    return ended;
}

constexpr const char* kPandoc = "pandoc";

std::string debianName(std::string needed) {
    if (needed == kPandoc) return needed;
    std::transform(needed.begin(), needed.end(), needed.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return "r-cran-" + needed;
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back(line);
    return lines;
}

}  // namespace

std::vector<std::string> missingPrograms(const std::vector<std::string>& needed) {
    std::string names;
    for (const std::string& name : needed) names += (names.empty() ? "\"" : ", \"") + name + "\"";
    const auto ended = runR(".",
                            "cat(setdiff(c(" + names +
                                "), c(rownames(installed.packages()), if (Sys.which(\"pandoc\") != \"\") "
                                "\"pandoc\")), sep = \"\\n\")",
                            STDOUT_FILENO);
    const bool has_r = ended && ended->status == 0;
    std::vector<std::string> missing;
    if (!has_r) missing.emplace_back("r-base-core");
    for (const std::string& name : has_r ? linesOf(ended->output) : needed) missing.push_back(debianName(name));
    return missing;
}

std::string installCommand(const std::vector<std::string>& programs) {
    if (programs.empty()) return {};
    std::string command = "apt install";
    for (const std::string& program : programs) command += " " + program;
    return command;
}

Evaluated evaluate(const std::filesystem::path& folder, const std::string& expression) {
    const auto ended = runR(folder, expression, STDERR_FILENO);
    if (!ended) return {.failed = "R does not start", .said = {}};
    Evaluated evaluated{.failed = {}, .said = linesOf(ended->output)};
    if (ended->status == 0) return evaluated;
    for (const std::string& line : evaluated.said) evaluated.failed += (evaluated.failed.empty() ? "" : " ") + line;
    if (evaluated.failed.empty()) evaluated.failed = "R ended without a word";
    evaluated.said.clear();
    return evaluated;
}

Evaluated render(const std::filesystem::path& folder, const std::string& text, const std::string& page) {
    return evaluate(folder, "rmarkdown::render(\"" + text + "\", output_file = \"" + page + "\", quiet = TRUE)");
}

}  // namespace passung::report
