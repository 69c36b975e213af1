#pragma once

#include <string>
#include <vector>

#include "analysis/export/export.h"

namespace passung::report {

struct ReportOutcome {
    exporter::ExportReport tables = {};
    std::string missing = {};            // command that installs what R lacks; empty: R ran
    std::string failed = {};             // last words of R where it made no report; empty: it did
    std::vector<std::string> said = {};  // lines of R: what it did not compute, warnings
    std::size_t analyses = 0;            // that the protocols plan
};

/// Writes an export into the folder `out_dir` as exporter::exportAll() does, and with it analysis.Rmd, the planned
/// analyses as a text of R that reads only what lies beside it, and what that needs. R, where it
/// is there with its packages, makes report.html and results.json of it; without it they are not there. No number about
/// the data is computed here.
Result<ReportOutcome> writeReport(const store::StoreReader& reader, const std::string& out_dir,
                                  const exporter::ExportOptions& options = {});

}  // namespace passung::report
