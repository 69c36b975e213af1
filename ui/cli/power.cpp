#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "analysis/power/haptic_study.h"
#include "analysis/power/model_study.h"
#include "analysis/power/power_file.h"
#include "analysis/power/power_runs.h"
#include "analysis/power/power_summary.h"
#include "core/base/regular_file.h"
#include "study/run/files/protocol_files.h"
#include "study/session/plan_text.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

constexpr const char* kModel = "model";

Result<power::PowerResult> readResult(const std::string& file) {
    const auto text = readFile(file);
    if (!text) return text.errors();
    return power::readPowerText(*text, file);
}

Result<Done> writeResult(const power::PowerResult& result, const std::string& file) {
    OutputFile out(file);
    out.write(power::powerText(result));
    return out.commit();
}

int mergeFiles(const PowerArguments& options) {
    if (!options.out.empty())
        if (const auto fine = refuseOverwriting(options.out, options.merge); !fine) return fail(fine.errors());
    std::vector<power::PowerResult> shards;
    for (const std::string& file : options.merge) {
        auto shard = readResult(file);
        if (!shard) return fail(shard.errors());
        shards.push_back(*std::move(shard));
    }
    const auto whole = power::merge(shards, options.merge);
    if (!whole) return fail(whole.errors());
    if (!options.out.empty())
        if (const auto done = writeResult(*whole, options.out); !done) return fail(done.errors());
    fmt::print("{}", power::summaryText(*whole));
    return 0;
}

/// The result that an earlier run left in the file, if there is one; an error if it is something else.
Result<std::optional<power::PowerResult>> finishedBefore(const PowerArguments& options, const power::PowerJob& job,
                                                         const power::Shard& shard) {
    std::error_code none;
    if (options.out.empty() || !std::filesystem::exists(options.out, none)) return std::optional<power::PowerResult>{};
    auto earlier = readResult(options.out);
    if (!earlier) return earlier.errors();
    if (!(earlier->job == job) || !(earlier->shard == shard))
        return Error{.message = "holds another job or shard; name another file", .file = options.out, .key = "--out"};
    return std::optional(*std::move(earlier));
}

}  // namespace

int power(const PowerArguments& options) {
    if (!options.merge.empty()) return mergeFiles(options);
    auto plan = run::readProtocol(options.protocol);
    if (!plan) return fail(plan.errors());
    warn(options.protocol, session::planWarnings(*plan));
    if (options.seed) plan->seed = *options.seed;
    const auto effect = power::readEffect(options.effect, options.against, options.measure, *plan);
    if (!effect) return fail(effect.errors());
    const bool model = options.simulation == kModel;
    if (model && std::find(power::kModelMeasures.begin(), power::kModelMeasures.end(), options.measure) ==
                     power::kModelMeasures.end())
        return fail({{.message = fmt::format("the model has {} only", fmt::join(power::kModelMeasures, ", ")),
                      .key = "--measure",
                      .value = options.measure}});

    const auto test = power::chooseTest(options.test, *effect, *plan);
    if (!test) return fail(test.errors());
    power::PowerJob job = power::describeJob(*plan, *effect, *test);
    job.program = PASSUNG_VERSION;
    job.simulation = options.simulation;
    job.participants = options.participants > 0 ? options.participants : plan->participants;
    job.repeats = options.repeats;
    job.drop_out = options.drop_out;
    job.effect = options.effect;
    job.alpha = options.alpha;
    const power::Shard shard{options.shard, options.shards};
    const auto earlier = finishedBefore(options, job, shard);
    if (!earlier) return fail(earlier.errors());
    if (*earlier) {
        fmt::print("{} is complete; nothing was run\n{}", options.out, power::summaryText(**earlier));
        return 0;
    }
    const auto perform = [&](const plan::StudyPlan& own, int participants) -> Result<exporter::StudyData> {
        if (model) return power::modelStudy(own, participants);
        return power::hapticStudy(own, participants);
    };
    ProgressLine progress;
    const auto result = power::runShard(job, shard, *effect, *plan, perform,
                                        [&](double share) { progress.show(progressBar("virtual studies", share)); });
    progress.show("");
    if (!result) return fail(result.errors());
    if (!options.out.empty())
        if (const auto done = writeResult(*result, options.out); !done) return fail(done.errors());
    fmt::print("{}", power::summaryText(*result));
    return 0;
}

}  // namespace passung::cli
