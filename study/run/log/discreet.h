#pragma once

#include <span>
#include <string>
#include <string_view>

namespace passung::run {

/// A text as a log may hold it, on one line of at most kLongestLine bytes. What people typed or are named by is left
/// out: everything from the first quotation mark to the last, whatever may be a participant's code, the words `names`,
/// home folders and other folders of a user's name (they become ~).
std::string discreet(std::string_view text, std::span<const std::string> names = {});

inline constexpr std::size_t kLongestLine = 1000;

}  // namespace passung::run
