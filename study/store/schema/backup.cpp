#include "study/store/schema/backup.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "core/base/digest.h"
#include "study/store/schema/private_files.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void failAt(const std::string& path) {
    throw std::runtime_error("cannot write " + path + ": " + std::strerror(errno));
}

void writeSynced(const std::string& path, const std::string& text) {
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file < 0) failAt(path);
    const bool whole = write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && fsync(file) == 0;
    if (close(file) != 0 || !whole) failAt(path);
}

/// The names themselves reach the disk with their folder.
void syncFolder(const fs::path& folder) {
    const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0) return;
    fsync(file);
    close(file);
}

}  // namespace

std::string backupPath(const std::string& database_path) { return behindLink(database_path) + ".backup"; }

void writeBackup(const Database& database, const std::string& database_path,
                 const std::function<void(Database& copy, const std::string& path)>& change) {
    const fs::path path = backupPath(database_path);
    const std::string part = path.string() + ".part", sum = path.string() + ".sha256";
    std::error_code ignored;
    try {
        fs::remove(part);
        database.copyTo(part);
        if (change) {
            Database copy(part, OpenMode::ReadWrite);
            change(copy, part);
        }
        shareLike(database_path, part);
        const std::string line = sha256OfFile(part) + "  " + path.filename().string() + "\n";
        // Never a sum beside a copy that it is not of.
        fs::remove(sum);
        fs::rename(part, path);
        writeSynced(sum + ".part", line);
        shareLike(database_path, sum + ".part");
        fs::rename(sum + ".part", sum);
        syncFolder(fs::absolute(path).parent_path());
    } catch (...) {
        for (const std::string& file : {part, part + "-journal", part + "-wal", part + "-shm", sum + ".part"})
            fs::remove(file, ignored);
        throw;
    }
}

}  // namespace passung::store
