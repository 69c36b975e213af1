#include "analysis/export/export_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

#include "analysis/export/codebook.h"
#include "analysis/export/missing_table.h"
#include "core/base/digest.h"
#include "core/base/folder_lock.h"
#include "core/base/regular_file.h"
#include "study/protocol/document.h"

namespace passung::exporter {
namespace {

namespace fs = std::filesystem;

Error folderError(const fs::path& path, std::string message) {
    return Error{.message = std::move(message), .file = path.string(), .key = {}, .value = {}};
}

bool isEarlierExport(const fs::path& folder) {
    const auto codebook = readFile((folder / "codebook.json").string());
    return codebook && codebook->starts_with(kCodebookStart);
}

constexpr const char* kSums = "SHA256SUMS";
constexpr const char* kSamplesFolder = "samples";

/// What the folder's SHA256SUMS lists: path, sum.
std::map<std::string, std::string> sumsIn(const fs::path& folder) {
    std::map<std::string, std::string> listed;
    const auto text = readFile((folder / kSums).string());
    std::istringstream sums(text ? *text : std::string());
    for (std::string sum, path; sums >> sum && sums.get() && sums.get() && std::getline(sums, path);)
        listed[path] = sum;
    return listed;
}

/// All that the folder's SHA256SUMS does not list.
std::vector<fs::path> strangersIn(const fs::path& folder) {
    const auto listed = sumsIn(folder);
    std::vector<fs::path> strangers;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_directory() && !entry.is_symlink()) continue;
        const std::string path = entry.path().lexically_relative(folder).generic_string();
        if (path != kSums && listed.count(path) == 0) strangers.push_back(entry.path());
    }
    return strangers;
}

/// Did somebody change a file of an earlier export? Samples are not looked at: they are many, and nobody edits them.
bool isEdited(const fs::path& folder) {
    const auto listed = sumsIn(folder);
    return std::any_of(listed.begin(), listed.end(), [&](const auto& file) {
        if (file.first.starts_with(std::string(kSamplesFolder) + "/")) return false;
        const auto bytes = readFile((folder / file.first).string());
        return bytes && sha256Hex(*bytes) != file.second;
    });
}

/// Names of the studies whose protocols an earlier export holds.
std::vector<std::string> studiesIn(const fs::path& folder) {
    std::vector<std::string> names;
    if (!fs::is_directory(folder / "protocol")) return names;
    for (const auto& entry : fs::directory_iterator(folder / "protocol")) {
        const auto text = readFile(entry.path().string());
        if (!text) continue;
        const auto document = protocol::parseDocument(*text, entry.path().string());
        const auto* study = document ? document->find("study") : nullptr;
        const auto* name = study != nullptr ? study->find("name") : nullptr;
        if (name != nullptr) names.push_back(name->text);
    }
    return names;
}

/// An empty folder or an earlier export of one of `studies` and nothing else may be replaced.
Result<Done> checkReplaceable(const fs::path& folder, const std::vector<std::string>& studies) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(folder, error))) return Done{};
    if (!fs::is_directory(folder, error)) return folderError(folder, "exists and is not a folder");
    try {
        if (fs::is_empty(folder)) return Done{};
        if (!isEarlierExport(folder)) {
            return folderError(folder, "exists and holds something else than an export: name another folder");
        }
        if (const auto strangers = strangersIn(folder); !strangers.empty()) {
            return folderError(strangers.front(),
                               "does not belong to the earlier export in this folder and would be lost: "
                               "move it away or name another folder");
        }
        const auto earlier = studiesIn(folder);
        const auto is_ours = [&](const std::string& name) {
            return std::find(studies.begin(), studies.end(), name) != studies.end();
        };
        if (!earlier.empty() && std::none_of(earlier.begin(), earlier.end(), is_ours)) {
            return folderError(folder,
                               "holds the export of another study, " + earlier.front() + ": name another folder");
        }
    } catch (const fs::filesystem_error& failed) {
        return folderError(folder, "cannot be read: " + failed.code().message());
    }
    return Done{};
}

/// `folder` without a slash at its end, so that a name can be added to it.
fs::path plain(const std::string& folder) {
    const fs::path path = fs::path(folder).lexically_normal();
    return path.has_filename() ? path : path.parent_path();
}

constexpr const char* kNew = "new";
constexpr std::size_t kRandomLetters = 6;  // of mkdtemp
constexpr const char* kReplaced = "replaced";
constexpr std::string_view kPartial = ".partial.";
constexpr std::string_view kBackup = ".backup.";

/// The lines of an export's list of what is missing; none if it misses nothing, nothing if the list cannot be read.
std::optional<std::set<std::string>> missingIn(const fs::path& folder) {
    std::set<std::string> lines;
    const fs::path file = folder / kMissingFile;
    if (!fs::exists(fs::symlink_status(file))) return lines;
    const auto text = readFile(file.string());
    if (!text) return std::nullopt;
    std::istringstream stream(*text);
    for (std::string line; std::getline(stream, line);) lines.insert(line);
    return lines;
}

/// May the export in `earlier` hold what the one in `fresh` lacks: samples that nobody looked at, what is damaged, or
/// what somebody wrote into a file?
bool holdsMore(const fs::path& earlier, const fs::path& fresh) {
    if (fs::exists(earlier / kSamplesFolder) && !fs::exists(fresh / kSamplesFolder)) return true;
    if (isEdited(earlier)) return true;
    const auto before = missingIn(earlier), now = missingIn(fresh);
    return !before || !now || !std::includes(before->begin(), before->end(), now->begin(), now->end());
}

/// Removes workshops of `folder` that no export works in any more.
void removeAbandoned(const fs::path& folder) {
    std::error_code ignored;
    const std::string start = folder.filename().string() + std::string(kPartial);
    const fs::path parent = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
    std::vector<fs::path> found;
    for (fs::directory_iterator entry(parent, ignored), end; !ignored && entry != end; entry.increment(ignored)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with(start) && name.size() == start.size() + kRandomLetters) found.push_back(entry->path());
    }
    for (const fs::path& workshop : found) {
        if (const auto lock = FolderLock::take(workshop)) fs::remove_all(workshop, ignored);
    }
}

}  // namespace

ExportFolder::ExportFolder(fs::path folder, std::vector<std::string> studies, bool group)
    : folder_(std::move(folder)), studies_(std::move(studies)), group_(group) {}

ExportFolder::ExportFolder(ExportFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      studies_(std::move(other.studies_)),
      group_(other.group_),
      lock_(std::move(other.lock_)),
      workshop_(std::move(other.workshop_)),
      sums_(std::move(other.sums_)) {
    other.workshop_.clear();
}

ExportFolder::~ExportFolder() {
    std::error_code ignored;
    if (!workshop_.empty()) fs::remove_all(workshop_, ignored);
}

Result<ExportFolder> ExportFolder::begin(const std::string& name, std::vector<std::string> studies, bool group) {
    const fs::path folder = plain(name);
    std::error_code error;
    if (folder.empty() || folder.filename() == "." || folder.filename() == "..") {
        return folderError(name, "name a folder of its own for the export");
    }
    if (const auto checked = checkReplaceable(folder, studies); !checked) return checked.errors();
    if (folder.has_parent_path()) fs::create_directories(folder.parent_path(), error);
    removeAbandoned(folder);
    std::string workshop = folder.string() + std::string(kPartial) + std::string(kRandomLetters, 'X');
    if (mkdtemp(workshop.data()) == nullptr) {
        return folderError(workshop, "cannot be created: " + std::generic_category().message(errno));
    }
    ExportFolder made(folder, std::move(studies), group);
    made.workshop_ = workshop;
    if (auto lock = FolderLock::take(workshop)) made.lock_.emplace(std::move(*lock));
    if (!fs::create_directory(made.workshop_ / kNew, error)) {
        return folderError(made.workshop_ / kNew, "cannot be created: " + error.message());
    }
    return made;
}

Result<Done> ExportFolder::write(const std::string& path, std::string_view bytes) {
    return writePieces(path, [bytes](const auto& take) {
        take(bytes);
        return Done{};
    });
}

Result<Done> ExportFolder::writePieces(const std::string& path, const Pieces& make) {
    const fs::path file = workshop_ / kNew / path;
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    std::ofstream stream(file, std::ios::binary);
    Sha256 sum;
    auto made = make([&](std::string_view piece) {
        stream.write(piece.data(), static_cast<std::streamsize>(piece.size()));
        sum.update(piece);
    });
    if (!made) return made;
    stream.close();
    if (!stream) return folderError(file, "cannot be written");
    sums_[path] = sum.hex();
    return Done{};
}

/// The workshop keeps others out meanwhile.
Result<Done> ExportFolder::closeToOthers() const {
    const auto file = fs::perms::owner_read | fs::perms::owner_write |
                      (group_ ? fs::perms::group_read | fs::perms::group_write : fs::perms::none);
    const auto folder = file | fs::perms::owner_exec | (group_ ? fs::perms::group_exec : fs::perms::none);
    std::error_code error;
    fs::permissions(workshop_ / kNew, folder, error);
    for (const auto& entry : fs::recursive_directory_iterator(workshop_ / kNew))
        if (!error) fs::permissions(entry.path(), entry.is_directory() ? folder : file, error);
    if (error) return folderError(workshop_ / kNew, "cannot be kept from others: " + error.message());
    return Done{};
}

/// Where the export that stands in the folder goes when the new one takes its place.
fs::path ExportFolder::placeOfEarlier() const {
    if (!holdsMore(folder_, workshop_ / kNew)) return workshop_ / kReplaced;
    int number = 1;
    const auto name = [&] { return fs::path(folder_.string() + std::string(kBackup) + std::to_string(number)); };
    while (fs::exists(fs::symlink_status(name()))) ++number;
    return name();
}

Result<Done> ExportFolder::writeSums() {
    sums_.erase(kSums);
    std::string sums;
    for (const auto& [path, sum] : sums_) sums += sum + "  " + path + "\n";
    auto written = write(kSums, sums);
    sums_.erase(kSums);
    return written;
}

Result<Done> ExportFolder::letAdd(const std::function<std::vector<std::string>(const fs::path&)>& work) {
    if (auto written = writeSums(); !written) return written;
    const fs::path place = fs::absolute(workshop_ / kNew);
    for (const std::string& added : work(place)) {
        const auto bytes = readFile((place / added).string());
        if (!bytes) return bytes.errors();
        sums_[added] = sha256Hex(*bytes);
    }
    if (auto written = writeSums(); !written) return written;
    std::error_code error;
    for (const fs::path& stranger : strangersIn(place)) fs::remove(stranger, error);
    std::vector<fs::path> empty;
    for (const auto& entry : fs::recursive_directory_iterator(place))
        if (entry.is_directory() && fs::is_empty(entry.path(), error)) empty.push_back(entry.path());
    for (const fs::path& folder : empty) fs::remove(folder, error);
    return Done{};
}

Result<std::string> ExportFolder::complete() {
    if (auto written = writeSums(); !written) return written.errors();
    if (auto closed = closeToOthers(); !closed) return closed.errors();

    // Somebody may have put a file there meanwhile.
    if (auto checked = checkReplaceable(folder_, studies_); !checked) return checked.errors();
    std::error_code error;
    const bool replaces = fs::exists(folder_, error) && !fs::is_empty(folder_, error);
    const fs::path old = replaces ? placeOfEarlier() : workshop_ / kReplaced;
    if (fs::exists(folder_, error)) fs::rename(folder_, old, error);
    if (!error) fs::rename(workshop_ / kNew, folder_, error);
    if (!error) return old.parent_path() == workshop_ ? std::string() : old.string();

    const std::string reason = error.message();
    if (fs::exists(old, error)) {
        fs::rename(old, folder_, error);
        if (error) {
            workshop_.clear();
            return folderError(old, "is the earlier export, which could not be put back: " + error.message());
        }
    }
    return folderError(folder_, "cannot be put in place: " + reason);
}

}  // namespace passung::exporter
