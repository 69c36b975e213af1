#include "study/run/files/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/base/regular_file.h"
#include "study/run/files/synced_write.h"

namespace passung::run {

Replaced replaceFile(const std::string& path, const std::string& expected, const std::string& text, Error& problem) {
    std::error_code none;
    const std::filesystem::path target = std::filesystem::canonical(path, none);
    struct stat before {};
    if (none || stat(target.c_str(), &before) != 0) return Replaced::Changed;
    const auto failed = [&] {
        problem = {.message = std::string("cannot be written: ") + std::strerror(errno), .file = path};
        return Replaced::Failed;
    };
    if (access(target.c_str(), W_OK) != 0) return failed();
    std::string temporary = target.string() + ".XXXXXX";
    const int file = mkostemp(temporary.data(), O_CLOEXEC);
    if (file < 0) return failed();
    bool whole = fchmod(file, before.st_mode & 07777U) == 0 && writeSynced(file, text);
    whole = close(file) == 0 && whole;
    if (!whole) {
        const Replaced outcome = failed();
        unlink(temporary.c_str());
        return outcome;
    }
    const auto now = readFile(target.string());  // last thing before
    if (!now || *now != expected) {
        unlink(temporary.c_str());
        return Replaced::Changed;
    }
    if (rename(temporary.c_str(), target.c_str()) != 0) {
        const Replaced outcome = failed();
        unlink(temporary.c_str());
        return outcome;
    }
    syncFolder(target.parent_path());
    return Replaced::Done;
}

}  // namespace passung::run
