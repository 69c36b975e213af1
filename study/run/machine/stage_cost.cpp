#include "study/run/machine/stage_cost.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

#include "core/surface/nearest_faces.h"
#include "core/tick/closed_form_proxy.h"
#include "core/tick/obstacle_query.h"
#include "core/tick/step.h"
#include "study/protocol/plan_json.h"

namespace passung::run {

namespace {

constexpr int kApproachTicks = 500;
constexpr int kMostTicks = 5 * TickCost::kWantedTicks;
constexpr double kPressed = 2e-3, kSlide = 3e-3;  // [m]

constexpr double kNearest = 1e-3, kFarthest = 10.0;  // [m] in which a contact is looked for

/// The same among closed forms.
Vec3 wayToContact(const Pose& X_WG, tick::ClosedFormMemory& memory) {
    const closed_form::Contact* nearest = nullptr;
    closed_form::Contact best;
    for (double reach = kNearest; nearest == nullptr && reach < kFarthest; reach *= 2.0)
        for (closed_form::ContactSearch& search : memory.at_hand) {
            search.find(X_WG, reach, memory.found);
            for (const closed_form::Contact& contact : memory.found.all()) {
                if (nearest != nullptr && best.gap <= contact.gap) continue;
                best = contact;
                nearest = &best;
            }
        }
    return -(best.gap + kPressed) * best.normal.stableNormalized();
}

/// The motion of the held part that ends pressed into the nearest obstacle.
Vec3 wayToContact(const tick::TickModel& model, tick::TickState& state) {
    if (model.obstacles.empty()) return Vec3(0.02, 0.0, 0.0);
    if (model.hasClosedForm()) return wayToContact(model.X_WG_start, state);
    if (model.hasSurfaces()) {
        const auto nearest = surface::nearestFaces(model.surfaces[0], model.surfaces[1], model.X_WG_start);
        return -(nearest.distance + kPressed) * nearest.n;
    }
    state.scratch.clear();
    const contact::QueryAnswer answer =
        tick::queryObstacles(model, model.X_WG_start, {.search_below = 1.0}, state.workspace, state.scratch);
    return -(answer.phi + kPressed) * answer.normal_W;
}

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

/// Times of the stages of the ticks that count, tick by tick, all stages of a tick in a row [ns].
class StageTimes {
public:
    explicit StageTimes(std::size_t stages) : last_tick_(stages) {}

    /// One tick of the loop's own walk; true if parts touched.
    bool step(const tick::TickModel& model, tick::TickState& state, const DeviceReading& reading) {
        const tick::StageWatch watch{&StageTimes::after, this};
        std::fill(last_tick_.begin(), last_tick_.end(), 0);
        last_ = processorTime();
        return tick::step(model, state, reading, &watch).frame.contacts > 0;
    }
    void count() { all_.insert(all_.end(), last_tick_.begin(), last_tick_.end()); }

    const std::vector<std::int64_t>& all() const { return all_; }

private:
    static void after(void* context, std::size_t stage) noexcept {
        auto& self = *static_cast<StageTimes*>(context);
        self.last_tick_[stage] = std::max<std::int64_t>(processorTime() - self.last_ - self.asking_, 0);
        self.last_ = processorTime();
    }

    std::vector<std::int64_t> last_tick_, all_;
    std::int64_t last_ = 0, asking_ = timeOfAsking();
};

/// The times of one run; `contact`: of ticks in contact only.
std::vector<std::int64_t> timesOfRun(const scene::Scene& scene, bool contact) {
    tick::TickModel model = tick::makeModel(scene);
    tick::TickState state = tick::makeState(model);
    const Vec3 way = wayToContact(model, state);
    // Poses are those of the held part: the registration has nothing to do, and the gate is open.
    model.registration = scene::Registration{};
    state.engaged = true;
    StageTimes times(model.stages.size());
    const Vec3 aside = way.unitOrthogonal();
    int counted = 0;
    for (int i = 0; i < kApproachTicks + kMostTicks && counted < TickCost::kWantedTicks; ++i) {
        const double share = std::min(1.0, static_cast<double>(i) / kApproachTicks);
        const double slide = kSlide * std::sin(2e-3 * std::numbers::pi * std::max(0, i - kApproachTicks));
        DeviceReading reading;
        reading.X_BD = {model.X_WG_start.q, model.X_WG_start.p + share * way + slide * aside};
        const bool touches = times.step(model, state, reading);
        if (i < kApproachTicks || (contact && !touches)) continue;
        times.count();
        ++counted;
    }
    return times.all();
}

/// The least of equal runs, time by time.
std::vector<std::int64_t> leastTimes(const scene::Scene& scene, bool contact) {
    std::vector<std::int64_t> least = timesOfRun(scene, contact);
    for (int run = 1; run < TickCost::kRuns && !least.empty(); ++run) {
        const std::vector<std::int64_t> again = timesOfRun(scene, contact);
        for (std::size_t i = 0; i < std::min(least.size(), again.size()); ++i) least[i] = std::min(least[i], again[i]);
    }
    return least;
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
    const tick::TickModel model = tick::makeModel(scene);
    const std::size_t stages = model.stages.size();
    TickCost cost;
    cost.in_contact = !model.obstacles.empty();
    std::vector<std::int64_t> times = leastTimes(scene, cost.in_contact);
    if (times.empty()) {
        cost.in_contact = false;
        times = leastTimes(scene, false);
    }
    const std::size_t ticks = stages == 0 ? 0 : times.size() / stages;
    cost.ticks = static_cast<int>(ticks);
    std::vector<std::int64_t> whole(ticks, 0);
    for (std::size_t s = 0; s < stages; ++s) {
        std::vector<std::int64_t> of_stage;
        for (std::size_t t = 0; t < ticks; ++t) {
            of_stage.push_back(times[t * stages + s]);
            whole[t] += of_stage.back();
        }
        cost.stages.push_back({model.stages[s].name, model.stages[s].reason, quantileOf(of_stage, 0.5),
                               quantileOf(std::move(of_stage), 0.99)});
    }
    cost.median_us = quantileOf(whole, 0.5);
    cost.p99_us = quantileOf(whole, 0.99);
    cost.most_us = quantileOf(std::move(whole), 1.0);
    return cost;
}

}  // namespace passung::run
