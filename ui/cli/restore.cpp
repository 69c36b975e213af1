#include "study/store/transfer/restore.h"

#include "study/run/files/wall_clock.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"
#include "ui/cli/other_program.h"
#include "ui/cli/restore_report.h"

namespace passung::cli {

int restore(const RestoreArguments& options) {
    if (store::isServer(options.from)) return becomePostgres("restore", options.database, options.from);
    const auto report = store::restoreDatabase(options.database, options.from, run::openOptionsNow());
    return report ? tellRestore(options.database, options.from, *report) : fail(report.errors());
}

}  // namespace passung::cli
