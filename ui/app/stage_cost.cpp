#include "ui/app/stage_cost.h"

#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include "core/loop/timing.h"
#include "core/tick/obstacle_query.h"
#include "core/tick/step.h"
#include "study/protocol/plan_json.h"

namespace passung::app {

namespace {

constexpr int kApproachTicks = 500, kTicks = 2000;
constexpr double kPressed = 2e-3, kSlide = 3e-3;  // [m]

/// The motion of the held part that ends pressed into the nearest obstacle.
Vec3 wayToContact(const tick::TickModel& model, tick::TickState& state) {
    if (model.obstacles.empty()) return Vec3(0.02, 0.0, 0.0);
    state.scratch.clear();
    const tick::QueryAnswer answer =
        tick::queryObstacles(model, model.X_WG_start, {.search_below = 1.0}, state.workspace, state.scratch);
    return -(answer.phi + kPressed) * answer.normal_W;
}

/// Takes the time between the ends of neighbouring stages.
class StageTimes {
public:
    explicit StageTimes(std::size_t stages) : timing_(stages) {}

    /// One tick of the loop's own walk; `counted`: its times go into the distributions.
    void step(const tick::TickModel& model, tick::TickState& state, const DeviceReading& reading, bool counted) {
        counted_ = counted;
        const tick::StageWatch watch{&StageTimes::after, this};
        last_ = Clock::now();
        tick::step(model, state, reading, &watch);
    }

    const loop::TimingHistogram& of(std::size_t stage) const { return timing_[stage]; }

private:
    using Clock = std::chrono::steady_clock;

    static void after(void* context, std::size_t stage) noexcept {
        auto& self = *static_cast<StageTimes*>(context);
        const Clock::time_point now = Clock::now();
        if (self.counted_) self.timing_[stage].add(std::chrono::nanoseconds(now - self.last_).count());
        self.last_ = Clock::now();
    }

    std::vector<loop::TimingHistogram> timing_;
    Clock::time_point last_;
    bool counted_ = false;
};

/// Geometry, resolution, method; stiffness, limits, task and display change no cost.
std::string costKey(protocol::Condition condition) {
    condition.device.clear();
    condition.shown = protocol::ShownPose::Proxy;
    condition.task = {};
    condition.comparison.reset();
    condition.cues = {};
    condition.secondary = {};
    condition.timed_by = protocol::TimedBy::Program;
    model::ContactSpec& contact = condition.scene.contact;
    contact.stiffness = contact.rotational_stiffness = contact.area_stiffness = contact.penalty_stiffness = 1.0;
    contact.tool_mass = contact.tool_inertia = 1.0;
    contact.damping = contact.rotational_damping = 0.0;
    model::OutputLimits limits;
    limits.delay_ticks = condition.scene.limits.delay_ticks;
    condition.scene.limits = limits;
    std::string meshes;  // in full: files of one name in two folders differ
    for (const auto& part : condition.scene.parts)
        if (const auto* mesh = std::get_if<model::MeshFile>(&part.geometry)) meshes += mesh->path + '\n';
    return protocol::paramsJson(condition) + meshes;
}

}  // namespace

std::vector<std::vector<const protocol::Condition*>> costGroups(const protocol::StudyPlan& plan) {
    std::vector<std::vector<const protocol::Condition*>> groups;
    std::map<std::string, std::size_t> places;
    for (const auto& condition : plan.conditions) {
        const auto [place, fresh] = places.try_emplace(costKey(condition), groups.size());
        if (fresh) groups.emplace_back();
        groups[place->second].push_back(&condition);
    }
    return groups;
}

std::vector<StageCost> measureStages(const model::Scene& scene) {
    tick::TickModel model = tick::makeModel(scene);
    tick::TickState state = tick::makeState(model);
    const Vec3 way = wayToContact(model, state);
    // Poses are those of the held part: the registration has nothing to do, and the gate is open.
    model.registration = model::Registration{};
    state.engaged = true;
    StageTimes times(model.stages.size());
    const Vec3 aside = way.unitOrthogonal();
    for (int i = 0; i < kApproachTicks + kTicks; ++i) {
        const double share = std::min(1.0, static_cast<double>(i) / kApproachTicks);
        const double slide = kSlide * std::sin(2e-3 * std::numbers::pi * std::max(0, i - kApproachTicks));
        DeviceReading reading;
        reading.X_BD = {model.X_WG_start.q, model.X_WG_start.p + share * way + slide * aside};
        times.step(model, state, reading, i >= kApproachTicks);
    }
    std::vector<StageCost> costs;
    for (std::size_t s = 0; s < model.stages.size(); ++s) {
        costs.push_back({model.stages[s].name, model.stages[s].reason, times.of(s).quantileMicroseconds(0.5),
                         times.of(s).quantileMicroseconds(0.99)});
    }
    return costs;
}

}  // namespace passung::app
