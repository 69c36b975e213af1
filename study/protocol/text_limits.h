#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace passung::protocol {

/// Most bytes of a protocol, scene or questionnaire with all that it includes.
inline constexpr std::size_t kMostProtocolBytes = std::size_t{4} << 20;

/// Most levels of a value: brackets and parts of dotted keys that it stands in.
inline constexpr int kMostLevels = 64;

/// What keeps `text` from being given to the parser, at its place: it is too large, or so deep that parser and readers,
/// which call themselves for each level, would run out of stack. Judged by the brackets and dots outside of strings, so
/// that text that is no TOML has an answer too.
std::optional<Error> beyondLimits(std::string_view text, const std::string& file);

}  // namespace passung::protocol
