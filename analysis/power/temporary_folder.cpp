#include "analysis/power/temporary_folder.h"

#include <cstdlib>
#include <string>
#include <system_error>

namespace passung::power {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrefix = "passung_power_";

/// Those of programs that were killed: full, and nobody holds them. An empty one may be one that is just being made.
void removeLeftFolders() {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(fs::temp_directory_path(), none)) {
        if (!entry.path().filename().string().starts_with(kPrefix) || fs::is_empty(entry.path(), none)) continue;
        if (const auto lock = FolderLock::take(entry.path())) fs::remove_all(entry.path(), none);
    }
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
    removeLeftFolders();
    std::string name = (fs::temp_directory_path() / kPrefix).string() + "XXXXXX";
    if (mkdtemp(name.data()) == nullptr) return;
    if (auto lock = FolderLock::take(name)) lock_.emplace(*std::move(lock));
    path_ = name;
}

Result<Done> TemporaryFolder::made() const {
    if (!path_.empty()) return Done{};
    return Error{.message = "a temporary folder cannot be made", .file = fs::temp_directory_path().string()};
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace passung::power
