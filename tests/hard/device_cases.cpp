#include "tests/hard/device_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/loop/stability.h"
#include "devices/simulated/device_dynamics.h"
#include "devices/simulated/hand_params.h"
#include "tests/hard/figures.h"
#include "tests/hard/paths.h"

namespace passung::hard {

namespace {

using scene::SceneSpec;

scene::OutputLimits limitsOf(const simulated::DeviceParams& p, scene::OutputLimits limits) {
    limits.max_force = p.max_force.value;
    limits.max_torque = p.max_torque.value;
    limits.max_force_rate = p.max_force_rate.value;
    limits.actuates_torque = p.actuated_degrees == 6;
    return limits;
}

/// All presets, and last one whose handle nothing but its own damping stops.
simulated::DeviceParams deviceAtRest(std::uint64_t seed) {
    const auto& presets = simulated::presets();
    if (seed >= 1 && seed <= presets.size()) return presets[seed - 1];
    simulated::DeviceParams sigma = *simulated::findPreset("sigma7");
    if (seed == 0) return sigma;
    for (auto* s : {&sigma.coulomb_force, &sigma.coulomb_torque, &sigma.quantum, &sigma.rotational_quantum})
        s->value = 0.0;
    return sigma;
}

/// Every preset with a delay of 0 to 3 ticks, at 0.95 times its own border.
struct Station {
    const simulated::DeviceParams* preset;
    int delay;
};

Station stationOf(std::uint64_t seed) {
    const auto& presets = simulated::presets();
    if (seed == 0) return {simulated::findPreset("sigma7"), 0};  // as the scene's file says
    return {&presets[((seed - 1) / 4) % presets.size()], static_cast<int>((seed - 1) % 4)};
}

simulated::DeviceParams paramsOf(const Station& station) {
    simulated::DeviceParams params = *station.preset;
    params.delay_ticks = station.delay;
    return params;
}

loop::SampledWall wallOf(const simulated::DeviceParams& p) {
    return {.mass = p.mass.value,
            .damping = p.damping.value,
            .virtual_damping = p.recommended_damping.value,
            .period = kTickSeconds,
            .delay_ticks = p.delay_ticks};
}

void feltBy(const simulated::DeviceParams& p, double stiffness, SceneSpec& spec) {
    spec.contact.stiffness = stiffness;
    spec.contact.damping = p.recommended_damping.value;
    spec.contact.rotational_stiffness = 0.0;
    spec.contact.rotational_damping = 0.0;
    spec.limits = limitsOf(p, spec.limits);
}

void atTheBorder(SceneSpec& spec, std::uint64_t seed) {
    const simulated::DeviceParams p = paramsOf(stationOf(seed));
    feltBy(p, 0.95 * stableStiffnessBorder(wallOf(p)), spec);
}

/// The coupling of a virtual tool, a tenth as heavy as the handle, against contacts twice as stiff as a rigid wall's
/// border.
void atTheToolsBorder(SceneSpec& spec, std::uint64_t seed) {
    const simulated::DeviceParams p = paramsOf(stationOf(seed));
    const loop::SampledTool tool{.wall = wallOf(p),
                                 .contact_stiffness = 2.0 * stableStiffnessBorder(wallOf(p)),
                                 .tool_mass = 0.1 * p.mass.value};
    feltBy(p, 0.95 * stableStiffnessBorder(tool), spec);
    spec.contact.penalty_stiffness = tool.contact_stiffness;
    spec.contact.tool_mass = tool.tool_mass;
    spec.contact.tool_inertia = 0.1 * p.inertia.value;
}

Drive pressedHandle(const SceneSpec& spec, std::uint64_t seed) {
    const simulated::DeviceParams params = paramsOf(stationOf(seed));
    simulated::DeviceDynamics dynamics(params, heldPart(spec).X_WP);
    dynamics.place(heldPart(spec).X_WP, {{0, 0, -0.1}, Vec3::Zero()});
    simulated::HandCoupling hand;
    hand.attached = true;
    hand.F_D_B.force = Vec3(0, 0, -0.3 * params.max_force.value);
    return [=](std::int64_t, const tick::TickOutput* last) mutable {
        if (last != nullptr) {
            dynamics.command(last->F_D_B);
            dynamics.advance(hand);
        }
        return DeviceReading{dynamics.readPose()};
    };
}

/// Swing of the handle in the last second above that in the second one, encoder steps excepted [µm]: the largest of
/// such a step keeps it swinging by some of them.
Judgement swingGrowth(const Run& run) {
    const auto swing = [&](std::size_t first) {
        double low = 1e300, high = -1e300;
        for (std::size_t i = first; i < first + 1000; ++i) {
            low = std::min(low, run.ticks[i].device.p.z());
            high = std::max(high, run.ticks[i].device.p.z());
        }
        return high - low;
    };
    double quantum = 0.0;
    for (const simulated::DeviceParams& p : simulated::presets())
        if (p.max_force.value == run.spec.limits.max_force) quantum = std::max(quantum, p.quantum.value);
    const double late = swing(run.ticks.size() - 1000);
    Judgement result{kUm * (late - swing(1000) - 3.0 * quantum)};
    if (late > 1e-3) result.broken = fmt::format("swings by {:.3g} mm", 1e3 * late);
    bool touches = false;
    for (const Tick& t : run.ticks) touches = touches || t.sent.force.z() > 0.0;
    if (!touches) result.broken = "no contact";
    return result;
}

// ---- rest -----------------------------------------------------------------------------------------------------------

/// So stiff and undamped that, by theory, nothing can go on swinging: neither the delay of sampling nor the encoder's
/// steps give out more than friction takes (loop/stability.h). Axes without torque are not rendered.
void atRest(SceneSpec& spec, std::uint64_t seed) {
    const simulated::DeviceParams p = deviceAtRest(seed);
    const loop::SampledWall wall{.mass = p.mass.value, .damping = p.damping.value, .delay_ticks = p.delay_ticks};
    const loop::SampledWall turn{
        .mass = p.inertia.value, .damping = p.rotational_damping.value, .delay_ticks = p.delay_ticks};
    spec.contact.stiffness = 0.95 * passiveStiffness(wall, p.coulomb_force.value, p.quantum.value);
    spec.contact.rotational_stiffness =
        p.actuated_degrees < 6 ? 0.0
                               : 0.95 * passiveStiffness(turn, p.coulomb_torque.value, p.rotational_quantum.value);
    spec.limits = limitsOf(p, spec.limits);
}

/// Down onto the table, leaning a little, within the first quarter of a second; held.
Drive press(const SceneSpec& spec, std::uint64_t seed) {
    const Pose start = heldPart(spec).X_WP;
    Walk walk(start);
    walk.to({(rotationFromVector(Vec3(0.02, 0.05, 0.1)) * start.q).normalized(), start.p - Vec3(0, 0, 7e-3)}, 0.03);
    return inHand(deviceAtRest(seed), start, walk.drive(Pose{}));
}

/// Motion of handle and proxy from the third second on [µm], which have to be in contact, without energy given out.
Judgement drift(const Run& run) {
    constexpr std::size_t kFrom = 3000;
    const double radius = 0.02;
    Judgement result;
    const Tick& first = run.ticks[kFrom];
    const auto way = [&](const Pose& a, const Pose& b) {
        return kUm * ((a.p - b.p).norm() + radius * rotationVector(a.q * b.q.conjugate()).norm());
    };
    double given = 0.0;
    for (std::size_t i = kFrom; i < run.ticks.size(); ++i) {
        const Tick& t = run.ticks[i];
        result.value = std::max({result.value, way(t.device, first.device), way(t.proxy, first.proxy)});
        given = std::max(given, first.energy - t.energy);
    }
    if (given > 1e-9) result.broken = fmt::format("{:.3g} J given out at rest", given);
    if (!(first.sent.force.norm() > 0.1)) result.broken = "not pressed";
    return result;
}

}  // namespace

Drive inHand(const simulated::DeviceParams& device, const Pose& start, Drive path) {
    const simulated::HandParams arm;
    simulated::HandCoupling hand{.attached = true,
                                 .mass = arm.mass,
                                 .inertia = arm.inertia,
                                 .stiffness = arm.stiffness,
                                 .damping = arm.damping,
                                 .rotational_stiffness = arm.rotational_stiffness,
                                 .rotational_damping = arm.rotational_damping,
                                 .X_BSet = start,
                                 .F_D_B = {}};
    return [=, dynamics = simulated::DeviceDynamics(device, start)](std::int64_t tick,
                                                                    const tick::TickOutput* last) mutable {
        if (last != nullptr) {
            hand.X_BSet = path(tick, last).X_BD;
            dynamics.command(last->F_D_B);
            dynamics.advance(hand);
        }
        return DeviceReading{dynamics.readPose()};
    };
}

std::vector<Case> deviceCases() {
    return {
        {"border_stiffness", "ball_sigma7", "growth of the handle's swing at 0.95 of the border, delay 0-3", "um", 0,
         25, 25, 3, 8, pressedHandle, swingGrowth, atTheBorder, 0b111},
        {"coupling_border", "coupled_ball", "the same through a virtual tool, at 0.95 of its own border", "um", 0, 25,
         25, 3, 8, pressedHandle, swingGrowth, atTheToolsBorder, 0b001},
        {"rest", "table", "motion of handle and proxy at rest, held by a hand", "um", 1e-3, 8, 8, 6, 1000, press, drift,
         atRest, 0b111},
    };
}

}  // namespace passung::hard
