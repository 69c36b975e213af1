#include "ui/app/stage_cost.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include "core/loop/timing.h"
#include "core/tick/penalty.h"
#include "core/tick/step.h"

namespace passung::app {

namespace {

constexpr int kApproachTicks = 500, kTicks = 2000;
constexpr double kPressed = 2e-3, kSlide = 3e-3;  // [m]

/// The motion of the held part that ends pressed into the nearest obstacle.
Vec3 wayToContact(const tick::TickModel& model, tick::TickState& state) {
    if (model.obstacles.empty()) return Vec3(0.02, 0.0, 0.0);
    state.scratch.clear();
    const tick::QueryAnswer answer =
        tick::queryObstacles(model, model.X_WG_start, 0.0, 1.0, state.workspace, state.scratch);
    return -(answer.phi + kPressed) * answer.normal_W;
}

}  // namespace

std::vector<StageCost> measureStages(const model::Scene& scene) {
    tick::TickModel model = tick::makeModel(scene);
    tick::TickState state = tick::makeState(model);
    const Vec3 way = wayToContact(model, state);
    // Poses are those of the held part: the registration has nothing to do, and the gate is open.
    model.registration = model::Registration{};
    state.engaged = true;
    std::vector<loop::TimingHistogram> timing(model.stages.size());
    const Vec3 aside = way.unitOrthogonal();
    for (int i = 0; i < kApproachTicks + kTicks; ++i) {
        tick::TickFrame frame;
        const double share = std::min(1.0, static_cast<double>(i) / kApproachTicks);
        const double slide = kSlide * std::sin(2e-3 * std::numbers::pi * std::max(0, i - kApproachTicks));
        frame.reading.X_BD = {model.X_WG_start.q, model.X_WG_start.p + share * way + slide * aside};
        for (std::size_t s = 0; s < model.stages.size(); ++s) {
            const auto begin = std::chrono::steady_clock::now();
            model.stages[s].run(model, state, frame);
            const auto took = std::chrono::steady_clock::now() - begin;
            if (i >= kApproachTicks) timing[s].add(took.count());
        }
        ++state.tick;
    }
    std::vector<StageCost> costs;
    for (std::size_t s = 0; s < model.stages.size(); ++s) {
        costs.push_back({model.stages[s].name, model.stages[s].reason, timing[s].quantileMicroseconds(0.5),
                         timing[s].quantileMicroseconds(0.99)});
    }
    return costs;
}

}  // namespace passung::app
