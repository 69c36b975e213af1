#pragma once

#include <gtest/gtest.h>

#include "core/scene/scene.h"
#include "core/tick/step.h"
#include "core/tick/tick_state.h"

namespace passung::test {

/// A scene held together with its model and state, driven by poses of the held part.
class Bench {
public:
    explicit Bench(const scene::SceneSpec& spec)
        : scene_(build(spec)), model_(tick::makeModel(scene_)), state_(tick::makeState(model_)) {}

    tick::TickOutput step(const Pose& X_WH) { return step(DeviceReading{X_WH}); }
    tick::TickOutput step(const DeviceReading& reading) { return tick::step(model_, state_, reading); }

    const scene::Scene& scene() const { return scene_; }
    /// Of the first hand.
    const tick::HandModel& model() const { return model_.hands.front(); }
    tick::HandState& state() { return state_.hands.front(); }
    const tick::TickModel& whole() const { return model_; }
    tick::TickState& wholeState() { return state_; }

private:
    static scene::Scene build(const scene::SceneSpec& spec) {
        static scene::PartCache cache;  // parts that tests of one program share are built once
        auto scene = scene::buildScene(spec, cache);
        if (!scene) ADD_FAILURE() << toString(scene.errors().front());
        return std::move(*scene);
    }
    scene::Scene scene_;
    tick::TickModel model_;
    tick::TickState state_;
};

/// No limits of the device that act.
inline void liftLimits(scene::SceneSpec& spec) {
    spec.limits.max_force = 1e4;
    spec.limits.max_torque = 1e4;
    spec.limits.max_force_rate = 1e12;
}

/// A held part over one fixed part, no limits that act and no start gate.
inline scene::SceneSpec scene(const shape::Shape& held, const Pose& X_WHeld, const shape::Shape& fixed,
                              const Pose& X_WFixed, scene::ContactMethod method) {
    scene::SceneSpec spec;
    spec.parts.push_back({.name = "held", .geometry = held, .X_WP = X_WHeld, .held = true});
    spec.parts.push_back({.name = "fixed", .geometry = fixed, .X_WP = X_WFixed});
    spec.contact.method = method;
    spec.contact.geometry = scene::Geometry::Field;
    spec.contact.cell = 0.5e-3;
    spec.contact.spacing = 1e-3;
    liftLimits(spec);
    return spec;
}

}  // namespace passung::test
