#include "devices/haply/service_message.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/json.h"

namespace passung::haply {
namespace {

using Json = nlohmann::json;

/// The member; null if there is none.
const Json& member(const Json& object, const char* name) {
    static const Json none;
    if (!object.is_object()) return none;
    const auto found = object.find(name);
    return found == object.end() ? none : *found;
}

std::optional<double> number(const Json& value) {
    if (!value.is_number()) return std::nullopt;
    const auto x = value.get<double>();
    return std::isfinite(x) ? std::optional(x) : std::nullopt;
}

std::optional<Vec3> vector(const Json& object) {
    const auto x = number(member(object, "x")), y = number(member(object, "y")), z = number(member(object, "z"));
    return x && y && z ? std::optional<Vec3>(Vec3(*x, *y, *z)) : std::nullopt;
}

std::optional<Quat> rotation(const Json& object) {
    const auto w = number(member(object, "w"));
    const auto v = vector(object);
    return w && v ? std::optional<Quat>(Quat(*w, v->x(), v->y(), v->z())) : std::nullopt;
}

std::string text(const Json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }

SaidOfDevice deviceOf(const Json& entry) {
    SaidOfDevice said;
    said.id = text(member(entry, "device_id"));
    const Json& state = member(entry, "state");
    said.position = vector(member(state, "cursor_position"));
    said.velocity = vector(member(state, "cursor_velocity"));
    said.body = rotation(member(state, "body_orientation"));
    const Json& calibrated = member(member(entry, "status"), "calibrated");
    if (calibrated.is_boolean()) said.calibrated = calibrated.get<bool>();
    const Json& config = member(entry, "config");
    said.firmware = text(member(config, "extended_firmware_version"));
    said.basis = text(member(member(config, "basis"), "permutation"));
    const Json& filters = member(config, "filters");
    said.filters.gate_gain = number(member(member(filters, "force_gate"), "gain"));
    said.filters.damping = number(member(member(filters, "damping"), "scalar"));
    return said;
}

/// A grip is in a list of its own, named after its family.
void addGrips(const Json& message, std::vector<SaidOfDevice>& devices) {
    for (const char* family : {"wireless_verse_grip", "verse_grip", "custom_verse_grip"}) {
        const Json& grips = member(message, family);
        if (!grips.is_array()) continue;
        for (std::size_t i = 0; i < std::min(grips.size(), devices.size()); ++i) {
            const Json& state = member(grips[i], "state");
            devices[i].grip = rotation(member(state, "orientation"));
            std::uint32_t bit = 1;
            for (const char* button : {"a", "b", "c"}) {
                const Json& pressed = member(member(state, "buttons"), button);
                if (pressed.is_boolean() && pressed.get<bool>()) devices[i].buttons |= bit;
                bit <<= 1;
            }
        }
        return;
    }
}

}  // namespace

std::optional<std::vector<SaidOfDevice>> readMessage(std::string_view text) {
    const Json message = Json::parse(text, nullptr, false);
    const Json& inverse = member(message, "inverse3");
    if (!inverse.is_array()) return std::nullopt;
    std::vector<SaidOfDevice> devices;
    for (const Json& entry : inverse) devices.push_back(deviceOf(entry));
    addGrips(message, devices);
    return devices;
}

std::string forceMessage(const std::string& id, const Vec3& force, bool open_gate) {
    const char* configure = open_gate ? R"("configure":{"force_gate":{"gain":1.0},"damping":{"scalar":0.0}},)" : "";
    return fmt::format(
        R"({{"inverse3":[{{"device_id":{},{}"commands":{{"set_cursor_force":{{"vector":{{"x":{},"y":{},"z":{}}}}}}}}}]}})",
        jsonText(id), configure, jsonNumber(force.x()), jsonNumber(force.y()), jsonNumber(force.z()));
}

std::string harmOf(std::string_view event, const std::string& id) {
    const Json message = Json::parse(event, nullptr, false);
    const Json& data = member(message, "data");
    if (text(member(data, "device_id")) != id) return {};
    const std::string name = text(member(message, "name"));
    if (name == "device-disconnected") return "the Inverse3 " + id + " was unplugged";
    if (name == "device-safety-triggered")
        return "the Inverse3 " + id + " has stopped itself: " + text(member(data, "safety_type"));
    return {};
}

Vec3 toBase(const Vec3& cursor) { return cursor - kMiddle; }
Vec3 toCursor(const Vec3& base) { return base + kMiddle; }

}  // namespace passung::haply
