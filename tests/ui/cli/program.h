#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"

/// Starts the program itself as a child process, as a person or a script does.
namespace passung::test {

inline std::string readText(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void writeText(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

inline std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
        lines.push_back(text.substr(begin, end - begin));
    }
    if (begin < text.size()) lines.push_back(text.substr(begin));
    return lines;
}

/// The running program: working directory is `folder`, its output goes to the files `<folder>/.out` and `.err`, where
/// it outlives a kill; a file `<folder>/.in`, if there is one, is what it reads.
class Program {
public:
    /// With `acknowledged` the option --acknowledge-fd is added and the lines can be read.
    Program(const std::filesystem::path& folder, std::vector<std::string> arguments, bool acknowledged = false)
        : folder_(folder) {
        std::array<int, 2> ends{-1, -1};
        if (acknowledged) {
            if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
            arguments.push_back("--acknowledge-fd");
            arguments.push_back(std::to_string(ends[1]));
        }
        arguments.insert(arguments.begin(), PASSUNG_PROGRAM);
        child_ = fork();
        if (child_ == 0) become(arguments, ends[1]);
        if (acknowledged) close(ends[1]);
        acknowledgements_ = ends[0];
    }
    ~Program() {
        if (child_ > 0) {
            killNow();
            wait();
        }
        if (acknowledgements_ >= 0) close(acknowledgements_);
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    /// The next acknowledgement; empty when the program has ended or, with a limit, when the time is over.
    std::string nextAcknowledgement(std::chrono::nanoseconds limit = std::chrono::hours(1)) {
        const auto end = std::chrono::steady_clock::now() + limit;
        for (;;) {
            if (const std::size_t length = pending_.find('\n'); length != std::string::npos) {
                const std::string line = pending_.substr(0, length);
                pending_.erase(0, length + 1);
                return line;
            }
            if (!readMore(end - std::chrono::steady_clock::now())) return {};
        }
    }

    void killNow() const { send(SIGKILL); }
    void send(int signal) const { kill(child_, signal); }

    /// Exit code, or minus the signal that ended it.
    int wait() {
        int status = 0;
        waitpid(child_, &status, 0);
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

    /// It does not run any more; wait() still tells how it ended.
    bool hasEnded() const {
        siginfo_t info{};
        return waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
    }

    std::string out() const { return readText(folder_ / ".out"); }
    std::string err() const { return readText(folder_ / ".err"); }

private:
    [[noreturn]] void become(const std::vector<std::string>& arguments, int acknowledgements) const {
        std::vector<char*> argv;
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        const auto redirect = [&](const char* name, int to) {
            const int file = open((folder_ / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
            if (file < 0 || dup2(file, to) < 0) _exit(126);
        };
        // What is typed: read and write, so that a pipe with that name neither waits for a writer nor ends.
        if (const int in = open((folder_ / ".in").c_str(), O_RDWR | O_CLOEXEC); in >= 0) dup2(in, STDIN_FILENO);
        redirect(".out", STDOUT_FILENO);
        redirect(".err", STDERR_FILENO);
        if (acknowledgements >= 0) fcntl(acknowledgements, F_SETFD, 0);
        if (chdir(folder_.c_str()) != 0) _exit(126);
        execv(argv[0], argv.data());
        _exit(127);
    }

    /// False when the time is over or the program's end of the pipe is closed.
    bool readMore(std::chrono::nanoseconds limit) {
        if (limit.count() <= 0) return false;
        const timespec time{static_cast<time_t>(limit.count() / 1'000'000'000),
                            static_cast<long>(limit.count() % 1'000'000'000)};
        pollfd waiting{acknowledgements_, POLLIN, 0};
        if (ppoll(&waiting, 1, &time, nullptr) <= 0) return false;
        std::array<char, 4096> buffer;
        const ssize_t count = read(acknowledgements_, buffer.data(), buffer.size());
        if (count <= 0) return false;
        pending_.append(buffer.data(), static_cast<std::size_t>(count));
        return true;
    }

    std::filesystem::path folder_;
    pid_t child_ = -1;
    int acknowledgements_ = -1;
    std::string pending_;
};

struct Ended {
    int exit_code;
    std::string out, err;
};

/// Runs the program to its end.
inline Ended runProgram(const std::filesystem::path& folder, const std::vector<std::string>& arguments) {
    Program program(folder, arguments);
    const int exit_code = program.wait();
    return {exit_code, program.out(), program.err()};
}

}  // namespace passung::test
