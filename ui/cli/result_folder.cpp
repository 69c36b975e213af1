#include "ui/cli/result_folder.h"

#include <algorithm>
#include <system_error>

#include "core/base/regular_file.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace fs = std::filesystem;

ResultFolder::~ResultFolder() {
    std::error_code full;
    for (const fs::path& made : made_) fs::remove(made, full);
}

Result<Done> ResultFolder::begin(const std::function<bool(const std::string&)>& isOurs, const std::string& whose) {
    try {
        if (auto replaceable = checkReplaceable(isOurs, whose); !replaceable) return replaceable;
        for (fs::path part = folder_; !part.empty() && !fs::exists(fs::symlink_status(part)); part = part.parent_path())
            made_.push_back(part);
        fs::create_directories(folder_);
    } catch (const fs::filesystem_error& failed) {
        return error("cannot be made: " + failed.code().message());
    }
    return Done{};
}

Result<Done> ResultFolder::write(const char* name, const std::string& text) const {
    OutputFile file((folder_ / name).string());
    file.write(text);
    return file.commit();
}

Result<Done> ResultFolder::checkReplaceable(const std::function<bool(const std::string&)>& isOurs,
                                            const std::string& whose) const {
    if (!fs::exists(folder_)) return Done{};
    if (!fs::is_directory(folder_)) return error("exists and is not a folder");
    if (fs::is_empty(folder_)) return Done{};
    for (const auto& entry : fs::directory_iterator(folder_))
        if (std::find(files_.begin(), files_.end(), entry.path().filename()) == files_.end())
            return error("exists and holds something else than results of accuracy (" +
                         entry.path().filename().string() + "): name another folder");
    const auto picture = readFile((folder_ / files_.front()).string());
    if (!picture || !isOurs(*picture)) return error("holds results that are not of " + whose + ": name another folder");
    return Done{};
}

}  // namespace passung::cli
