#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "analysis/truth/accuracy_tick_tables.h"
#include "study/run/files/builds.h"
#include "study/run/files/protocol_files.h"
#include "study/run/machine/front_file.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

/// Those that are to be measured; by default the first that the program times.
Result<std::vector<const plan::Condition*>> chosenConditions(const plan::StudyPlan& plan,
                                                             const AccuracyArguments& options) {
    std::vector<const plan::Condition*> chosen;
    for (const std::string& name : options.conditions) {
        const auto found = std::find_if(plan.conditions.begin(), plan.conditions.end(),
                                        [&](const plan::Condition& condition) { return condition.name == name; });
        if (found == plan.conditions.end())
            return Error{.message = "the study has no condition of this name", .file = options.field, .value = name};
        chosen.push_back(&*found);
    }
    if (!chosen.empty()) return chosen;
    for (const plan::Condition& condition : plan.conditions)
        if (chosen.empty() && condition.timed_by == plan::TimedBy::Program) chosen.push_back(&condition);
    if (chosen.empty())
        return Error{.message = "all trials of the study are done with real parts: no tick to measure",
                     .file = options.field};
    return chosen;
}

/// "about 3 min left"; nothing while it is too early to tell.
std::string timeLeft(std::chrono::duration<double> passed, double share) {
    constexpr double kEarly = 5.0, kLeastShare = 0.03;
    if (passed.count() < kEarly || share < kLeastShare) return {};
    const double left = passed.count() * (1.0 - share) / share;
    return left < 60.0 ? fmt::format(", about {:.0f} s left", std::ceil(left / 10.0) * 10.0)
                       : fmt::format(", about {:.0f} min left", std::ceil(left / 60.0));
}

void print(const plan::Condition& condition, const run::TickFront& front, const run::FrontOrigin& origin) {
    fmt::print("{}: {} ticks along {}\n", condition.name, front.ticks,
               front.path == run::HandPath::Origin::SimulatedHand
                   ? "a simulated hand's way in a trial"
                   : "a way on which the held part is pressed into the nearest obstacle and slides");
    fmt::print("measured {}by passung {}{} on {}: {}\n", origin.elsewhere ? "on another machine " : "", origin.program,
               origin.commit.empty() ? "" : " (" + origin.commit + ")", origin.date, origin.machine);
    if (origin.outdated) fmt::print("the condition has changed since then\n");
    fmt::print("{}", truth::tickText(front.measured));
    for (const std::string& why : front.left_out) fmt::print("left out: {}\n", why);
}

int show(const plan::StudyPlan& plan, const AccuracyArguments& options) {
    const auto file = run::readFronts(options.field);
    if (!file) return fail(file.errors());
    bool any = false;
    for (const plan::Condition& condition : plan.conditions) {
        if (!*file) break;
        const auto front = run::frontOf(**file, condition);
        if (!front) continue;
        print(condition, *front, run::originOf(**file, condition));
        any = true;
    }
    if (any) return 0;
    return fail({{.message = "has no measured front of a condition of the study: `passung accuracy " + options.field +
                             " --measure` measures one, which takes minutes",
                  .file = run::frontPath(options.field)}});
}

}  // namespace

int studyAccuracy(const AccuracyArguments& options) {
    const auto plan = run::readProtocol(options.field, options.import_limits);
    if (!plan) return fail(plan.errors());
    warn(options.field, plan->warnings);
    if (!options.measure) return show(*plan, options);
    const auto chosen = chosenConditions(*plan, options);
    if (!chosen) return fail(chosen.errors());
    const auto builds = run::openBuilds(options.import_limits);
    run::FrontFile file = run::newFrontFile(options.commit);
    ProgressLine progress;
    for (const plan::Condition* condition : *chosen) {
        fmt::print("measuring the tick of {} with every method and geometry; this may take minutes\n", condition->name);
        std::fflush(stdout);
        const auto begun = std::chrono::steady_clock::now();
        const auto watch = [&](const run::FrontProgress& now) {
            const std::string what =
                now.setting != nullptr ? truth::settingText(*now.setting) : std::string("the hand's path");
            progress.show(progressBar(what + timeLeft(std::chrono::steady_clock::now() - begun, now.share), now.share));
            return true;
        };
        auto front = run::measureFront(*condition, {.repetitions = options.repetitions, .every = options.every}, watch,
                                       builds.get());
        if (!front) return fail(front.errors());
        progress.show("");
        print(*condition, *front, {file.program, file.commit, file.machine, file.date, false, false});
        file.fronts.push_back({condition->name, run::conditionMark(*condition), *std::move(front)});
    }
    OutputFile out(run::frontPath(options.field));
    out.write(run::frontFileText(file));
    if (const auto done = out.commit(); !done) return fail(done.errors());
    fmt::print("{}\n", run::frontPath(options.field));
    return 0;
}

}  // namespace passung::cli
