#include "analysis/power/haptic_study.h"

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "core/base/folder_lock.h"
#include "study/run/machine/auto_accuracy.h"
#include "study/run/run_study.h"
#include "study/store/read/store_reader.h"

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

/// Gone with everything in it at the end, or with the next one if the program is killed.
class TemporaryFolder {
public:
    TemporaryFolder() {
        removeLeftFolders();
        std::string name = (fs::temp_directory_path() / kPrefix).string() + "XXXXXX";
        if (mkdtemp(name.data()) == nullptr) return;
        if (auto lock = FolderLock::take(name)) lock_.emplace(*std::move(lock));
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const fs::path& path() const { return path_; }  // empty: it could not be made

private:
    fs::path path_;
    std::optional<FolderLock> lock_;
};

}  // namespace

Result<exporter::StudyData> hapticStudy(const plan::StudyPlan& plan, int participants) {
    if (run::asksForAccuracy(plan))
        return Error{.message = "differs from machine to machine; name the settings that it picked instead",
                     .file = plan.source_path,
                     .key = "contact.accuracy",
                     .value = "auto"};
    const TemporaryFolder folder;
    if (folder.path().empty())
        return Error{.message = "a temporary folder cannot be made", .file = fs::temp_directory_path().string()};
    run::RunOptions options;
    options.database = (folder.path() / "study.db").string();
    options.simulated = participants;
    options.backup = false;
    if (const auto end = run::runStudy(plan, options, {}); !end) return end.errors();
    const auto reader = store::StoreReader::open(options.database);
    if (!reader) return reader.errors();
    return exporter::readStudy(*reader);
}

}  // namespace passung::power
