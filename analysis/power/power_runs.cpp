#include "analysis/power/power_runs.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <mutex>
#include <thread>

#include "core/base/digest.h"
#include "core/base/random.h"

namespace passung::power {

PowerJob describeJob(const plan::StudyPlan& plan, const PlantedEffect& effect, const std::string& test) {
    std::string all = plan.source_text + plan.expanded_json;
    for (const plan::Condition& condition : plan.conditions) all += condition.params_json;
    PowerJob job;
    job.study = plan.name + ' ' + plan.version;
    job.plan_sha256 = sha256Hex(all);
    job.seed = plan.seed;
    job.measure = effect.measure;
    job.against = effect.against;
    job.test = test;
    return job;
}

std::uint64_t runSeed(const plan::StudyPlan& plan, std::int64_t run) {
    std::uint64_t state = streamSeed(plan.name, "", "power", std::to_string(run), plan.seed);
    return splitmix64(state);
}

Result<PowerResult> runShard(const PowerJob& job, const Shard& shard, const PlantedEffect& effect,
                             const plan::StudyPlan& plan, const Perform& perform,
                             const std::function<void(double)>& progress) {
    PowerResult result{job, shard, {}};
    for (std::int64_t run = 0; run < job.repeats; ++run)
        if (shard.has(run)) result.tests.push_back({run, {}});
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;  // of done and errors
    std::size_t done = 0;
    Errors errors;
    const auto work = [&] {
        plan::StudyPlan own = plan;
        for (std::size_t i; (i = next++) < result.tests.size();) {
            own.seed = runSeed(plan, result.tests[i].run);
            auto study = perform(own, job.participants);
            if (study) {
                plant(effect, own.seed, *study);
                result.tests[i].test = testEffect(effect, job.test, plan, *study);
            }
            const std::lock_guard lock(mutex);
            if (!study && errors.empty()) errors = study.errors();
            if (!errors.empty()) return;
            ++done;
            if (progress) progress(static_cast<double>(done) / static_cast<double>(result.tests.size()));
        }
    };
    std::vector<std::future<void>> workers;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
        workers.push_back(std::async(std::launch::async, work));
    for (auto& worker : workers) worker.get();
    if (!errors.empty()) return errors;
    return result;
}

}  // namespace passung::power
