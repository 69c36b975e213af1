#include "core/base/printable.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace passung {
namespace {

TEST(Printable, WritesOutWhatATerminalWouldObeyAndNothingElse) {
    // Truth: closed form. One row per class of character.
    const std::vector<std::pair<std::string, std::string>> rows{
        {"plain text, Größe 2 µm, 大, 🙂", "plain text, Größe 2 µm, 大, 🙂"},
        {"\x1b[2J", "\\x1b[2J"},
        {std::string("a\0b", 3), "a\\x00b"},
        {"a\r\n\tb\x7f", "a\\x0d\\n\\tb\\x7f"},
        {"\xc2\x9b", "\\u009b"},
        {"\x9b", "\\x9b"},
        {"\xc0\x9b", "\\xc0\\x9b"},                    // longer than it must be
        {"\xed\xa0\x80", "\\xed\\xa0\\x80"},           // half of a pair
        {"\xe2\x80\xae", "\\u202e"},                   // turns the direction
        {"\xe2\x80", "\\xe2\\x80"},                    // cut off
        {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // beyond the last character
    };
    for (const auto& [text, shown] : rows) EXPECT_EQ(printable(text), shown);
    EXPECT_EQ(printableLines("a\nb\tc\r"), "a\nb\tc\\x0d");
    EXPECT_EQ(printableLines("a\r", true), "a\r");
    EXPECT_FALSE(holdsControls("a\n\tb"));
    EXPECT_TRUE(holdsControls("a\xc2\x85"));
    EXPECT_TRUE(holdsControls("\x1b"));
}

TEST(Printable, KnowsHowMuchOfACharacterIsAtTheEnd) {
    // Truth: closed form.
    const std::string text = "ab🙂";
    EXPECT_EQ(cutOff(text), 0u);
    for (std::size_t bytes = 1; bytes <= 3; ++bytes) EXPECT_EQ(cutOff(text.substr(0, 2 + bytes)), bytes);
    EXPECT_EQ(cutOff("ab"), 0u);
    EXPECT_EQ(cutOff("\x80\x80\x80\x80"), 0u);
    EXPECT_EQ(cutOff(""), 0u);
}

TEST(Printable, ErrorIsOneLineWhateverAFilePutsIntoIt) {
    // Truth: closed form.
    const Error error{.message = "must be", .file = "a\n.toml", .line = 1, .column = 2, .key = "k\x1b", .value = "v\r"};
    EXPECT_EQ(toString(error), "a\\n.toml:1:2: error: k\\x1b: v\\x0d: must be");
}

}  // namespace
}  // namespace passung
