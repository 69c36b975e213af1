#include "study/store/schema/process_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "core/base/regular_file.h"
#include "study/store/schema/private_files.h"

namespace passung::store {
namespace {

constexpr int kLooks = 5;
constexpr std::chrono::milliseconds kBetweenLooks{5};

/// Is the file that we locked still the one at `path`, not one that its last owner has just removed?
bool isCurrent(const std::string& path, int descriptor) {
    struct stat held = {};
    struct stat named = {};
    return fstat(descriptor, &held) == 0 && stat(path.c_str(), &named) == 0 && held.st_ino == named.st_ino &&
           held.st_dev == named.st_dev;
}

Error lockError(const std::string& database_path, std::string message) {
    return Error{.message = std::move(message), .file = database_path, .key = {}, .value = {}};
}

/// The one path that stands for the database however it was named. Several hard links would have no such path (and
/// SQLite a log for each), and locking the file itself instead is no way out: closing any descriptor of it ends the
/// locks that SQLite holds on it in this process.
Result<std::string> properPath(const std::string& database_path) {
    namespace fs = std::filesystem;
    if (const auto why = whyNoRegularFile(database_path)) return lockError(database_path, *why);
    std::error_code error;
    if (fs::is_symlink(fs::symlink_status(database_path, error)) && !fs::exists(database_path, error)) {
        return lockError(database_path, "is a symbolic link to a file that does not exist");
    }
    const fs::path path = fs::weakly_canonical(database_path, error);
    if (error) return lockError(database_path, "cannot be found: " + error.message());
    if (fs::is_regular_file(path, error) && fs::hard_link_count(path, error) > 1 && !error) {
        return lockError(database_path, "has several names (hard links): leave one, or copy the file");
    }
    return path.string();
}

}  // namespace

Result<ProcessLock> ProcessLock::take(const std::string& database_path) {
    const auto proper = properPath(database_path);
    if (!proper) return proper.errors();
    const std::string path = *proper + ".lock";
    for (int looks = 0;;) {
        const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
        if (descriptor < 0) {
            return lockError(database_path, std::string("cannot be opened for writing: ") + std::strerror(errno));
        }
        if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
            close(descriptor);
            if (++looks < kLooks) {  // a reader may just be asking whether anybody writes
                std::this_thread::sleep_for(kBetweenLooks);
                continue;
            }
            return lockError(database_path, "another program is writing this database; end it first");
        }
        shareLike(*proper, path);
        if (isCurrent(path, descriptor)) return ProcessLock(path, descriptor);
        close(descriptor);
    }
}

ProcessLock::ProcessLock(ProcessLock&& other) noexcept : path_(std::move(other.path_)), descriptor_(other.descriptor_) {
    other.descriptor_ = -1;
}

ProcessLock::~ProcessLock() {
    if (descriptor_ < 0) return;
    unlink(path_.c_str());
    close(descriptor_);
}

bool isBeingWritten(const std::string& database_path) {
    const int descriptor = open((database_path + ".lock").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return errno == EACCES;
    const bool free = flock(descriptor, LOCK_SH | LOCK_NB) == 0;
    close(descriptor);
    return !free;
}

}  // namespace passung::store
