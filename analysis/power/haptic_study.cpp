#include "analysis/power/haptic_study.h"

#include "analysis/power/temporary_folder.h"
#include "study/run/machine/auto_accuracy.h"
#include "study/run/run_study.h"
#include "study/store/read/store_reader.h"

namespace passung::power {

Result<exporter::StudyData> hapticStudy(const plan::StudyPlan& plan, int participants) {
    if (run::asksForAccuracy(plan))
        return Error{.message = "differs from machine to machine; name the settings that it picked instead",
                     .file = plan.source_path,
                     .key = "contact.accuracy",
                     .value = "auto"};
    const TemporaryFolder folder;
    if (const auto made = folder.made(); !made) return made.errors();
    run::RunOptions options;
    options.database = (folder.path() / "study.db").string();
    options.simulated = participants;
    options.backup = false;
    if (const auto end = run::runStudy(plan, options, {}); !end) return end.errors();
    const auto reader = store::StoreReader::open(options.database);
    if (!reader) return reader.errors();
    return exporter::readStudy(*reader);
}

}  // namespace passung::power
