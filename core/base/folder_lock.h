#pragma once

#include <filesystem>
#include <optional>

namespace passung {

/// Marks a folder as in use by one owner: an advisory lock, which the system releases however the program ends.
class FolderLock {
public:
    /// Nothing if another owner holds the folder, or if it is no folder (a link to one counts as none).
    static std::optional<FolderLock> take(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&&) = delete;

private:
    explicit FolderLock(int descriptor) : descriptor_(descriptor) {}

    int descriptor_ = -1;
};

}  // namespace passung
