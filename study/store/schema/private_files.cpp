#include "study/store/schema/private_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace passung::store {
namespace {

constexpr mode_t kOwner = 0600, kGroupToo = 0660, kOthers = 0007, kGroup = 0070, kAll = 0777;
constexpr std::array kBeside = {"-wal", "-shm", "-journal", ".lock", ".backup", ".backup.sha256"};

/// Links resolved, as SQLite does for the files beside it.
std::string properName(const std::string& path) {
    std::error_code error;
    const auto proper = std::filesystem::weakly_canonical(path, error);
    return error ? path : proper.string();
}

/// That a file is open to everybody is nobody's decision: such a one becomes the owner's alone.
mode_t decidedMode(mode_t mode) { return (mode & kOthers) != 0 ? mode & kOwner : mode & kAll; }

/// False if this user may not.
bool giveMode(const std::string& path, mode_t mode, gid_t group) {
    struct stat file = {};
    if (stat(path.c_str(), &file) != 0) return true;
    bool done = true;
    if ((mode & kGroup) != 0 && file.st_gid != group) done = chown(path.c_str(), static_cast<uid_t>(-1), group) == 0;
    if ((file.st_mode & kAll) != mode) done = chmod(path.c_str(), mode) == 0 && done;
    return done;
}

}  // namespace

std::string behindLink(const std::string& path) { return std::filesystem::is_symlink(path) ? properName(path) : path; }

void makePrivate(const std::string& path) {
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kOwner);
    if (file >= 0)
        close(file);
    else if (errno != EEXIST)
        throw std::runtime_error(std::string("cannot be opened (") + std::strerror(errno) + ")");
}

void keepPrivate(const std::string& database_path, bool group) {
    const std::string path = properName(database_path);
    struct stat file = {};
    if (stat(path.c_str(), &file) != 0) return;
    const mode_t mode = group ? kGroupToo : decidedMode(file.st_mode);
    if (!giveMode(path, mode, file.st_gid) && group)
        throw std::runtime_error("belongs to another user, who alone can share it with the group");
    for (const char* beside : kBeside) giveMode(path + beside, mode, file.st_gid);
    for (const char* log : kLogFiles) giveMode(path + log, mode, file.st_gid);
}

void shareLike(const std::string& database_path, const std::string& file) {
    struct stat database = {};
    if (stat(database_path.c_str(), &database) == 0) giveMode(file, decidedMode(database.st_mode), database.st_gid);
}

}  // namespace passung::store
