#include "ui/app/haptic_study.h"

#include <cstdlib>
#include <filesystem>

#include "study/store/store_reader.h"
#include "ui/app/auto_accuracy.h"
#include "ui/app/run_study.h"

namespace passung::app {

namespace {

namespace fs = std::filesystem;

/// Gone with everything in it at the end.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (fs::temp_directory_path() / "passung_power_XXXXXX").string();
        if (mkdtemp(name.data()) != nullptr) path_ = name;
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
};

}  // namespace

Result<exporter::StudyData> hapticStudy(const protocol::StudyPlan& plan, int participants) {
    if (asksForAccuracy(plan))
        return Error{.message = "differs from machine to machine; name the settings that it picked instead",
                     .file = plan.source_path,
                     .key = "contact.accuracy",
                     .value = "auto"};
    const TemporaryFolder folder;
    if (folder.path().empty())
        return Error{.message = "a temporary folder cannot be made", .file = fs::temp_directory_path().string()};
    RunOptions options;
    options.database = (folder.path() / "study.db").string();
    options.simulated = participants;
    if (const auto end = runStudy(plan, options, {}); !end) return end.errors();
    const auto reader = store::StoreReader::open(options.database);
    if (!reader) return reader.errors();
    return exporter::readStudy(*reader);
}

}  // namespace passung::app
