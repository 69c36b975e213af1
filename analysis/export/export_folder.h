#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace passung::exporter {

/// A folder that appears complete or not at all: files go to `<folder>.partial`, which takes the folder's place at the
/// end. What is not completed is removed.
class ExportFolder {
public:
    /// Fails if `folder` exists and is neither empty nor an earlier export.
    static Result<ExportFolder> begin(const std::string& folder);
    ~ExportFolder();
    ExportFolder(ExportFolder&& other) noexcept;
    ExportFolder& operator=(ExportFolder&&) = delete;

    /// Writes one file; `path` is inside the folder, with '/'.
    Result<Done> write(const std::string& path, std::string_view bytes);

    /// Adds SHA256SUMS over everything written and puts the folder in its place.
    Result<Done> complete();

private:
    explicit ExportFolder(std::filesystem::path folder);

    std::filesystem::path folder_;
    std::filesystem::path partial_;  // empty: nothing to remove
    std::map<std::string, std::string> sums_;
};

}  // namespace passung::exporter
