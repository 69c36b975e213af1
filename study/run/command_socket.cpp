#include "study/run/command_socket.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>

namespace passung::run {

namespace {

namespace fs = std::filesystem;
using session::Command;
using session::Reply;

// A request is name, attempt (0: none) and text with a zero byte after the first two; an answer '0' (accepted) or '1',
// then the text. Both end where the sender closes its side.
constexpr std::size_t kLongestMessage = 65'536;
constexpr int kReceiveMilliseconds = 500;  // for a whole request: it is sent in one go
constexpr int kAnswerSeconds = 60;         // building a scene comes between two steps of a session

Error socketError(const std::string& database, const std::string& what) {
    return Error{.message = what + ": " + std::strerror(errno), .file = database};
}

fs::path socketPath(const std::string& database) {
    std::error_code ignored;
    return fs::weakly_canonical(database, ignored).string() + ".socket";
}

/// The address of a socket may have 107 bytes: the folder is named by its descriptor.
class Address {
public:
    explicit Address(const fs::path& path)
        : folder_(open(path.parent_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)) {
        const std::string text = "/proc/self/fd/" + std::to_string(folder_) + "/" + path.filename().string();
        fits_ = folder_ >= 0 && text.size() < sizeof address_.sun_path;
        address_.sun_family = AF_UNIX;
        if (fits_) std::memcpy(address_.sun_path, text.c_str(), text.size() + 1);
    }
    ~Address() {
        if (folder_ >= 0) close(folder_);
    }
    Address(const Address&) = delete;
    Address& operator=(const Address&) = delete;

    bool fits() const { return fits_; }
    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address_); }
    static socklen_t size() { return sizeof(sockaddr_un); }

private:
    int folder_;
    bool fits_;
    sockaddr_un address_{};
};

bool sendAll(int connection, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

/// Everything up to the sender's end; nothing if that does not come in time or is too long. A signal ends no wait.
std::optional<std::string> receiveAll(int connection, std::chrono::milliseconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    std::string message;
    std::array<char, 4096> buffer;
    while (message.size() <= kLongestMessage) {
        const auto rest = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        pollfd waiting{connection, POLLIN, 0};
        if (rest.count() <= 0) return std::nullopt;
        const int ready = poll(&waiting, 1, static_cast<int>(rest.count()));
        const ssize_t count = ready > 0 ? recv(connection, buffer.data(), buffer.size(), 0) : ready;
        if (count < 0 && errno == EINTR) continue;
        if (ready <= 0 || count < 0) return std::nullopt;
        if (count == 0) return message;
        message.append(buffer.data(), static_cast<std::size_t>(count));
    }
    return std::nullopt;
}

std::optional<Command> commandFrom(std::string_view message) {
    const std::size_t first = message.find('\0');
    const std::size_t second = message.find('\0', first + 1);
    if (first == std::string_view::npos || second == std::string_view::npos) return std::nullopt;
    const auto kind = session::commandNamed(message.substr(0, first));
    if (!kind) return std::nullopt;
    std::int64_t attempt = 0;
    std::from_chars(message.data() + first + 1, message.data() + second, attempt);
    Command command;
    command.kind = *kind;
    if (attempt > 0) command.attempt = session::AttemptId{attempt};
    command.text = message.substr(second + 1);
    return command;
}

void answer(int connection, const Reply& what) {
    sendAll(connection, (what.accepted ? '0' : '1') + what.text);
    close(connection);
}

}  // namespace

Result<std::unique_ptr<CommandSocket>> CommandSocket::listen(const std::string& database, std::function<void()> stop) {
    const fs::path path = socketPath(database);
    const Address address(path);
    if (!address.fits()) return Error{.message = "its name is too long for a socket beside it", .file = database};
    const int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int wake = eventfd(0, EFD_CLOEXEC);
    unlink(path.c_str());
    // Nobody but this user may command: the mode is set before anyone can connect.
    const bool bound = listener >= 0 && wake >= 0 && bind(listener, address.get(), Address::size()) == 0 &&
                       chmod(path.c_str(), 0600) == 0 && ::listen(listener, SOMAXCONN) == 0;
    if (bound) return std::unique_ptr<CommandSocket>(new CommandSocket(path.string(), listener, wake, std::move(stop)));
    const Error error = socketError(database, "no socket for commands beside it");
    for (const int descriptor : {listener, wake})
        if (descriptor >= 0) close(descriptor);
    return error;
}

CommandSocket::CommandSocket(std::string path, int listener, int wake, std::function<void()> stop)
    : path_(std::move(path)), listener_(listener), wake_(wake), stop_(std::move(stop)), thread_([this] {
          receive();
      }) {}

CommandSocket::~CommandSocket() {
    const std::uint64_t one = 1;
    static_cast<void>(!write(wake_, &one, sizeof one));
    thread_.join();
    unlink(path_.c_str());
    close(listener_);
    close(wake_);
    for (const Request& request : requests_) answer(request.connection, {false, "the session is over"});
}

void CommandSocket::receive() {
    for (;;) {
        std::array<pollfd, 2> waiting{pollfd{listener_, POLLIN, 0}, pollfd{wake_, POLLIN, 0}};
        if (poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) return;
        if (waiting[1].revents != 0) return;
        if (waiting[0].revents == 0) continue;
        const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        if (connection >= 0) receiveFrom(connection);
    }
}

void CommandSocket::receiveFrom(int connection) {
    const auto message = receiveAll(connection, std::chrono::milliseconds(kReceiveMilliseconds));
    auto command = message ? commandFrom(*message) : std::nullopt;
    if (!command) return answer(connection, {false, "no command"});
    if (command->kind == session::CommandKind::Stop) stop_();
    {
        const std::lock_guard lock(mutex_);
        requests_.push_back({std::move(*command), connection});
    }
    arrived_.notify_one();
}

std::deque<CommandSocket::Request> CommandSocket::takeAll(bool wait) {
    std::unique_lock lock(mutex_);
    if (wait) arrived_.wait_for(lock, kServeWait, [this] { return !requests_.empty(); });
    return std::exchange(requests_, {});
}

void CommandSocket::serve(const std::function<Reply(const Command&)>& obey, bool wait) {
    for (const Request& request : takeAll(wait)) answer(request.connection, obey(request.command));
}

Result<std::optional<Reply>> tellSession(const std::string& database, const Command& command) {
    const Address address(socketPath(database));
    const int connection = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connection < 0) return socketError(database, "no socket");
    if (!address.fits() || connect(connection, address.get(), Address::size()) != 0) {
        close(connection);
        return std::optional<Reply>();
    }
    const auto attempt = command.attempt ? static_cast<std::int64_t>(*command.attempt) : 0;
    std::string message(session::commandName(command.kind));
    message += '\0' + std::to_string(attempt) + '\0' + command.text;
    const bool sent = sendAll(connection, message) && shutdown(connection, SHUT_WR) == 0;
    const auto reply = sent ? receiveAll(connection, std::chrono::seconds(kAnswerSeconds)) : std::nullopt;
    close(connection);
    if (!reply || reply->empty()) return Error{.message = "the running session did not answer", .file = database};
    return std::optional(Reply{reply->front() == '0', reply->substr(1)});
}

}  // namespace passung::run
