#include "study/store/write/earlier_backup.h"

#include <filesystem>

#include "study/store/read/verify.h"
#include "study/store/schema/sqlite.h"
#include "study/store/schema/untouched.h"

namespace passung::store {
namespace {

namespace fs = std::filesystem;

bool isSound(const std::string& path) {
    const auto found = verifyDatabase(path);
    return found && found->damages.empty();
}

/// Does `path` hold a session that `fresh` does not? False if it cannot be read.
bool holdsMore(const std::string& path, const std::string& fresh) {
    try {
        const auto earlier = openUntouched(path), later = openUntouched(fresh);
        Statement sessions = earlier->prepare("SELECT session_id FROM session");
        Statement known = later->prepare("SELECT 1 FROM session WHERE session_id=?");
        while (sessions.step()) {
            const std::string id = sessions.text(0);
            if (!known.bind(id).step()) return true;
            known.reset();
        }
    } catch (const SqliteError&) {
        return false;
    }
    return false;
}

}  // namespace

std::string keepEarlierBackup(const std::string& path, const std::string& fresh) {
    if (!fs::exists(path)) return {};
    if (!holdsMore(path, fresh) && (isSound(fresh) || !isSound(path))) return {};
    int number = 1;
    const auto name = [&] { return path + "." + std::to_string(number); };
    while (fs::exists(name())) ++number;
    fs::rename(path, name());
    return name();
}

}  // namespace passung::store
