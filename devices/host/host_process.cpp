#include "devices/host/host_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <thread>

extern char** environ;  // POSIX demands it, and no header has it

namespace passung::host {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using Steady = std::chrono::steady_clock;

constexpr const char* kProgramVariable = "PASSUNG_DEVICE_HOST";
constexpr const char* kProgramName = "passung-device-host";
constexpr milliseconds kEnding{200};  // of a host that is asked to end

/// The program; it stands beside the one that runs, or where the variable says.
Result<std::string> hostProgram() {
    if (const char* named = std::getenv(kProgramVariable); named != nullptr && *named != '\0') {
        if (access(named, X_OK) == 0) return std::string(named);
        return Error{.message = fmt::format("no program is at {}, which {} names", named, kProgramVariable)};
    }
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path() / kProgramName;
    if (!none && access(program.c_str(), X_OK) == 0) return program.string();
    return Error{.message = fmt::format("the program that drives devices of closed libraries is missing: looked for "
                                        "{}; install it there, or name it in {}",
                                        program.string(), kProgramVariable)};
}

/// What the host begins with: the memory, the bell, no terminal's signals, and nothing else of this program's.
class HostSurroundings {
public:
    HostSurroundings(int memory, int bell) {
        posix_spawn_file_actions_init(&files_);
        posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&files_, memory, kMemoryDescriptor);
        posix_spawn_file_actions_adddup2(&files_, bell, kBellDescriptor);
        posix_spawn_file_actions_addclosefrom_np(&files_, kBellDescriptor + 1);
        posix_spawnattr_init(&attributes_);
        sigset_t none, all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setsigdefault(&attributes_, &all);
        posix_spawnattr_setpgroup(&attributes_, 0);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
    ~HostSurroundings() {
        posix_spawn_file_actions_destroy(&files_);
        posix_spawnattr_destroy(&attributes_);
    }
    HostSurroundings(const HostSurroundings&) = delete;
    HostSurroundings& operator=(const HostSurroundings&) = delete;

    int spawn(pid_t& child, const std::string& program, const std::string& backend) const {
        char* const words[] = {const_cast<char*>(program.c_str()), const_cast<char*>(backend.c_str()), nullptr};
        return posix_spawn(&child, program.c_str(), &files_, &attributes_, words, environ);
    }

private:
    posix_spawn_file_actions_t files_{};
    posix_spawnattr_t attributes_{};
};

/// A descriptor that does not stand where the host's own will, and is closed in every other program that is started.
int apart(int descriptor) {
    const int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, kBellDescriptor + 1);
    close(descriptor);
    return moved;
}

}  // namespace

Result<std::unique_ptr<HostProcess>> HostProcess::start(const std::string& backend, const HostTask& task) {
    const auto program = hostProgram();
    if (!program) return program.errors();
    const int memory = apart(memfd_create(kProgramName, MFD_CLOEXEC));
    int ends[2] = {-1, -1};
    const bool have_bell = socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0;
    std::unique_ptr<HostProcess> started(new HostProcess);
    started->bell_ = apart(ends[0]);
    const int hosts_bell = apart(ends[1]);
    void* ours = MAP_FAILED;
    void* theirs = MAP_FAILED;
    if (memory >= 0 && ftruncate(memory, 2 * kPageBytes) == 0) {
        ours = mmap(nullptr, kPageBytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
        theirs = mmap(nullptr, kPageBytes, PROT_READ, MAP_SHARED, memory, kPageBytes);
    }
    int failure = ENOMEM;
    if (have_bell && ours != MAP_FAILED && theirs != MAP_FAILED) {
        started->asked_ = new (ours) StudyPage;
        started->asked_->head = PageHead::of<StudyPage>();
        started->asked_->task = task;
        started->told_ = static_cast<const HostPage*>(theirs);
        failure = HostSurroundings(memory, hosts_bell).spawn(started->process_, *program, backend);
    }
    close(memory);
    close(hosts_bell);
    if (failure == 0) return started;
    return Error{.message = fmt::format("{} does not start: {}", *program, std::strerror(failure))};
}

HostProcess::~HostProcess() {
    close(bell_);  // that is how it knows
    if (process_ > 0 && !reap(kEnding)) {
        kill(process_, SIGKILL);
        reap(milliseconds(1000));
    }
    if (asked_ != nullptr) munmap(asked_, kPageBytes);
    if (told_ != nullptr) munmap(const_cast<HostPage*>(told_), kPageBytes);
}

std::optional<int> HostProcess::reap(milliseconds longest) {
    const auto until = Steady::now() + longest;
    while (!status_) {
        int status = 0;
        const pid_t ended = waitpid(process_, &status, WNOHANG);
        if (ended == process_ || (ended < 0 && errno == ECHILD)) status_ = status;
        if (status_ || Steady::now() > until) break;
        std::this_thread::sleep_for(milliseconds(1));
    }
    return status_;
}

std::string HostProcess::ending() {
    const auto status = reap(kEnding);
    if (status && WIFSIGNALED(*status))
        return fmt::format("the device host was ended by signal {} ({})", WTERMSIG(*status),
                           strsignal(WTERMSIG(*status)));
    return "the device host has ended";
}

/// False: the time is over, or nobody rings any more.
bool HostProcess::awaitBell(Steady::time_point until) {
    const auto left = std::chrono::ceil<milliseconds>(until - Steady::now()).count();
    pollfd bell{bell_, POLLIN, 0};
    if (gone_ || poll(&bell, 1, static_cast<int>(std::max<std::int64_t>(left, 0))) <= 0) return false;
    char strokes[256];
    const ssize_t count = recv(bell_, strokes, sizeof strokes, MSG_DONTWAIT);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) gone_ = true;
    return !gone_;
}

Result<Done> HostProcess::awaitRunning(milliseconds longest) {
    const auto until = Steady::now() + longest;
    while (told_->stage.load() == HostPage::Starting && Steady::now() < until && !gone_)
        awaitBell(std::min(until, Steady::now() + milliseconds(2)));
    if (told_->stage.load() == HostPage::Starting && !gone_)
        return Error{.message = fmt::format("the vendor's library has not opened a device within {} ms: it hangs",
                                            longest.count())};
    if (told_->head.magic == HostPage::kMagic && !(told_->head == PageHead::of<HostPage>()))
        return Error{.message = "passung-device-host is of another version than this program: install both anew"};
    switch (told_->stage.load()) {
        case HostPage::Running:
            return Done{};
        case HostPage::Failed:
            return Error{.message = std::string(told_->failure.view())};
        default:
            return Error{.message = ending() + " while it loaded the vendor's library and opened a device"};
    }
}

void HostProcess::give(const StudyCommand& command) {
    asked_->now.store(command);
    const char stroke = 1;
    if (send(bell_, &stroke, 1, MSG_NOSIGNAL | MSG_DONTWAIT) < 0 && errno != EAGAIN) gone_ = true;
}

std::optional<HostReport> HostProcess::awaitReport(std::uint64_t answers, milliseconds longest) {
    const auto until = Steady::now() + longest;
    for (;;) {
        const bool rang = awaitBell(until);
        const auto report = told_->now.load();
        if (!rang || (report && report->answers >= answers)) return report;
    }
}

}  // namespace passung::host
