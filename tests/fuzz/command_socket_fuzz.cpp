#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <thread>

#include "study/run/command_socket.h"
#include "tests/support/temp_folder.h"

/// libFuzzer: whatever a program sends to a session's socket is answered or refused, and the next command of an honest
/// program is obeyed. A '|' stands for the zero byte between the parts of a request.
namespace {

using namespace passung;

/// A session that accepts everything; it ends with the program.
class Session {
public:
    Session() : database_(folder_ / "study.db"), socket_(*run::CommandSocket::listen(database_, [] {})) {
        thread_ = std::thread([this] {
            while (!ended_)
                socket_->serve([](const session::Command&) { return session::Reply{.accepted = true}; }, true);
        });
    }
    ~Session() {
        ended_ = true;
        thread_.join();
    }
    const std::string& database() const { return database_; }

private:
    test::TempFolder folder_;
    std::string database_;
    std::unique_ptr<run::CommandSocket> socket_;
    std::atomic<bool> ended_ = false;
    std::thread thread_;
};

/// The answer's length; -1 if there is none.
ssize_t sent(const std::string& path, std::string_view bytes) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), std::min(path.size() + 1, sizeof address.sun_path));
    const int connection = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) std::abort();
    (void)send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    shutdown(connection, SHUT_WR);
    char answer[64];
    ssize_t length = 0;
    do length = recv(connection, answer, sizeof answer, 0);
    while (length < 0 && errno == EINTR);  // by the fuzzer's own clock
    close(connection);
    return length;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Session kSession;
    std::string request(reinterpret_cast<const char*>(data), size);
    std::replace(request.begin(), request.end(), '|', '\0');
    if (sent(kSession.database() + ".socket", request) < 1) std::abort();
    const auto answer =
        run::tellSession(kSession.database(), {.kind = session::CommandKind::Note, .text = "still here"});
    if (!answer || !*answer || !(*answer)->accepted) std::abort();
    return 0;
}
