#include <fmt/format.h>

#include <optional>

#include "analysis/report/preregistration.h"
#include "core/base/regular_file.h"
#include "study/protocol/questionnaire_reader.h"
#include "study/run/files/known_names.h"
#include "study/run/files/protocol_files.h"
#include "study/run/machine/stability_report.h"
#include "study/session/participant_order.h"
#include "study/session/plan_text.h"
#include "study/session/staircase_text.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

/// A questionnaire's file by itself; nothing if it is none.
std::optional<int> checkQuestionnaire(const std::string& path) {
    const auto text = readFile(path);
    if (!text || !protocol::isQuestionnaire(*text, path)) return std::nullopt;
    const auto definition = protocol::readQuestionnaire(*text, path, "");
    if (!definition) return fail(definition.errors());
    fmt::print("{}: ok: {} {}, {} items, {} scales, {} golden vectors{}\n", path, definition->key, definition->version,
               definition->items.size(), definition->scales.size(), definition->golden.size(),
               definition->is_template ? ", a template for the lab's texts" : "");
    return 0;
}

}  // namespace

int check(const CheckArguments& options) {
    if (const auto code = checkQuestionnaire(options.protocol)) return *code;
    ProgressLine progress;
    auto [plan, errors, for_people] = progress.whileReading(
        options.protocol, [&] { return run::examineProtocol(options.protocol, options.import_limits); });
    for (const Errors& more : {run::beyondBorder(plan, run::knownDevices()), for_people})
        errors.insert(errors.end(), more.begin(), more.end());
    if (!errors.empty()) return fail(errors);
    warn(options.protocol, session::planWarnings(plan));
    std::size_t trials = 0;
    for (int session = 1; session <= plan::sessionsOf(plan); ++session) {
        const auto planned = session::planTrials(plan, {}, "S001", session);
        if (!planned) return fail(planned.errors());
        trials += planned->size();
    }
    fmt::print("{}: ok: {} {}, {} conditions, {}{} trials for each of {} participants\n", options.protocol, plan.name,
               plan.version, plan::plannedConditions(plan), session::mayEndEarly(plan) ? "at most " : "", trials,
               plan.participants);
    fmt::print("{}", session::staircasesText(plan));
    return 0;
}

int planStudy(const PlanArguments& options) {
    ProgressLine progress;
    const auto plan = progress.whileReading(options.protocol,
                                            [&] { return run::readProtocol(options.protocol, options.import_limits); });
    if (!plan) return fail(plan.errors());
    fmt::print("{}", report::preregistrationOf(*plan));
    return 0;
}

}  // namespace passung::cli
