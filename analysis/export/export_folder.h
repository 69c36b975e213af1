#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/folder_lock.h"
#include "core/base/result.h"

namespace passung::exporter {

/// A folder that appears complete or not at all: files go to a folder of their own beside it,
/// `<folder>.partial.<random>`, and take its place at the end. What is not completed is removed. An earlier export is
/// replaced, but nothing that its SHA256SUMS does not list is ever deleted; one that may hold what the new one lacks,
/// samples or what is damaged in its database now, is kept beside it.
class ExportFolder {
public:
    /// Fails if `folder` exists and is neither empty nor an earlier export without further files, or if that export
    /// is of none of `studies` (names). What an export of the same folder that was killed has left is removed. Nobody
    /// but this user, or with `group` this user's group too, may open what is written.
    static Result<ExportFolder> begin(const std::string& folder, std::vector<std::string> studies, bool group = false);
    ~ExportFolder();
    ExportFolder(ExportFolder&& other) noexcept;
    ExportFolder& operator=(ExportFolder&&) = delete;

    /// Writes one file; `path` is inside the folder, with '/'.
    Result<Done> write(const std::string& path, std::string_view bytes);
    /// The same of pieces: `make` hands them to its argument one after the other.
    using Pieces = std::function<Result<Done>(const std::function<void(std::string_view)>&)>;
    Result<Done> writePieces(const std::string& path, const Pieces& make);

    /// Calls `work` with the folder that holds everything written, SHA256SUMS over it included. Files that it names
    /// belong to the export from then on; whatever else it left there is removed.
    Result<Done> letAdd(const std::function<std::vector<std::string>(const std::filesystem::path&)>& work);

    /// Adds SHA256SUMS over everything written and puts the folder in its place. An earlier export there is removed,
    /// but not where it has samples and the new one none, nor where the new one's missing.csv has a row that the
    /// earlier one's has not, nor where a file beside the samples was edited: it gets the first free name
    /// `<folder>.backup.1`, `<folder>.backup.2` …, which is returned; empty if there was nothing to keep.
    Result<std::string> complete();

private:
    ExportFolder(std::filesystem::path folder, std::vector<std::string> studies, bool group);
    Result<Done> writeSums();
    Result<Done> closeToOthers() const;
    std::filesystem::path placeOfEarlier() const;

    std::filesystem::path folder_;
    std::vector<std::string> studies_;
    bool group_;
    std::optional<FolderLock> lock_;  // of the workshop
    std::filesystem::path workshop_;  // holds the new files, then the replaced ones; empty: nothing to remove
    std::map<std::string, std::string> sums_;
};

}  // namespace passung::exporter
