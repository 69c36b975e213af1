#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace passung::store {

/// 16 hexadecimal digits; the same study, participant, ordinal and seed give the same session.
std::string sessionId(std::string_view study, std::string_view participant, int ordinal, std::uint64_t seed);

}  // namespace passung::store
