#include "ui/cli/commands.h"
#include "ui/cli/other_program.h"

namespace passung::cli {

int push(const PushArguments& options) { return becomePostgres("push", options.database, options.to); }

}  // namespace passung::cli
