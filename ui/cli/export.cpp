#include "analysis/export/export.h"

#include <fmt/format.h>

#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

int exportData(const ExportOptions& options) {
    const auto reader = store::StoreReader::open(options.database);
    if (!reader) return fail(reader.errors());
    ProgressLine progress;
    const auto report =
        exporter::exportAll(*reader, options.out, {.samples = !options.no_samples, .progress = [&](double share) {
                                                       progress.show(fmt::format("exporting: {:.0f} %", 100.0 * share));
                                                   }});
    if (!report) return fail(report.errors());
    progress.show("");
    fmt::print("{}: {} attempts in {} files\n", options.out, report->attempts, report->files);
    return 0;
}

}  // namespace passung::cli
