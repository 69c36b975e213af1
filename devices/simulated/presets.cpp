#include "devices/simulated/presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/device_unit.h"
#include "core/base/tick_record.h"
#include "core/loop/stability.h"

namespace passung::simulated {
namespace {

// Where a value comes from. Those of thesis and driver were read somewhere; check the others against a data sheet
// before printing them as facts about the device.
constexpr std::string_view kThesis = "stated in the thesis (Sagardia 2019, figure 2.2)";
constexpr std::string_view kThesisPeak = "peak force stated in the thesis (Sagardia 2019, figure 2.2)";
constexpr std::string_view kDriver = "published driver limit (CHAI3D, safe value, not the data sheet's)";
constexpr std::string_view kDriverPeak = "published driver limit (CHAI3D), equal to the device's peak";
constexpr std::string_view kRecalled = "recalled, unverified";
constexpr std::string_view kProposed = "proposed here";
constexpr std::string_view kServicePages = "public pages of the Inverse Service 3.5";
constexpr std::string_view kAbsent = "not known or not present";

DeviceParams sigma7() {
    return {
        .name = "sigma7",
        .label = "Force Dimension sigma.7 (simulated)",
        .sensed_degrees = 6,
        .actuated_degrees = 6,
        .delay_ticks = 0,
        .degrees_source = "degrees: stated in the thesis; the grip is left out; delay: proposed here",
        .mass = {0.4, kProposed},
        .inertia = {5e-4, kProposed},
        .damping = {1.0, kProposed},
        .rotational_damping = {2e-3, kProposed},
        .coulomb_force = {0.1, kProposed},
        .coulomb_torque = {1e-3, kProposed},
        .quantum = {1.5e-6, kRecalled},
        .rotational_quantum = {2.3e-4, kRecalled},
        .max_force = {12.0, kDriver},
        .max_torque = {0.2, kDriver},
        .continuous_force = {0.0, kAbsent},
        .peak_force = {20.0, kThesisPeak},
        .peak_torque = {0.4, kRecalled},
        .max_force_rate = {5000.0, kProposed},
        .workspace_radius = {0.075, kDriver},
        .vendor_stiffness = {4000.0, kDriver},
        .vendor_rotational_stiffness = {1.0, kDriver},
        .recommended_damping = {5.0, kProposed},
        .recommended_rotational_damping = {2e-3, kProposed},
    };
}

DeviceParams hug() {
    return {
        .name = "hug",
        .label = "DLR HUG, one arm (simulated)",
        .sensed_degrees = 6,
        .actuated_degrees = 6,
        .delay_ticks = 1,
        .degrees_source = "degrees: stated in the thesis; delay: proposed here",
        .mass = {4.0, kProposed},  // after the inertia reduction by force feed-forward
        .inertia = {0.05, kProposed},
        .damping = {10.0, kProposed},
        .rotational_damping = {0.1, kProposed},
        .coulomb_force = {1.5, kProposed},
        .coulomb_torque = {0.03, kProposed},
        .quantum = {20e-6, kProposed},
        .rotational_quantum = {1e-4, kProposed},
        .max_force = {100.0, kProposed},
        .max_torque = {10.0, kProposed},
        .continuous_force = {0.0, kAbsent},
        .peak_force = {150.0, kThesisPeak},
        .peak_torque = {0.0, kAbsent},
        .max_force_rate = {10000.0, kProposed},
        .workspace_radius = {0.47, kThesis},  // half of the largest length, 0.94 m
        .vendor_stiffness = {5000.0, kRecalled},
        .vendor_rotational_stiffness = {300.0, kRecalled},
        .recommended_damping = {20.0, kProposed},
        .recommended_rotational_damping = {0.2, kProposed},
    };
}

DeviceParams virtuose6d() {
    return {
        .name = "virtuose6d",
        .label = "Haption Virtuose 6D35-45 (simulated)",
        .sensed_degrees = 6,
        .actuated_degrees = 6,
        .delay_ticks = 0,
        .degrees_source = "degrees: stated in the thesis; delay: proposed here",
        .mass = {1.0, kProposed},
        .inertia = {5e-3, kProposed},
        .damping = {3.0, kProposed},
        .rotational_damping = {1e-2, kProposed},
        .coulomb_force = {0.5, kProposed},
        .coulomb_torque = {5e-3, kProposed},
        .quantum = {6e-6, kRecalled},
        .rotational_quantum = {2e-4, kProposed},
        .max_force = {10.0, kRecalled},
        .max_torque = {1.0, kRecalled},
        .continuous_force = {10.0, kRecalled},
        .peak_force = {35.0, kThesisPeak},
        .peak_torque = {3.1, kRecalled},
        .max_force_rate = {5000.0, kProposed},
        .workspace_radius = {0.225, kRecalled},  // half of a cube's edge
        .vendor_stiffness = {2000.0, kRecalled},
        .vendor_rotational_stiffness = {30.0, kRecalled},
        .recommended_damping = {5.0, kProposed},
        .recommended_rotational_damping = {2e-2, kProposed},
    };
}

DeviceParams falcon() {
    return {
        .name = "falcon",
        .label = "Novint Falcon (simulated)",
        .sensed_degrees = 3,
        .actuated_degrees = 3,
        .delay_ticks = 1,
        .degrees_source = "degrees: stated in the thesis; delay (USB frame): proposed here",
        .mass = {0.25, kProposed},
        .inertia = {1e-4, kProposed},
        .damping = {0.5, kProposed},
        .rotational_damping = {1e-3, kProposed},
        .coulomb_force = {0.3, kProposed},
        .coulomb_torque = {1e-3, kProposed},
        .quantum = {64e-6, kRecalled},
        .rotational_quantum = {0.0, kAbsent},
        .max_force = {8.0, kDriver},
        .max_torque = {0.0, kAbsent},
        .continuous_force = {0.0, kAbsent},
        .peak_force = {8.9, kThesisPeak},
        .peak_torque = {0.0, kAbsent},
        .max_force_rate = {2000.0, kProposed},
        .workspace_radius = {0.04, kDriver},
        .vendor_stiffness = {3000.0, kDriver},
        .vendor_rotational_stiffness = {0.0, kAbsent},
        .recommended_damping = {5.0, kProposed},
        .recommended_rotational_damping = {0.0, kAbsent},
        .buttons = {4.0, kRecalled},
    };
}

DeviceParams whi() {
    return {
        .name = "whi",
        .label = "Wearable haptic interface, TU Berlin and DLR (simulated)",
        .sensed_degrees = 6,
        .actuated_degrees = 3,
        .delay_ticks = 1,
        .degrees_source = "three driven degrees and passive rotations: stated in the thesis; delay: proposed here",
        .mass = {0.8, kProposed},
        .inertia = {1e-3, kProposed},
        .damping = {2.0, kProposed},
        .rotational_damping = {5e-3, kProposed},
        .coulomb_force = {0.5, kProposed},
        .coulomb_torque = {2e-3, kProposed},
        .quantum = {50e-6, kProposed},
        .rotational_quantum = {5e-4, kProposed},
        .max_force = {40.0, kThesisPeak},
        .max_torque = {0.0, kAbsent},
        .continuous_force = {0.0, kAbsent},
        .peak_force = {40.0, kThesisPeak},
        .peak_torque = {0.0, kAbsent},
        .max_force_rate = {5000.0, kProposed},
        .workspace_radius = {0.25, kThesis},  // half of the largest length, 0.5 m
        .vendor_stiffness = {0.0, kAbsent},
        .vendor_rotational_stiffness = {0.0, kAbsent},
        .recommended_damping = {5.0, kProposed},
        .recommended_rotational_damping = {0.0, kAbsent},
    };
}

DeviceParams touch() {
    return {
        .name = "touch",
        .label = "3D Systems Touch, formerly Phantom Omni (simulated)",
        .sensed_degrees = 6,
        .actuated_degrees = 3,
        .delay_ticks = 0,
        .degrees_source = "degrees: recalled, unverified; delay: proposed here",
        .mass = {0.1, kProposed},  // the tip alone is recalled as 45 g
        .inertia = {1e-4, kProposed},
        .damping = {0.2, kProposed},
        .rotational_damping = {5e-4, kProposed},
        .coulomb_force = {0.1, kProposed},
        .coulomb_torque = {5e-4, kProposed},
        .quantum = {55e-6, kRecalled},
        .rotational_quantum = {1e-3, kProposed},
        .max_force = {3.3, kDriverPeak},
        .max_torque = {0.0, kAbsent},
        .continuous_force = {0.88, kRecalled},
        .peak_force = {3.3, kRecalled},
        .peak_torque = {0.0, kAbsent},
        .max_force_rate = {2000.0, kProposed},
        .workspace_radius = {0.075, kDriver},
        .vendor_stiffness = {400.0, kDriver},
        .vendor_rotational_stiffness = {0.0, kAbsent},
        .recommended_damping = {4.0, kDriver},
        .recommended_rotational_damping = {0.0, kAbsent},
        .buttons = {2.0, kRecalled},
    };
}

DeviceParams inverse3() {
    return {
        .name = "inverse3",
        .label = "Haply Inverse3 with a grip (simulated)",
        .sensed_degrees = 6,
        .actuated_degrees = 3,
        .delay_ticks = 1,
        .degrees_source = "degrees: the service's public pages; delay (a message each way): proposed here",
        .mass = {0.2, kProposed},
        .inertia = {1e-4, kProposed},
        .damping = {0.5, kProposed},
        .rotational_damping = {5e-4, kProposed},
        .coulomb_force = {0.1, kProposed},
        .coulomb_torque = {5e-4, kProposed},
        .quantum = {50e-6, kProposed},
        .rotational_quantum = {1e-3, kProposed},
        .max_force = {8.0, kProposed},
        .max_torque = {0.0, kAbsent},
        .continuous_force = {0.0, kAbsent},
        .peak_force = {0.0, kAbsent},
        .peak_torque = {0.0, kAbsent},
        .max_force_rate = {2000.0, kProposed},
        .workspace_radius = {0.15, kProposed},
        .vendor_stiffness = {0.0, kAbsent},
        .vendor_rotational_stiffness = {0.0, kAbsent},
        .recommended_damping = {4.0, kProposed},
        .recommended_rotational_damping = {0.0, kAbsent},
        .buttons = {3.0, kServicePages},
    };
}

/// Has no motors: what it is told is shown as an arrow, and its handle, which is the driver's own, gives way to it. The
/// limits are those of the arrow, the mechanism is the sigma.7's.
DeviceParams spaceMouse() {
    return {
        .name = "spacemouse",
        .label = "3Dconnexion SpaceMouse (simulated)",
        .sensed_degrees = 6,
        .actuated_degrees = 6,
        .delay_ticks = 0,
        .degrees_source = "six degrees of speed: the daemon's protocol; delay: proposed here",
        .mass = {0.4, kProposed},
        .inertia = {5e-4, kProposed},
        .damping = {1.0, kProposed},
        .rotational_damping = {2e-3, kProposed},
        .coulomb_force = {0.1, kProposed},
        .coulomb_torque = {1e-3, kProposed},
        .quantum = {1.5e-6, kProposed},
        .rotational_quantum = {2.3e-4, kProposed},
        .max_force = {10.0, kProposed},
        .max_torque = {0.5, kProposed},
        .continuous_force = {0.0, kAbsent},
        .peak_force = {0.0, kAbsent},
        .peak_torque = {0.0, kAbsent},
        .max_force_rate = {5000.0, kProposed},
        .workspace_radius = {0.15, kProposed},
        .vendor_stiffness = {2000.0, kProposed},
        .vendor_rotational_stiffness = {1.0, kProposed},
        .recommended_damping = {5.0, kProposed},
        .recommended_rotational_damping = {2e-3, kProposed},
        .buttons = {2.0, kProposed},
    };
}

/// Stands for what a room's cameras or a server's own device follow, and has no motors: what it is told is shown as an
/// arrow. The limits are those of the arrow, the mechanism is the sigma.7's.
DeviceParams tracker() {
    DeviceParams p = spaceMouse();
    p.name = "tracker";
    p.label = "Tracker of six degrees without motors (simulated)";
    p.degrees_source = "pose of one sensor: VRPN's protocol; delay: proposed here";
    p.workspace_radius = {2.0, kProposed};
    p.buttons = {};
    return p;
}

/// Stands for whatever device serves: nothing of it is known, its limits are the most that may be asked of it.
DeviceParams anyDevice() {
    return {
        .name = kAnyKind,
        .label = "Any device (simulated)",
        .sensed_degrees = 6,
        .actuated_degrees = 6,
        .delay_ticks = 0,
        .degrees_source = "the protocol says what it needs of them; delay: proposed here",
        .mass = {0.3, kProposed},
        .inertia = {3e-4, kProposed},
        .damping = {1.0, kProposed},
        .rotational_damping = {2e-3, kProposed},
        .coulomb_force = {0.1, kProposed},
        .coulomb_torque = {1e-3, kProposed},
        .quantum = {20e-6, kProposed},
        .rotational_quantum = {2e-4, kProposed},
        .max_force = {20.0, kProposed},
        .max_torque = {1.0, kProposed},
        .continuous_force = {0.0, kAbsent},
        .peak_force = {0.0, kAbsent},
        .peak_torque = {0.0, kAbsent},
        .max_force_rate = {2000.0, kProposed},
        .workspace_radius = {0.075, kProposed},
        .vendor_stiffness = {0.0, kAbsent},
        .vendor_rotational_stiffness = {0.0, kAbsent},
        .recommended_damping = {4.0, kProposed},
        .recommended_rotational_damping = {2e-3, kProposed},
    };
}

struct PresetStiffness {
    double value = 0.0;
    std::string source;
};

PresetStiffness stableStiffness(const loop::SampledWall& wall, const Sourced& vendor, const char* unit) {
    const double border = loop::stableStiffnessBorder(wall);
    const double share = kStableShare * border;
    if (vendor.value > 0 && vendor.value < share)
        return {vendor.value, fmt::format("{:.4g} {}, {}", vendor.value, unit, vendor.source)};
    return {share,
            fmt::format("{:.4g} {} = {:.1f} x exact border {:.4g} of the model", share, unit, kStableShare, border)};
}

}  // namespace

std::vector<Error> DeviceParams::validate() const {
    std::vector<Error> errors;
    const auto require = [&](bool ok, const char* key, double value, std::string requirement) {
        if (!ok) errors.push_back({.message = std::move(requirement), .key = key, .value = fmt::format("{}", value)});
    };
    const auto positive = [&](const char* key, const Sourced& s) {
        require(std::isfinite(s.value) && s.value > 0, key, s.value, "must be finite and above 0");
    };
    const auto notNegative = [&](const char* key, const Sourced& s) {
        require(std::isfinite(s.value) && s.value >= 0, key, s.value, "must be finite and at least 0");
    };
    require(sensed_degrees == 3 || sensed_degrees == 6, "sensed_degrees", sensed_degrees, "must be 3 or 6");
    require(actuated_degrees == 3 || actuated_degrees == 6, "actuated_degrees", actuated_degrees, "must be 3 or 6");
    require(actuated_degrees <= sensed_degrees, "actuated_degrees", actuated_degrees, "must not exceed sensed_degrees");
    require(delay_ticks >= 0 && delay_ticks <= loop::kMaxDeviceDelayTicks, "delay_ticks", delay_ticks,
            fmt::format("must be 0 to {}", loop::kMaxDeviceDelayTicks));
    positive("mass", mass);
    positive("inertia", inertia);
    notNegative("damping", damping);
    notNegative("rotational_damping", rotational_damping);
    notNegative("coulomb_force", coulomb_force);
    notNegative("coulomb_torque", coulomb_torque);
    notNegative("quantum", quantum);
    notNegative("rotational_quantum", rotational_quantum);
    positive("max_force", max_force);
    notNegative("continuous_force", continuous_force);
    notNegative("max_torque", max_torque);
    require(actuated_degrees == 6 || !(max_torque.value > 0), "max_torque", max_torque.value,
            "must be 0 where torque is not actuated");
    positive("max_force_rate", max_force_rate);
    positive("workspace_radius", workspace_radius);
    notNegative("vendor_stiffness", vendor_stiffness);
    notNegative("vendor_rotational_stiffness", vendor_rotational_stiffness);
    notNegative("recommended_damping", recommended_damping);
    notNegative("recommended_rotational_damping", recommended_rotational_damping);
    return errors;
}

DeviceDescription describe(const DeviceParams& p) {
    DeviceDescription d;
    d.name = p.name;
    d.label = p.label;
    d.simulated = true;
    d.sensed_degrees = p.sensed_degrees;
    d.actuated_degrees = p.actuated_degrees;
    d.max_force_N = p.max_force.value;
    d.max_torque_Nm = p.max_torque.value;
    d.max_force_rate_N_per_s = p.max_force_rate.value;
    d.delay_ticks = p.delay_ticks;
    d.workspace_radius_m = p.workspace_radius.value;
    d.recommended_damping_Ns_per_m = p.recommended_damping.value;
    d.recommended_rotational_damping_Nms_per_rad = p.recommended_rotational_damping.value;
    if (p.buttons.value > 0.0) d.buttons = static_cast<int>(p.buttons.value);

    d.mechanism = DeviceMechanism{.mass_kg = p.mass.value,
                                  .inertia_kg_m2 = p.inertia.value,
                                  .damping_Ns_per_m = p.damping.value,
                                  .rotational_damping_Nms_per_rad = p.rotational_damping.value,
                                  .coulomb_force_N = p.coulomb_force.value,
                                  .coulomb_torque_Nm = p.coulomb_torque.value,
                                  .quantum_m = p.quantum.value,
                                  .rotational_quantum_rad = p.rotational_quantum.value};

    if (p.name == kAnyKind) {
        d.stability_source = "not known: it depends on the device";
        return d;
    }
    const PresetStiffness linear = stableStiffness({.mass = p.mass.value,
                                                    .damping = p.damping.value,
                                                    .stiffness = 0,
                                                    .virtual_damping = p.recommended_damping.value,
                                                    .period = kTickSeconds,
                                                    .delay_ticks = p.delay_ticks},
                                                   p.vendor_stiffness, "N/m");
    d.stable_stiffness_N_per_m = linear.value;
    d.stability_source = "translation: " + linear.source;
    if (p.actuated_degrees < 6) {
        d.stability_source += "; rotation: torque is not actuated";
        return d;
    }
    const PresetStiffness rotational = stableStiffness({.mass = p.inertia.value,
                                                        .damping = p.rotational_damping.value,
                                                        .stiffness = 0,
                                                        .virtual_damping = p.recommended_rotational_damping.value,
                                                        .period = kTickSeconds,
                                                        .delay_ticks = p.delay_ticks},
                                                       p.vendor_rotational_stiffness, "N·m/rad");
    d.stable_rotational_stiffness_Nm_per_rad = rotational.value;
    d.stability_source += "; rotation: " + rotational.source;
    return d;
}

const std::vector<DeviceParams>& presets() {
    static const std::vector<DeviceParams> all = {sigma7(), hug(), virtuose6d(), falcon(), whi(), touch()};
    return all;
}

const std::vector<DeviceParams>& standIns() {
    static const std::vector<DeviceParams> all = {inverse3(), spaceMouse(), tracker(), anyDevice()};
    return all;
}

const DeviceParams* findPreset(std::string_view name) {
    for (const auto* list : {&presets(), &standIns()})
        if (const auto found = std::ranges::find(*list, name, &DeviceParams::name); found != list->end())
            return &*found;
    return nullptr;
}

}  // namespace passung::simulated
