#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/types.h"

namespace passung {

/// JSON text of a string, quoted and escaped.
std::string jsonText(std::string_view text);

/// Shortest decimal that reads back as the same double; `null` if it is not finite, which JSON cannot say.
std::string jsonNumber(double value);

std::string jsonNumbers(const std::vector<double>& values);

/// [x, y, z]
std::string jsonVector(const Vec3& v);

/// A list of texts that are JSON already.
std::string jsonList(const std::vector<std::string>& items);

/// An object whose keys keep the order in which they were added: the same calls give the same bytes.
class JsonObject {
public:
    JsonObject& text(std::string_view key, std::string_view value) { return json(key, jsonText(value)); }
    JsonObject& number(std::string_view key, double value) { return json(key, jsonNumber(value)); }
    JsonObject& integer(std::string_view key, std::int64_t value) { return json(key, std::to_string(value)); }
    JsonObject& boolean(std::string_view key, bool value) { return json(key, value ? "true" : "false"); }
    /// `value` is JSON already.
    JsonObject& json(std::string_view key, std::string_view value);
    std::string str() const { return "{" + content_ + "}"; }

private:
    std::string content_;
};

}  // namespace passung
