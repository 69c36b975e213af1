#include "study/run/machine/stage_cost.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>

#include "core/tick/pressed_run.h"
#include "study/protocol/plan_json.h"

namespace passung::run {

namespace {

constexpr int kMostTicks = 5 * TickCost::kWantedTicks;

/// Processor time of this thread [ns].
std::int64_t processorTime() noexcept {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

/// What asking for the time takes itself [ns].
std::int64_t timeOfAsking() {
    std::int64_t least = 1'000'000;
    for (int i = 0; i < 200; ++i) {
        const std::int64_t before = processorTime();
        least = std::min(least, processorTime() - before);
    }
    return std::max<std::int64_t>(least, 0);
}

/// Times of the stages of the ticks that count, tick by tick, all stages of a tick in a row, each over all hands [ns].
/// How the hands' parts push each other is worked out before the first stage that moves any, and counts to that.
class StageTimes {
public:
    StageTimes(std::span<const tick::Stage> stages, std::uint32_t cap)
        : stages_(stages), last_tick_(stages.size()), work_cap_(cap) {}

    /// One tick of the loop's own walk; true if parts touched.
    bool step(tick::PressedRun& run, const DeviceReading& reading) {
        const tick::StageWatch watch{&StageTimes::after, this};
        std::fill(last_tick_.begin(), last_tick_.end(), 0);
        last_ = processorTime();
        const tick::TickOutput output = run.step(reading, &watch);
        last_work_ = run.workDone(output);
        return output.frame.contacts > 0;
    }
    void count() {
        all_.insert(all_.end(), last_tick_.begin(), last_tick_.end());
        work_.push_back(last_work_);
    }

    const std::vector<std::int64_t>& all() const { return all_; }
    /// Of each tick that counts: the same in equal runs [units].
    const std::vector<std::uint32_t>& work() const { return work_; }
    /// Of a tick; 0: nothing caps it [units].
    std::uint32_t workCap() const { return work_cap_; }

private:
    static void after(void* context, const tick::Stage& stage) noexcept {
        auto& self = *static_cast<StageTimes*>(context);
        const std::int64_t took = std::max<std::int64_t>(processorTime() - self.last_ - self.asking_, 0);
        for (std::size_t i = 0; i < self.stages_.size(); ++i)
            if (self.stages_[i].run == stage.run) self.last_tick_[i] += took;
        self.last_ = processorTime();
    }

    std::span<const tick::Stage> stages_;
    std::vector<std::int64_t> last_tick_, all_;
    std::uint32_t work_cap_, last_work_ = 0;
    std::vector<std::uint32_t> work_;
    std::int64_t last_ = 0, asking_ = timeOfAsking();
};

/// One run; `contact`: of ticks in contact only.
StageTimes timesOfRun(const scene::Scene& scene, std::span<const tick::Stage> stages, bool contact) {
    constexpr int kApproachTicks = tick::PressedRun::kApproachTicks;
    tick::PressedRun run(scene);
    StageTimes times(stages, run.mostWork());
    int counted = 0;
    for (int i = 0; i < kApproachTicks + kMostTicks && counted < TickCost::kWantedTicks; ++i) {
        const bool touches = times.step(run, run.readingAt(i));
        if (i < kApproachTicks || (contact && !touches)) continue;
        times.count();
        ++counted;
    }
    return times;
}

/// What equal runs took.
struct RunTimes {
    std::vector<std::int64_t> least;  // time by time
    std::vector<std::uint32_t> work;
    std::uint32_t work_cap;
};

RunTimes leastTimes(const scene::Scene& scene, std::span<const tick::Stage> stages, bool contact) {
    const StageTimes first = timesOfRun(scene, stages, contact);
    RunTimes times{first.all(), first.work(), first.workCap()};
    std::vector<std::int64_t>& least = times.least;
    for (int run = 1; run < TickCost::kRuns && !least.empty(); ++run) {
        const StageTimes next = timesOfRun(scene, stages, contact);
        const std::vector<std::int64_t>& again = next.all();
        for (std::size_t i = 0; i < std::min(least.size(), again.size()); ++i) least[i] = std::min(least[i], again[i]);
    }
    return times;
}

/// Where the least-squares line through the ticks' times is at `work` [µs]; a line that falls counts as level.
double timeAt(double work, std::span<const std::int64_t> ticks, std::span<const std::uint32_t> works) {
    double mean_work = 0.0, mean_time = 0.0, across = 0.0, along = 0.0;
    const auto count = static_cast<double>(ticks.size());
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        mean_work += works[i] / count;
        mean_time += 1e-3 * static_cast<double>(ticks[i]) / count;
    }
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        const double w = works[i] - mean_work;
        across += w * (1e-3 * static_cast<double>(ticks[i]) - mean_time);
        along += w * w;
    }
    // Where all ticks did the same, as if all of their time were work.
    const double slope = along > 0.0 ? across / along : mean_time / std::max(mean_work, 1.0);
    return mean_time + std::max(slope, 0.0) * (work - mean_work);
}

/// The smallest of the times below or at which the share `q` of them lies [µs].
double quantileOf(std::vector<std::int64_t> times, double q) {
    if (times.empty()) return 0.0;
    const auto rank = static_cast<std::ptrdiff_t>(std::ceil(q * static_cast<double>(times.size()))) - 1;
    const auto at = times.begin() + std::max<std::ptrdiff_t>(rank, 0);
    std::nth_element(times.begin(), at, times.end());
    return 1e-3 * static_cast<double>(*at);
}

/// Geometry, resolution, method; stiffness, limits, task and display change no cost.
std::string costKey(plan::Condition condition) {
    condition.device.clear();
    condition.shown = plan::ShownPose::Proxy;
    condition.task = {};
    condition.comparison.reset();
    condition.cues = {};
    condition.secondary = {};
    condition.timed_by = plan::TimedBy::Program;
    scene::ContactSpec& contact = condition.scene.contact;
    contact.stiffness = contact.rotational_stiffness = contact.area_stiffness = contact.penalty_stiffness = 1.0;
    contact.tool_mass = contact.tool_inertia = 1.0;
    contact.damping = contact.rotational_damping = 0.0;
    scene::OutputLimits limits;
    limits.delay_ticks = condition.scene.limits.delay_ticks;
    condition.scene.limits = limits;
    std::string meshes;  // in full: files of one name in two folders differ
    for (const auto& part : condition.scene.parts)
        if (const auto* mesh = std::get_if<scene::MeshFile>(&part.geometry)) meshes += mesh->path + '\n';
    return protocol::paramsJson(condition) + meshes;
}

}  // namespace

std::vector<std::vector<const plan::Condition*>> costGroups(const plan::StudyPlan& plan) {
    std::vector<std::vector<const plan::Condition*>> groups;
    std::map<std::string, std::size_t> places;
    for (const auto& condition : plan.conditions) {
        const auto [place, fresh] = places.try_emplace(costKey(condition), groups.size());
        if (fresh) groups.emplace_back();
        groups[place->second].push_back(&condition);
    }
    return groups;
}

TickCost measureTick(const scene::Scene& scene) {
    const tick::SceneModels models(scene);
    const std::vector<tick::Stage> stages = models.stages(0);
    TickCost cost;
    cost.in_contact = scene.parts.size() > 1;
    RunTimes runs = leastTimes(scene, stages, cost.in_contact);
    if (runs.least.empty()) {
        cost.in_contact = false;
        runs = leastTimes(scene, stages, false);
    }
    const std::vector<std::int64_t>& times = runs.least;
    const std::size_t ticks = stages.empty() ? 0 : times.size() / stages.size();
    cost.ticks = static_cast<int>(ticks);
    std::vector<std::int64_t> whole(ticks, 0);
    for (std::size_t s = 0; s < stages.size(); ++s) {
        std::vector<std::int64_t> of_stage;
        for (std::size_t t = 0; t < ticks; ++t) {
            of_stage.push_back(times[t * stages.size() + s]);
            whole[t] += of_stage.back();
        }
        cost.stages.push_back(
            {stages[s].name, stages[s].reason, quantileOf(of_stage, 0.5), quantileOf(std::move(of_stage), 0.99)});
    }
    cost.work_cap = runs.work_cap;
    if (cost.work_cap > 0 && ticks > 0) {
        cost.most_work = *std::max_element(runs.work.begin(), runs.work.end());
        cost.at_cap_us = timeAt(cost.work_cap, whole, runs.work);
    }
    cost.median_us = quantileOf(whole, 0.5);
    cost.p99_us = quantileOf(whole, 0.99);
    cost.most_us = quantileOf(std::move(whole), 1.0);
    return cost;
}

}  // namespace passung::run
