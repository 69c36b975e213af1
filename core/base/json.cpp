#include "core/base/json.h"

#include <fmt/format.h>

#include <cmath>

namespace passung {

std::string jsonText(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (c == '\n') {
            result += "\\n";
        } else if (static_cast<unsigned char>(c) < 0x20) {
            result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        } else {
            result += c;
        }
    }
    return result + '"';
}

std::string jsonNumber(double value) {
    if (!std::isfinite(value)) return "null";
    return fmt::format("{}", value + 0.0);  // turns -0 into 0
}

std::string jsonNumbers(const std::vector<double>& values) {
    std::vector<std::string> items;
    for (const double value : values) items.push_back(jsonNumber(value));
    return jsonList(items);
}

std::string jsonVector(const Vec3& v) { return jsonNumbers({v.x(), v.y(), v.z()}); }

std::string jsonList(const std::vector<std::string>& items) { return fmt::format("[{}]", fmt::join(items, ",")); }

JsonObject& JsonObject::json(std::string_view key, std::string_view value) {
    if (!content_.empty()) content_ += ',';
    content_ += jsonText(key);
    content_ += ':';
    content_ += value;
    return *this;
}

}  // namespace passung
