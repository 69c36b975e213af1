#include "core/base/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace passung {

namespace {

constexpr const char* kNotOpened = "cannot be opened";

/// An open file that closes itself.
class OpenFile {
public:
    explicit OpenFile(const std::string& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
    ~OpenFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    int descriptor() const { return descriptor_; }
    /// Size in bytes if it is a regular file.
    std::optional<std::uintmax_t> size() const {
        struct stat status {};
        if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
        return static_cast<std::uintmax_t>(status.st_size);
    }

private:
    int descriptor_;
};

std::string tooLarge(std::uintmax_t most_bytes) {
    return "must be a file of at most " + std::to_string(most_bytes >> 20) + " MiB";
}

/// Appends up to `count` bytes; false if the system refuses.
bool readUpTo(int descriptor, std::size_t count, std::string& bytes) {
    const std::size_t begin = bytes.size();
    bytes.resize(begin + count);
    std::size_t done = 0;
    while (done < count) {
        const ssize_t got = ::read(descriptor, bytes.data() + begin + done, count - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return false;
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    bytes.resize(begin + done);
    return true;
}

}  // namespace

std::optional<std::string> whyNoRegularFile(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0)
        return errno == ELOOP ? std::optional<std::string>("is a symbolic link that leads round in a circle")
                              : std::nullopt;
    if (S_ISREG(status.st_mode)) return std::nullopt;
    return "must be a regular file that may be read, not a folder, a pipe or a device";
}

Result<std::string> readRegularFile(const std::string& path, std::uintmax_t most_bytes) {
    // Asked before it is opened: to open some devices already does something.
    if (const auto why = whyNoRegularFile(path)) return Error{.message = *why, .file = path};
    const OpenFile file(path);
    if (file.descriptor() < 0) return Error{.message = kNotOpened, .file = path};
    const auto size = file.size();
    if (!size) return Error{.message = kNotOpened, .file = path};
    if (*size > most_bytes) return Error{.message = tooLarge(most_bytes), .file = path};
    // Files of the system state no size, and a file may grow: read on to the end, within the limit.
    constexpr std::size_t kPiece = std::size_t{1} << 16;
    std::string bytes;
    bool read = readUpTo(file.descriptor(), static_cast<std::size_t>(*size), bytes);
    while (read && bytes.size() <= most_bytes) {
        const std::size_t before = bytes.size();
        read = readUpTo(file.descriptor(), kPiece, bytes);
        if (bytes.size() == before) break;
    }
    if (!read) return Error{.message = "cannot be read", .file = path};
    if (bytes.size() > most_bytes) return Error{.message = tooLarge(most_bytes), .file = path};
    return bytes;
}

Result<std::string> readFile(const std::string& path) { return readRegularFile(path, kMostTextBytes); }

}  // namespace passung
