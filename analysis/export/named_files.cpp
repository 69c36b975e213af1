#include "analysis/export/named_files.h"

#include <algorithm>
#include <filesystem>

#include "analysis/export/shared_columns.h"
#include "core/base/digest.h"

namespace passung::exporter {
namespace {

namespace fs = std::filesystem;

std::string protocolPath(const std::string& sha256) { return "protocol/" + sha256 + ".toml"; }

/// Where the protocol looks for it, if that is beside it or in a folder of questionnaires; else a place there.
std::string wishedPath(const std::string& name) {
    const fs::path path = (fs::path("protocol") / name).lexically_normal();
    const std::string first = path.begin() == path.end() ? "" : path.begin()->string();
    const bool fits = !fs::path(name).is_absolute() && (first == "protocol" || first == "questionnaires") &&
                      path.has_filename() && path.has_parent_path();
    return fits ? path.string() : "questionnaires/" + fs::path(name).filename().string();
}

struct Placed {
    const store::NamedFileRow* row;
    std::string path;  // empty: the database has its hash only
};

/// Files of one path and another text get the hash of theirs into the name.
std::vector<Placed> placed(const StudyData& study) {
    std::vector<Placed> files;
    for (const store::NamedFileRow& row : study.files) {
        Placed file{&row, row.text ? wishedPath(row.name) : ""};
        const auto differs = [&](const Placed& other) {
            return other.path == file.path && other.row->text != row.text;
        };
        if (row.text && std::any_of(files.begin(), files.end(), differs)) {
            const fs::path path(file.path);
            file.path = (path.parent_path() /
                         (path.stem().string() + "_" + sha256Hex(*row.text).substr(0, 12) + path.extension().string()))
                            .string();
        }
        files.push_back(std::move(file));
    }
    return files;
}

/// A line of files.csv.
struct FileRow {
    std::string protocol_sha256, kind, name;
    std::optional<std::string> sha256;
    std::string path;  // empty: only its hash is stored
};

std::vector<FileRow> fileRows(const StudyData& study) {
    std::vector<FileRow> rows;
    for (const store::ProtocolRow& protocol : study.protocols)
        rows.push_back({protocol.sha256, "protocol", protocol.name, protocol.sha256, protocolPath(protocol.sha256)});
    for (const Placed& file : placed(study))
        rows.push_back({file.row->protocol_sha256, file.row->kind, file.row->name,
                        file.row->text ? sha256Hex(*file.row->text) : file.row->sha256, file.path});
    return rows;
}

}  // namespace

std::vector<ExportedFile> namedFiles(const StudyData& study) {
    std::vector<ExportedFile> files;
    for (const store::ProtocolRow& protocol : study.protocols)
        files.push_back({protocolPath(protocol.sha256), protocol.source_text});
    for (const Placed& file : placed(study)) {
        const bool known =
            std::any_of(files.begin(), files.end(), [&](const ExportedFile& other) { return other.path == file.path; });
        if (!file.path.empty() && !known) files.push_back({file.path, *file.row->text});
    }
    return files;
}

Table makeFiles(const StudyData& study) {
    const ColumnsOf<FileRow> columns = {
        protocolColumn<FileRow>(),
        {"kind",
         "What the file is",
         "text",
         &FileRow::kind,
         {.levels = {"protocol", "questionnaire", "questionnaire_texts", "mesh", "picture"}}},
        {"name", "As the protocol writes it", "text", &FileRow::name},
        {"sha256", "SHA-256 of its bytes", "text", &FileRow::sha256},
        {"path", "Where it is in this export; NA: only its hash is stored", "text", &FileRow::path}};
    return makeTable("files.csv",
                     "One row per protocol and per file that it names; files that it includes stand in its text.",
                     columns, fileRows(study));
}

}  // namespace passung::exporter
