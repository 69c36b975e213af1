#pragma once

#include <string>
#include <string_view>

namespace passung {

/// `text` with everything that a terminal could take for a command written out: control characters as \n, \t or \x1b,
/// what is no UTF-8 byte by byte, characters that turn the direction of writing as \u202e. What is left is one line.
std::string printable(std::string_view text);

/// The same for text of several lines: \n and \t stay, and \r if `returns`.
std::string printableLines(std::string_view text, bool returns = false);

/// Tells whether the text has a control character other than the end of a line and the tab.
bool holdsControls(std::string_view text);

/// How many bytes at the end of `text` begin a character that is cut off there.
std::size_t cutOff(std::string_view text);

}  // namespace passung
