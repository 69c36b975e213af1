#include "analysis/export/export.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <random>

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

/// Whether somebody asked for it, and how.
Result<std::optional<exporter::Anonymity>> anonymityOf(const ExportArguments& options) {
    if (!options.anonymous) return std::optional<exporter::Anonymity>();
    exporter::Anonymity anonymity;
    for (const std::string& text : options.bands) {
        const auto band = exporter::readBand(text);
        if (!band) return band.errors();
        anonymity.bands.push_back(*band);
    }
    anonymity.least_persons = options.least_persons;
    std::random_device of_the_system;
    anonymity.seed = (std::uint64_t{of_the_system()} << 32) | of_the_system();
    return std::optional(anonymity);
}

Result<exporter::ExportOptions> optionsOf(const ExportArguments& options, ProgressLine& progress) {
    const auto anonymity = anonymityOf(options);
    if (!anonymity) return anonymity.errors();
    exporter::ExportOptions how;
    how.samples = !options.no_samples;
    how.psych_ds = options.format == "psych-ds";
    how.anonymity = *anonymity;
    how.group = options.group;
    how.progress = [&progress](double share) { progress.show(fmt::format("exporting: {:.0f} %", 100.0 * share)); };
    return how;
}

Result<store::StoreReader> openFor(const ExportArguments& options) {
    return store::StoreReader::open(options.database,
                                    options.no_samples ? store::Damaged::LeftOut : store::Damaged::LeftOutWithSamples);
}

void tellAnonymity(const ExportArguments& options) {
    if (options.anonymous)
        fmt::print(
            "{}/anonymity.csv: what was changed, and answers that point to somebody; codes of participants stay\n",
            options.out);
}

}  // namespace

int exportData(const ExportArguments& options) {
    ProgressLine progress;
    const auto how = optionsOf(options, progress);
    if (!how) return fail(how.errors());
    const auto reader = openFor(options);
    if (!reader) return fail(reader.errors());
    const auto report = exporter::exportAll(*reader, options.out, *how);
    if (!report) return fail(report.errors());
    progress.show("");
    noteExport(options, report->kept);
    fmt::print("{}: {} attempts in {} files\n", options.out, report->attempts, report->files);
    tellAnonymity(options);
    return tellDamages(options.database, reader->damages(), "left out, see missing.csv") ? 1 : 0;
}

int reportData(const ExportArguments& options) {
    ProgressLine progress;
    const auto how = optionsOf(options, progress);
    if (!how) return fail(how.errors());
    const auto reader = openFor(options);
    if (!reader) return fail(reader.errors());
    const auto outcome = report::writeReport(*reader, options.out, *how);
    progress.show("");
    if (!outcome) return fail(outcome.errors());
    noteExport(options, outcome->tables.kept);
    fmt::print("{}: {} attempts in {} files, planned analyses: {}\n", options.out, outcome->tables.attempts,
               outcome->tables.files, outcome->analyses);
    tellAnonymity(options);
    warn(options.out, outcome->said);
    const bool damaged = tellDamages(options.database, reader->damages(), "left out, see missing.csv");
    if (!outcome->failed.empty())
        return fail({{.message = "R made no report of it: " + outcome->failed, .file = options.out + "/analysis.Rmd"}});
    if (!outcome->missing.empty())
        fmt::print("report.html and results.json need what is not installed: {}\n", outcome->missing);
    return damaged ? 1 : 0;
}

}  // namespace passung::cli
