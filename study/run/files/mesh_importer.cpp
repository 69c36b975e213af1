#include "study/run/files/mesh_importer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/import/mesh_bytes.h"
#include "study/run/import_exit.h"

namespace passung::run {

namespace {

namespace fs = std::filesystem;

/// How the program ended, and what it wrote.
struct Ended {
    int status = 0;
    std::string answer;
    bool too_long = false;  // the answer
};

/// Settings of a new process: nothing to read, its errors to nobody, its answer to `to`; signals as they are by nature.
class ProcessSettings {
public:
    explicit ProcessSettings(int to) {
        posix_spawn_file_actions_init(&files_);
        posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&files_, to, STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&files_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawnattr_init(&attributes_);
        sigset_t none, all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setsigdefault(&attributes_, &all);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~ProcessSettings() {
        posix_spawn_file_actions_destroy(&files_);
        posix_spawnattr_destroy(&attributes_);
    }
    ProcessSettings(const ProcessSettings&) = delete;
    ProcessSettings& operator=(const ProcessSettings&) = delete;

    const posix_spawn_file_actions_t* files() const { return &files_; }
    const posix_spawnattr_t* attributes() const { return &attributes_; }

private:
    posix_spawn_file_actions_t files_{};
    posix_spawnattr_t attributes_{};
};

/// Takes the answer from `from` to its end, or to `most` bytes.
void takeAnswer(int from, std::uintmax_t most, Ended& ended) {
    std::vector<char> buffer(1 << 16);
    for (;;) {
        const ssize_t got = read(from, buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return;
        ended.answer.append(buffer.data(), static_cast<std::size_t>(got));
        ended.too_long = ended.answer.size() > most;
        if (ended.too_long) return;
    }
}

std::optional<Ended> runToEnd(const std::vector<std::string>& words, std::uintmax_t most_bytes) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
    pid_t child = -1;
    const int failure = [&] {
        const ProcessSettings around(ends[1]);
        return posix_spawn(&child, argv[0], around.files(), around.attributes(), argv.data(), environ);
    }();
    close(ends[1]);
    Ended ended;
    if (failure == 0) {
        takeAnswer(ends[0], most_bytes, ended);
        if (ended.too_long) kill(child, SIGKILL);
        while (waitpid(child, &ended.status, 0) < 0 && errno == EINTR) {
        }
    }
    close(ends[0]);
    if (failure != 0) return std::nullopt;
    return ended;
}

/// What ended it instead of an answer.
std::string whatEndedIt(const Ended& ended, std::uintmax_t memory, const ImportLimits& limits) {
    const bool killed = WIFSIGNALED(ended.status);
    if (ended.too_long || (!killed && WEXITSTATUS(ended.status) == kOutOfMemory))
        return fmt::format("needs more than {} MiB of memory to be read; --import-memory-mb allows more", memory >> 20);
    if (killed && WTERMSIG(ended.status) == SIGXCPU)
        return fmt::format("needs more than {:g} s of processor time to be read; --import-seconds allows more",
                           limits.processor_s);
    if (killed)
        return fmt::format("cannot be read: its reader ended by signal {} ({})", WTERMSIG(ended.status),
                           strsignal(WTERMSIG(ended.status)));
    return fmt::format("cannot be read: its reader ended with {} and no answer", WEXITSTATUS(ended.status));
}

}  // namespace

std::optional<fs::path> importProgram() {
    std::error_code none;
    const fs::path own = fs::read_symlink("/proc/self/exe", none);
    const fs::path program = own.parent_path() / "passung-import";
    if (none || access(program.c_str(), X_OK) != 0) return std::nullopt;
    return program;
}

Result<importer::ImportedMesh> importElsewhere(const fs::path& program, const std::string& path, double metres_per_unit,
                                               const ImportLimits& limits) {
    std::error_code none;
    const bool regular = fs::is_regular_file(path, none);
    const std::uintmax_t size = regular ? fs::file_size(path, none) : 0;
    const std::uintmax_t memory = std::max(limits.memory, none ? 0 : 16 * size);
    const auto seconds = static_cast<std::uintmax_t>(std::ceil(std::max(limits.processor_s, 1.0)));
    const auto ended = runToEnd(
        {program.string(), path, fmt::format("{:a}", metres_per_unit), std::to_string(seconds), std::to_string(memory)},
        memory);
    if (!ended) return Error{.message = "cannot be read: " + program.string() + " does not start", .file = path};
    const bool answered = !ended->too_long && WIFEXITED(ended->status) && WEXITSTATUS(ended->status) == 0;
    if (!answered) return Error{.message = whatEndedIt(*ended, memory, limits), .file = path};
    if (auto imported = importer::importedFrom(ended->answer)) return std::move(*imported);
    return Error{.message = "cannot be read: its reader gave no sound answer", .file = path};
}

}  // namespace passung::run
