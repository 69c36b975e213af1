#include "study/protocol/station/station_file.h"

#include <algorithm>

#include "core/base/json.h"
#include "core/base/regular_file.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

Result<std::vector<DeviceChoice>> readStationFile(const std::string& path) {
    const auto text = readFile(path);
    if (!text) return text.errors();
    const auto document = parseDocument(*text, path);
    if (!document) return document.errors();
    Errors errors;
    std::vector<DeviceChoice> devices;
    const TableReader file(*document, {"station_file"}, "", errors);
    if (const Node* station = file.node("station")) {
        const TableReader read(*station, {"station"}, "station", errors);
        const Node* table = read.node("device");
        for (const Entry& entry : table != nullptr ? table->entries : std::vector<Entry>{}) {
            const std::string place = "station.device." + entry.key;
            if (entry.value.kind != Node::Kind::Table || !isName(entry.key)) {
                errors.push_back(errorAt(entry.place, place, valueText(entry.value),
                                         "must be a table whose name is that of a hand: [station.device.right]"));
                continue;
            }
            const TableReader device(entry.value, {"station_device"}, place, errors);
            devices.push_back({entry.key, device.text("kind"), device.text("backend"), device.text("serial"),
                               device.text("address"), device.text("axes"),
                               static_cast<int>(device.integer("heartbeat_ms"))});
        }
    }
    tidy(errors);
    if (!errors.empty()) return errors;
    return devices;
}

std::string stationFileText(const std::vector<DeviceChoice>& devices) {
    std::string text = "# Which device serves each hand at this computer; keys: protocols/KEYS.md, \"Station file\".\n";
    for (const DeviceChoice& device : devices) {
        text += "\n[station.device." + device.hand + "]\n";
        const auto line = [&text](const char* key, const std::string& value) {
            if (!value.empty()) text += std::string(key) + " = " + jsonText(value) + "\n";
        };
        line("kind", device.kind);
        line("backend", device.backend);
        line("serial", device.serial);
        line("address", device.address);
        line("axes", device.axes);
        if (device.heartbeat_ms != DeviceChoice{}.heartbeat_ms)
            text += "heartbeat_ms = " + std::to_string(device.heartbeat_ms) + "\n";
    }
    return text;
}

}  // namespace passung::protocol
