#pragma once

#include <optional>
#include <string>

namespace passung {

/// The mechanism of a simulated device: what its handle feels like without a wrench.
struct DeviceMechanism {
    double mass_kg = 0;
    double inertia_kg_m2 = 0;
    double damping_Ns_per_m = 0;
    double rotational_damping_Nms_per_rad = 0;
    double coulomb_force_N = 0;
    double coulomb_torque_Nm = 0;
    double quantum_m = 0;  // encoder step
    double rotational_quantum_rad = 0;
};

/// What a device can do, as values: used to validate protocols, to limit the output and to describe a session.
struct DeviceDescription {
    std::string name;   // preset or model, e.g. "sigma7"
    std::string label;  // for people, e.g. "Force Dimension sigma.7 (simulated)"
    bool simulated = true;
    bool stands_for_preset = false;  // where a condition names a preset this device serves, as a mouse does
    int sensed_degrees = 6;
    int actuated_degrees = 6;           // 3: force only, torque is never rendered
    double max_force_N = 12.0;          // > 0
    double max_torque_Nm = 0.2;         // ≥ 0; 0 where torque is not actuated
    double max_force_rate_N_per_s = 0;  // limit of rising force, > 0
    double max_speed_m_per_s = 20.0;    // a faster reading is a broken one
    double max_spin_rad_per_s = 200.0;
    int delay_ticks = 0;              // ticks between command and effect
    double workspace_radius_m = 0.1;  // about the home position
    /// Largest contact stiffness that the device displays stably ("max" in a protocol), and how it was found.
    double stable_stiffness_N_per_m = 0;
    double stable_rotational_stiffness_Nm_per_rad = 0;
    double recommended_damping_Ns_per_m = 0;
    double recommended_rotational_damping_Nms_per_rad = 0;
    std::string stability_source;
    std::optional<DeviceMechanism> mechanism;  // only of a simulated device: of a real one it is not known exactly
    std::optional<int> buttons;                // of the handle; nothing: not known
};

}  // namespace passung
