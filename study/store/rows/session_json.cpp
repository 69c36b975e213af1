#include "study/store/rows/session_json.h"

#include "core/base/json.h"

namespace passung::store {
namespace {

std::string mechanismJson(const DeviceMechanism& m) {
    return JsonObject()
        .number("mass_kg", m.mass_kg)
        .number("inertia_kg_m2", m.inertia_kg_m2)
        .number("damping_Ns_per_m", m.damping_Ns_per_m)
        .number("rotational_damping_Nms_per_rad", m.rotational_damping_Nms_per_rad)
        .number("coulomb_force_N", m.coulomb_force_N)
        .number("coulomb_torque_Nm", m.coulomb_torque_Nm)
        .number("quantum_m", m.quantum_m)
        .number("rotational_quantum_rad", m.rotational_quantum_rad)
        .str();
}

std::string unitJson(const DeviceUnit& unit) {
    return JsonObject()
        .text("hand", unit.hand)
        .text("kind", unit.kind)
        .text("backend", unit.backend)
        .text("serial", unit.serial)
        .text("model", unit.model)
        .text("versions", unit.versions)
        .text("calibration", unit.calibration)
        .str();
}

}  // namespace

std::string deviceJson(const DeviceDescription& device, std::span<const DeviceUnit> units) {
    JsonObject json;
    json.text("name", device.name).text("label", device.label).boolean("simulated", device.simulated);
    json.boolean("stands_for_preset", device.stands_for_preset);
    json.integer("sensed_degrees", device.sensed_degrees).integer("actuated_degrees", device.actuated_degrees);
    json.number("max_force_N", device.max_force_N).number("max_torque_Nm", device.max_torque_Nm);
    json.number("max_force_rate_N_per_s", device.max_force_rate_N_per_s);
    json.number("max_speed_m_per_s", device.max_speed_m_per_s).number("max_spin_rad_per_s", device.max_spin_rad_per_s);
    json.integer("delay_ticks", device.delay_ticks).number("workspace_radius_m", device.workspace_radius_m);
    json.number("stable_stiffness_N_per_m", device.stable_stiffness_N_per_m);
    json.number("stable_rotational_stiffness_Nm_per_rad", device.stable_rotational_stiffness_Nm_per_rad);
    json.number("recommended_damping_Ns_per_m", device.recommended_damping_Ns_per_m);
    json.number("recommended_rotational_damping_Nms_per_rad", device.recommended_rotational_damping_Nms_per_rad);
    json.text("stability_source", device.stability_source);
    json.json("mechanism", device.mechanism ? mechanismJson(*device.mechanism) : "null");
    std::vector<std::string> items;
    for (const DeviceUnit& unit : units) items.push_back(unitJson(unit));
    if (!items.empty()) json.json("units", jsonList(items));
    return json.str();
}

std::string stagesJson(std::span<const session::StageNote> stages) {
    std::vector<std::string> items;
    for (const session::StageNote& stage : stages) {
        JsonObject json;
        json.text("stage", stage.name).text("reason", stage.reason);
        if (!stage.runs) json.boolean("runs", false);
        items.push_back(json.str());
    }
    return jsonList(items);
}

}  // namespace passung::store
