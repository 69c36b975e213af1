#include "study/run/machine/stability_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/tick_record.h"

namespace passung::run {

namespace {

/// A contact so many times stiffer than a wall may be is as good as rigid.
constexpr double kRigid = 100.0;

WallBounds boundsOf(const loop::SampledWall& wall, double coulomb, double quantum) {
    // Beyond the longest delay that the model covers nothing is known to be stable: its functions give 0 then.
    const bool known = wall.delay_ticks <= loop::kMaxDeviceDelayTicks;
    loop::SampledWall undamped = wall;
    undamped.virtual_damping = 0.0;
    return {.border = stableStiffnessBorder(wall),
            .linear = known ? linearStiffness(wall) : 0.0,
            .passive = passiveStiffness(wall, coulomb, quantum),
            .passive_undamped = passiveStiffness(undamped, coulomb, quantum)};
}

loop::SampledWall translationLoop(const DeviceMechanism& m, double damping, int delay_ticks) {
    return {.mass = m.mass_kg,
            .damping = m.damping_Ns_per_m,
            .stiffness = 0,
            .virtual_damping = damping,
            .period = kTickSeconds,
            .delay_ticks = delay_ticks};
}

loop::SampledWall rotationLoop(const DeviceMechanism& m, double damping, int delay_ticks) {
    return {.mass = m.inertia_kg_m2,
            .damping = m.rotational_damping_Nms_per_rad,
            .stiffness = 0,
            .virtual_damping = damping,
            .period = kTickSeconds,
            .delay_ticks = delay_ticks};
}

}  // namespace

WallBounds translationBounds(const DeviceMechanism& m, double damping, int delay_ticks) {
    return boundsOf(translationLoop(m, damping, delay_ticks), m.coulomb_force_N, m.quantum_m);
}

WallBounds rotationBounds(const DeviceMechanism& m, double damping, int delay_ticks) {
    return boundsOf(rotationLoop(m, damping, delay_ticks), m.coulomb_torque_Nm, m.rotational_quantum_rad);
}

bool feltThroughTool(const scene::ContactSpec& contact) {
    return contact.method == scene::ContactMethod::Penalty && contact.coupling != scene::PenaltyCoupling::Direct;
}

SceneWall translationWall(const DeviceDescription& device, const scene::SceneSpec& scene) {
    const double scale = scene.hand(0).largestScale();
    SceneWall wall{.stiffness = scale * scene.contact.stiffness, .bounds = {}};
    if (!device.mechanism) return wall;
    const int delay = device.delay_ticks + scene.limits.delay_ticks;
    wall.bounds = translationBounds(*device.mechanism, scale * scene.contact.damping, delay);
    if (feltThroughTool(scene.contact)) {
        const bool virtual_tool = scene.contact.coupling == scene::PenaltyCoupling::Virtual;
        const bool bounded = scene.contact.variant == scene::PenaltyVariant::MaxNormalised;
        wall.bounds.border = stableStiffnessBorderUpTo(loop::SampledTool{
            .wall = translationLoop(*device.mechanism, scale * scene.contact.damping, delay),
            .contact_stiffness = bounded ? scale * scene.contact.penalty_stiffness : kRigid * wall.bounds.border,
            .tool_mass = virtual_tool ? scale * scene.contact.tool_mass : 0.0});
    }
    if (scene.effects.inertia.any())
        wall.bounds.border = std::min(
            wall.bounds.border,
            stableStiffnessBorderInAir(translationLoop(*device.mechanism, scale * scene.contact.damping, delay)));
    return wall;
}

Errors beyondBorder(const plan::StudyPlan& plan, std::span<const DeviceDescription> devices) {
    Errors errors;
    for (const plan::Condition& condition : plan.conditions) {
        const DeviceDescription* device = deviceNamed(condition.device, devices);
        if (device == nullptr || condition.allow_unstable) continue;
        const bool moves_on = condition.scene.effects.inertia.any();
        if (!moves_on && !feltThroughTool(condition.scene.contact)) continue;
        const SceneWall wall = translationWall(*device, condition.scene);
        if (!device->mechanism || wall.stiffness < wall.bounds.border) continue;
        Error error{
            .message = fmt::format("must be below {:.4g} N/m, where {} is no longer stable through this "
                                   "coupling's {}; allow_unstable = true lifts this",
                                   wall.bounds.border, device->name, moves_on ? "mass (effects.inertia)" : "tool"),
            .file = plan.source_path,
            .key = "condition " + condition.name + ": contact.stiffness_N_per_m",
            .value = fmt::format("{:.6g}", wall.stiffness)};
        const bool told = std::any_of(errors.begin(), errors.end(), [&](const Error& other) {
            return other.message == error.message && other.value == error.value;
        });
        if (!told) errors.push_back(std::move(error));
    }
    return errors;
}

SceneWall rotationWall(const DeviceDescription& device, const scene::SceneSpec& scene) {
    SceneWall wall{.stiffness = scene.contact.rotational_stiffness, .bounds = {}};
    if (!device.mechanism) return wall;
    const int delay = device.delay_ticks + scene.limits.delay_ticks;
    wall.bounds = rotationBounds(*device.mechanism, scene.contact.rotational_damping, delay);
    if (scene.effects.inertia.any())
        wall.bounds.border = std::min(
            wall.bounds.border,
            stableStiffnessBorderInAir(rotationLoop(*device.mechanism, scene.contact.rotational_damping, delay)));
    return wall;
}

const DeviceDescription* deviceNamed(const std::string& name, std::span<const DeviceDescription> devices) {
    const auto found = std::find_if(devices.begin(), devices.end(), [&](const auto& d) { return d.name == name; });
    return found == devices.end() ? nullptr : &*found;
}

}  // namespace passung::run
