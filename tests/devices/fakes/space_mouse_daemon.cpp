#include "tests/devices/fakes/space_mouse_daemon.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tests/devices/fakes/waiting.h"

namespace passung::fake {
namespace {

constexpr const char* kProgram = "/usr/bin/spacenavd";

/// A socket that is connected to `path`; -1 if nobody listens there.
int connected(const std::filesystem::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.string().size() >= sizeof address.sun_path) throw std::runtime_error("path too long: " + path.string());
    std::strcpy(address.sun_path, path.c_str());
    const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return descriptor;
    close(descriptor);
    return -1;
}

[[noreturn]] void become(const std::filesystem::path& folder) {
    const int log = open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (log < 0 || chdir(folder.c_str()) != 0) _exit(126);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // no daemon outlives a test that is killed
    setenv("DISPLAY", ":9999", 1);     // where no X server is: unset, the first one of the machine would be asked
    execl(kProgram, kProgram, "-d", "-v", "-c", "spnavrc", nullptr);
    _exit(127);
}

}  // namespace

bool SpaceMouseDaemon::installed() { return access(kProgram, X_OK) == 0; }

SpaceMouseDaemon::SpaceMouseDaemon(SerialMouse::Model model, const std::string& settings)
    : mouse_(model, folder_.path() / "mouse") {
    std::filesystem::create_directory(folder_.path() / "run");
    std::ofstream(folder_ / "spnavrc") << "serial = " << (folder_ / "mouse") << '\n' << settings;
    start();
}

SpaceMouseDaemon::~SpaceMouseDaemon() { kill(); }

void SpaceMouseDaemon::start() {
    kill();
    mouse_.forgetService();
    std::filesystem::remove(socket());
    child_ = fork();
    if (child_ == 0) become(folder_.path());
    bool listens = false;
    waitFor(
        "spacenavd to serve its mouse",
        [&] {
            if (waitpid(child_, nullptr, WNOHANG) == child_) {
                child_ = -1;
                throw std::runtime_error("spacenavd ended: " + log());
            }
            const bool asked = mouse_.answer();
            if (!mouse_.isServed()) return asked;
            const int trial = connected(socket());
            if (trial >= 0) close(trial);
            listens = trial >= 0;
            return asked || listens;
        },
        [&] { return listens; });
    // Its loop runs, with all that it does before, when it answers.
    SpaceMouseTap(socket()).askProtocol1();
}

void SpaceMouseDaemon::end(int signal) {
    if (child_ <= 0) return;
    ::kill(child_, signal);
    ::kill(child_, SIGCONT);
    waitpid(child_, nullptr, 0);
    child_ = -1;
}

void SpaceMouseDaemon::kill() { end(SIGKILL); }
void SpaceMouseDaemon::stop() { end(SIGTERM); }

void SpaceMouseDaemon::hang() {
    ::kill(child_, SIGSTOP);
    waitpid(child_, nullptr, WUNTRACED);
}

void SpaceMouseDaemon::goOn() { ::kill(child_, SIGCONT); }

std::string SpaceMouseDaemon::log() const {
    std::ifstream file(folder_ / "log", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

SpaceMouseTap::SpaceMouseTap(const std::filesystem::path& socket) : socket_(connected(socket)) {
    if (socket_ < 0) throw std::runtime_error("nobody listens at " + socket.string());
}

SpaceMouseTap::~SpaceMouseTap() { close(socket_); }

void SpaceMouseTap::send(const void* bytes, std::size_t count) {
    if (::send(socket_, bytes, count, MSG_NOSIGNAL) != static_cast<ssize_t>(count))
        throw std::runtime_error("spacenavd does not take a request");
}

std::string SpaceMouseTap::take(std::size_t count) {
    std::string bytes;
    bool ended = false;
    waitFor(
        "bytes of spacenavd",
        [&] {
            if (!readable(socket_)) return false;
            std::string more(count - bytes.size(), '\0');
            const ssize_t got = recv(socket_, more.data(), more.size(), 0);
            ended = got <= 0;
            if (!ended) bytes.append(more, 0, static_cast<std::size_t>(got));
            return true;
        },
        [&] { return ended || bytes.size() == count; });
    return bytes;
}

bool SpaceMouseTap::hasMore() const { return readable(socket_); }

std::optional<SpaceMouseTap::Words> SpaceMouseTap::frame() {
    const std::string bytes = take(sizeof(Words));
    if (bytes.size() != sizeof(Words)) return std::nullopt;
    Words words{};
    std::memcpy(words.data(), bytes.data(), sizeof words);
    return words;
}

std::uint32_t SpaceMouseTap::askProtocol1() {
    const std::uint32_t request = 0x7faa5501;
    send(&request, sizeof request);
    std::uint32_t reply = 0;
    const std::string bytes = take(sizeof reply);
    std::memcpy(&reply, bytes.data(), bytes.size());
    return reply;
}

std::optional<SpaceMouseTap::Words> SpaceMouseTap::ask(std::int32_t request) {
    const Words words{request};
    send(words.data(), sizeof words);
    return frame();
}

}  // namespace passung::fake
