#include "study/store/process_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace passung::store {
namespace {

/// Is the file that we locked still the one at `path`, not one that its last owner has just removed?
bool isCurrent(const std::string& path, int descriptor) {
    struct stat held = {};
    struct stat named = {};
    return fstat(descriptor, &held) == 0 && stat(path.c_str(), &named) == 0 && held.st_ino == named.st_ino &&
           held.st_dev == named.st_dev;
}

}  // namespace

Result<ProcessLock> ProcessLock::take(const std::string& database_path) {
    const std::string path = database_path + ".lock";
    for (;;) {
        const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor < 0) {
            return Error{.message = std::string("cannot be opened for writing: ") + std::strerror(errno),
                         .file = database_path,
                         .key = {},
                         .value = {}};
        }
        if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
            close(descriptor);
            return Error{.message = "another program is writing this database; end it first",
                         .file = database_path,
                         .key = {},
                         .value = {}};
        }
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

}  // namespace passung::store
