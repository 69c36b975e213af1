#include "analysis/power/power_runs.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <mutex>
#include <thread>

#include "analysis/power/drop_out.h"
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
    job.against = effect.at.front().against;
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
    const std::size_t at_once = studiesAtOnce(effect, job.test);
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;  // of done and errors
    std::size_t done = 0;
    Errors errors;
    const auto advance = [&](const Errors& found) {
        const std::lock_guard lock(mutex);
        if (errors.empty()) errors = found;
        if (!errors.empty()) return false;
        ++done;
        if (progress) progress(static_cast<double>(done) / static_cast<double>(result.tests.size()));
        return true;
    };
    const auto work = [&] {
        plan::StudyPlan own = plan;
        for (std::size_t first; (first = next.fetch_add(at_once)) < result.tests.size();) {
            const std::size_t end = std::min(first + at_once, result.tests.size());
            std::vector<exporter::StudyData> studies;
            for (std::size_t i = first; i < end; ++i) {
                own.seed = runSeed(plan, result.tests[i].run);
                auto study = perform(own, job.participants);
                if (!advance(study ? Errors{} : study.errors())) return;
                dropOut(job.drop_out, own.seed, *study);
                plant(effect, own.seed, *study);
                studies.push_back(*std::move(study));
            }
            const auto tests = testEffect(effect, job.test, plan, studies);
            if (!tests) {
                advance(tests.errors());
                return;
            }
            for (std::size_t i = first; i < end; ++i) result.tests[i].test = (*tests)[i - first];
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
