#include "analysis/export/export_folder.h"

#include <fstream>

#include "analysis/export/codebook.h"
#include "study/store/digest.h"

namespace passung::exporter {
namespace {

namespace fs = std::filesystem;

Error folderError(const fs::path& path, std::string message) {
    return Error{.message = std::move(message), .file = path.string(), .key = {}, .value = {}};
}

bool isEarlierExport(const fs::path& folder) {
    std::ifstream codebook(folder / "codebook.json", std::ios::binary);
    std::string start(std::string_view(kCodebookStart).size(), '\0');
    codebook.read(start.data(), static_cast<std::streamsize>(start.size()));
    return codebook.good() && start == kCodebookStart;
}

/// `folder` without a slash at its end, so that a name can be added to it.
fs::path plain(const std::string& folder) {
    const fs::path path = fs::path(folder).lexically_normal();
    return path.has_filename() ? path : path.parent_path();
}

fs::path sibling(const fs::path& folder, const char* suffix) {
    return folder.parent_path() / (folder.filename().string() + suffix);
}

}  // namespace

ExportFolder::ExportFolder(fs::path folder) : folder_(std::move(folder)), partial_(sibling(folder_, ".partial")) {}

ExportFolder::ExportFolder(ExportFolder&& other) noexcept
    : folder_(std::move(other.folder_)), partial_(std::move(other.partial_)), sums_(std::move(other.sums_)) {
    other.partial_.clear();
}

ExportFolder::~ExportFolder() {
    std::error_code ignored;
    if (!partial_.empty()) fs::remove_all(partial_, ignored);
}

Result<ExportFolder> ExportFolder::begin(const std::string& name) {
    const fs::path folder = plain(name);
    std::error_code error;
    if (folder.empty() || folder.filename() == "." || folder.filename() == "..") {
        return folderError(name, "name a folder of its own for the export");
    }
    if (fs::exists(folder, error)) {
        if (!fs::is_directory(folder, error)) return folderError(folder, "exists and is not a folder");
        if (!fs::is_empty(folder, error) && !isEarlierExport(folder)) {
            return folderError(folder, "exists and holds something else than an export: name another folder");
        }
    }
    if (folder.has_parent_path()) fs::create_directories(folder.parent_path(), error);
    const fs::path partial = sibling(folder, ".partial");
    fs::remove_all(partial, error);  // of an export that was killed
    if (!fs::create_directory(partial, error)) {
        return folderError(partial, "cannot be created: " + error.message());
    }
    return ExportFolder(folder);
}

Result<Done> ExportFolder::write(const std::string& path, std::string_view bytes) {
    const fs::path file = partial_ / path;
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    std::ofstream stream(file, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) return folderError(file, "cannot be written");
    sums_[path] = store::sha256Hex(bytes);
    return Done{};
}

Result<Done> ExportFolder::complete() {
    std::string sums;
    for (const auto& [path, sum] : sums_) sums += sum + "  " + path + "\n";
    if (auto written = write("SHA256SUMS", sums); !written) return written;

    const fs::path old = sibling(folder_, ".replaced");
    std::error_code error;
    fs::remove_all(old, error);
    const bool replaces = fs::exists(folder_, error);
    if (replaces) fs::rename(folder_, old, error);
    if (!error) fs::rename(partial_, folder_, error);
    if (error) {
        const std::string reason = error.message();
        if (replaces && !fs::exists(folder_, error)) fs::rename(old, folder_, error);
        return folderError(folder_, "cannot be put in place: " + reason);
    }
    partial_.clear();
    fs::remove_all(old, error);
    return Done{};
}

}  // namespace passung::exporter
