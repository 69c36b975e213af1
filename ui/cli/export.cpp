#include "analysis/export/export.h"

#include <fmt/format.h>

#include "analysis/report/report.h"
#include "study/run/files/known_exports.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

/// Notes a new export, and where the earlier one is `kept` (empty: nowhere), for whoever is erased later.
void noteExport(const ExportArguments& options, const std::string& kept) {
    if (!kept.empty()) warn(options.out, {"the earlier export may hold what this one lacks: kept as " + kept});
    const bool earlier_known = kept.empty() || run::rememberExport(options.database, kept);
    const bool known = run::rememberExport(options.database, options.out);
    if (!earlier_known || !known)
        warn(options.out, {"this export could not be noted in the folder of your data: erasing somebody will not name "
                           "it unless it lies beside the database"});
}

}  // namespace

int exportData(const ExportArguments& options) {
    const auto reader = store::StoreReader::open(
        options.database, options.no_samples ? store::Damaged::LeftOut : store::Damaged::LeftOutWithSamples);
    if (!reader) return fail(reader.errors());
    ProgressLine progress;
    const auto report = exporter::exportAll(
        *reader, options.out,
        {.samples = !options.no_samples,
         .psych_ds = options.format == "psych-ds",
         .group = options.group,
         .progress = [&](double share) { progress.show(fmt::format("exporting: {:.0f} %", 100.0 * share)); }});
    if (!report) return fail(report.errors());
    progress.show("");
    noteExport(options, report->kept);
    fmt::print("{}: {} attempts in {} files\n", options.out, report->attempts, report->files);
    return tellDamages(options.database, reader->damages(), "left out, see missing.csv") ? 1 : 0;
}

int reportData(const ExportArguments& options) {
    const auto reader = store::StoreReader::open(
        options.database, options.no_samples ? store::Damaged::LeftOut : store::Damaged::LeftOutWithSamples);
    if (!reader) return fail(reader.errors());
    ProgressLine progress;
    const auto outcome = report::writeReport(
        *reader, options.out, {.samples = !options.no_samples, .group = options.group, .progress = [&](double share) {
                                   progress.show(fmt::format("exporting: {:.0f} %", 100.0 * share));
                               }});
    progress.show("");
    if (!outcome) return fail(outcome.errors());
    noteExport(options, outcome->tables.kept);
    fmt::print("{}: {} attempts in {} files, planned analyses: {}\n", options.out, outcome->tables.attempts,
               outcome->tables.files, outcome->analyses);
    warn(options.out, outcome->said);
    const bool damaged = tellDamages(options.database, reader->damages(), "left out, see missing.csv");
    if (!outcome->failed.empty())
        return fail({{.message = "R made no report of it: " + outcome->failed, .file = options.out + "/analysis.Rmd"}});
    if (!outcome->missing.empty())
        fmt::print("report.html and results.json need what is not installed: {}\n", outcome->missing);
    return damaged ? 1 : 0;
}

}  // namespace passung::cli
