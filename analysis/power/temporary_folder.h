#pragma once

#include <filesystem>
#include <optional>

#include "core/base/folder_lock.h"
#include "core/base/result.h"

namespace passung::power {

/// Gone with everything in it at the end, or with the next one if the program is killed.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    /// An error where it could not be made: nothing may be written by its path then.
    Result<Done> made() const;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    std::optional<FolderLock> lock_;
};

}  // namespace passung::power
