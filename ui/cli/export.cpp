#include "analysis/export/export.h"

#include <fmt/format.h>

#include "study/run/files/known_exports.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

int exportData(const ExportArguments& options) {
    const auto reader = store::StoreReader::open(
        options.database, options.no_samples ? store::Damaged::LeftOut : store::Damaged::LeftOutWithSamples);
    if (!reader) return fail(reader.errors());
    ProgressLine progress;
    const auto report = exporter::exportAll(
        *reader, options.out, {.samples = !options.no_samples, .group = options.group, .progress = [&](double share) {
                                   progress.show(fmt::format("exporting: {:.0f} %", 100.0 * share));
                               }});
    if (!report) return fail(report.errors());
    progress.show("");
    if (!report->kept.empty())
        warn(options.out, {"the earlier export may hold what this one lacks: kept as " + report->kept});
    const bool earlier_known = report->kept.empty() || run::rememberExport(options.database, report->kept);
    const bool known = run::rememberExport(options.database, options.out);
    if (!earlier_known || !known)
        warn(options.out, {"this export could not be noted in the folder of your data: erasing somebody will not name "
                           "it unless it lies beside the database"});
    fmt::print("{}: {} attempts in {} files\n", options.out, report->attempts, report->files);
    return tellDamages(options.database, reader->damages(), "left out, see missing.csv") ? 1 : 0;
}

}  // namespace passung::cli
