#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/export/anonymity.h"
#include "analysis/export/study_data.h"
#include "analysis/export/table.h"
#include "core/base/result.h"
#include "study/store/read/store_reader.h"

/// The folder's name is a word of the language, hence `exporter`.
namespace passung::exporter {

/// A file with its place in the export.
struct ExportedFile {
    std::string path;
    std::string bytes;
    std::string about = {};            // one sentence for the README; empty: none
    std::vector<Column> columns = {};  // of a table: what the codebook says of them
};

struct ExportOptions {
    bool samples = true;    // every recorded tick: some 100 kB per second of a trial
    bool psych_ds = false;  // tables in data/ under names of Psych-DS, with its dataset_description.json
    std::optional<Anonymity> anonymity = {};  // for others than the lab; none: everything as it is
    bool group = false;  // let the group of this user read and write the files too, not this user alone
    /// Called now and then with the share that is done, 0 … 1.
    std::function<void(double)> progress;
    /// Asked as often: true ends the export, which then leaves nothing; empty: never.
    std::function<bool()> cancelled = {};
    /// Further files, made of what the tables are made of; empty: none.
    std::function<Result<std::vector<ExportedFile>>(const StudyData& study)> more_files = {};
    /// Called in the folder when everything is written, SHA256SUMS too, before it takes its place. Of what it adds only
    /// the files stay that it names.
    std::function<std::vector<std::string>(const std::filesystem::path& folder)> in_folder = {};
};

struct ExportReport {
    std::size_t attempts = 0;
    std::size_t files = 0;
    std::size_t missing = 0;  // rows of missing.csv
    std::string kept = {};    // where the earlier export of this folder is now; empty: nothing had to be kept
};

/// Writes the whole study as files for people and statistics programs into the folder `out_dir`: tables as CSV (UTF-8,
/// RFC 4180, LF, NA for missing), a codebook, the protocols, README.md and SHA256SUMS. The same data gives the same
/// bytes. What the reader left out because it is damaged is listed in missing.csv. The folder appears complete or not
/// at all; an earlier export in its place is replaced, or kept as `out_dir`.backup.1, .2 … where it may hold what the
/// new one lacks; a folder with any other file is refused.
Result<ExportReport> exportAll(const store::StoreReader& reader, const std::string& out_dir,
                               const ExportOptions& options = {});

}  // namespace passung::exporter
