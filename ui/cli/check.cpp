#include <fmt/format.h>

#include "study/protocol/protocol_reader.h"
#include "study/session/participant_order.h"
#include "study/session/plan_text.h"
#include "ui/app/run_study.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

int check(const CheckOptions& options) {
    const auto plan = protocol::readProtocol(options.protocol, app::knownDevices(), app::knownMeasures());
    if (!plan) return fail(plan.errors());
    warn(options.protocol, session::planWarnings(*plan));
    const std::size_t trials = session::planTrials(*plan, 0, "S001").size();
    fmt::print("{}: ok: {} {}, {} conditions, {} trials for each of {} participants\n", options.protocol, plan->name,
               plan->version, plan->conditions.size(), trials, plan->participants);
    return 0;
}

}  // namespace passung::cli
