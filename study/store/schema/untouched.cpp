#include "study/store/schema/untouched.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "study/store/schema/process_lock.h"

namespace passung::store {
namespace {

namespace fs = std::filesystem;

/// A folder that only this user may enter; goes with all that is in it.
class PrivateFolder {
public:
    /// @throws if there is no room for so many bytes.
    explicit PrivateFolder(std::uintmax_t bytes) {
        // Rather on a disk than in memory, which /tmp may be.
        const char* named = std::getenv("TMPDIR");
        const fs::path parent = named != nullptr && *named != '\0'     ? fs::path(named)
                                : access("/var/tmp", W_OK | X_OK) == 0 ? fs::path("/var/tmp")
                                                                       : fs::temp_directory_path();
        std::error_code error;
        const auto room = fs::space(parent, error);
        if (!error && room.available < bytes)
            throw std::runtime_error("reading it needs " + std::to_string(bytes / 1'000'000 + 1) + " MB in " +
                                     parent.string() + " for a private copy; TMPDIR names another folder");
        std::string name = (parent / "passung.XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw std::runtime_error("no private copy can be made in " + parent.string());
        path_ = name;
    }
    ~PrivateFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    PrivateFolder(const PrivateFolder&) = delete;
    PrivateFolder& operator=(const PrivateFolder&) = delete;

    std::string file() const { return (path_ / "copy.db").string(); }

private:
    fs::path path_;
};

std::uintmax_t sizeOf(const std::string& path) {
    std::error_code missing;
    const auto size = fs::file_size(path, missing);
    return missing ? 0 : size;
}

bool mayWrite(const std::string& path) { return faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0; }

/// Opens a copy that lies in a folder of ours; the system frees its space with the connection.
std::unique_ptr<Database> openCopy(const std::string& file) {
    auto database = std::make_unique<Database>(file, OpenMode::ReadWrite);
    // Takes in what is in a log or a journal, and needs no file but this one from here on. That asks for no schema
    // whose text is whole (schema_text.h).
    database->execute(
        "PRAGMA writable_schema=ON; PRAGMA journal_mode=DELETE; PRAGMA journal_mode=MEMORY; PRAGMA schema_version; "
        "PRAGMA writable_schema=RESET");
    return database;
}

/// The file and what a killed program left beside it, byte for byte.
std::unique_ptr<Database> copyWithRests(const std::string& path) {
    const PrivateFolder folder(sizeOf(path) + sizeOf(path + "-wal") + sizeOf(path + "-journal"));
    for (const char* suffix : {"", "-wal", "-journal"})
        if (*suffix == '\0' || sizeOf(path + suffix) > 0) {
            fs::copy_file(path + suffix, folder.file() + suffix);
            fs::permissions(folder.file() + suffix, fs::perms::owner_read | fs::perms::owner_write);
        }
    return openCopy(folder.file());
}

std::unique_ptr<Database> openRunning(const std::string& path, bool writable) {
    try {
        auto database = std::make_unique<Database>(path, writable ? OpenMode::Follow : OpenMode::ReadOnly);
        database->execute("PRAGMA schema_version");
        return database;
    } catch (const SqliteError& error) {
        if (writable || access(path.c_str(), R_OK) != 0) throw;
        throw std::runtime_error(
            std::string("a session runs on it, which this user cannot follow: read it when it is over (") +
            error.what() + ")");
    }
}

}  // namespace

std::unique_ptr<Database> openUntouched(const std::string& path) {
    const std::string proper = fs::weakly_canonical(path).string();
    const bool rests = sizeOf(proper + "-wal") > 0, journal = sizeOf(proper + "-journal") > 0;
    const bool writable = mayWrite(proper) && mayWrite(fs::path(proper).parent_path().string());
    if (isBeingWritten(proper)) return openRunning(proper, writable);
    if (journal || (rests && !writable)) return copyWithRests(proper);
    if (!writable) return std::make_unique<Database>(proper, OpenMode::Immutable);
    return std::make_unique<Database>(proper, rests ? OpenMode::FollowUntidied : OpenMode::Follow);
}

bool staysUntouched(const std::string& path) {
    const std::string proper = fs::weakly_canonical(path).string();
    return mayWrite(proper) && mayWrite(fs::path(proper).parent_path().string()) && sizeOf(proper + "-wal") == 0 &&
           sizeOf(proper + "-journal") == 0;
}

std::unique_ptr<Database> privateCopy(const Database& database, const std::string& path) {
    const PrivateFolder folder(2 * sizeOf(path));  // an upgrade writes it anew at worst
    database.copyTo(folder.file());
    return openCopy(folder.file());
}

}  // namespace passung::store
