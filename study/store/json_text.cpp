#include "study/store/json_text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace passung::store {

std::string jsonString(std::string_view text) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string json = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            json += '\\';
            json += c;
        } else if (c == '\n') {
            json += "\\n";
        } else if (code < 0x20) {
            json += "\\u00";
            json += kDigits[code >> 4];
            json += kDigits[code & 15];
        } else {
            json += c;
        }
    }
    return json + '"';
}

std::string jsonNumber(double value) {
    if (!std::isfinite(value)) return "null";
    std::array<char, 32> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), end};
}

std::string deviceJson(const DeviceDescription& device) {
    std::string json = "{\"name\":" + jsonString(device.name) + ",\"label\":" + jsonString(device.label) +
                       ",\"simulated\":" + (device.simulated ? "true" : "false");
    const auto number = [&json](std::string_view key, double value) {
        json += ",\"" + std::string(key) + "\":" + jsonNumber(value);
    };
    number("sensed_degrees", device.sensed_degrees);
    number("actuated_degrees", device.actuated_degrees);
    number("max_force_N", device.max_force_N);
    number("max_torque_Nm", device.max_torque_Nm);
    number("max_force_rate_N_per_s", device.max_force_rate_N_per_s);
    number("max_speed_m_per_s", device.max_speed_m_per_s);
    number("max_spin_rad_per_s", device.max_spin_rad_per_s);
    number("delay_ticks", device.delay_ticks);
    number("workspace_radius_m", device.workspace_radius_m);
    number("stable_stiffness_N_per_m", device.stable_stiffness_N_per_m);
    number("stable_rotational_stiffness_Nm_per_rad", device.stable_rotational_stiffness_Nm_per_rad);
    number("recommended_damping_Ns_per_m", device.recommended_damping_Ns_per_m);
    number("recommended_rotational_damping_Nms_per_rad", device.recommended_rotational_damping_Nms_per_rad);
    return json + ",\"stability_source\":" + jsonString(device.stability_source) + "}";
}

std::string stagesJson(std::span<const session::StageNote> stages) {
    std::string json = "[";
    for (const session::StageNote& stage : stages) {
        if (json.size() > 1) json += ',';
        json += "{\"stage\":" + jsonString(stage.name) + ",\"reason\":" + jsonString(stage.reason) + "}";
    }
    return json + "]";
}

}  // namespace passung::store
