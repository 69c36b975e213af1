#include "study/run/log/discreet.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

namespace passung::run {
namespace {

TEST(Discreet, LeavesOutWhatPeopleAreNamedByAndWhatTheyTyped) {
    // Truth: closed form
    setenv("HOME", "/srv/people/anna", 1);
    setenv("USER", "annam", 1);
    const std::array<std::string, 2> names = {"Berta Berg", "p7"};
    const std::pair<const char*, const char*> lines[] = {
        {"participant S001 has completed", "participant … has completed"},
        {"s_P017-2.stl, TB003:", "s_….stl, …:"},
        {"answered \"not \"really\" hard\", so", "answered \"…\", so"},
        {"answered \"not really", "answered \"…"},
        {"code 'anna's': it's new", "code '…'s new"},
        {"the machine's clock", "the machine's clock"},
        {"/srv/people/anna/s.db: error", "~/s.db: error"},
        {"/srv/people/annabel/s.db", "/srv/people/annabel/s.db"},
        {"/home"
         "/carl dorn/s.db and /media/carl/x",
         "~/s.db and ~/x"},
        {"cannot open /home"
         "/carl",
         "cannot open ~"},
        {"/data/annam/s.db", "/data/~/s.db"},
        {"by Berta Berg, p7, p77", "by …, …, p77"},
        {"two\nlines\x1b[0m", "two lines [0m"},
        {"loop real-time fifo, 4200 ticks, p99 12.5 µs", "loop real-time fifo, 4200 ticks, p99 12.5 µs"},
        {"god object: cell_mm must be > 0", "god object: cell_mm must be > 0"},
    };
    for (const auto& [text, expected] : lines) EXPECT_EQ(discreet(text, names), expected);
}

TEST(Discreet, ALineIsBoundedAndCutBetweenCharacters) {
    // Truth: invariant, at every place of the cut within a character of two bytes
    for (std::size_t before = 0; before < 2; ++before) {
        std::string text(before, 'x');
        while (text.size() < 3000) text += "µ";
        const std::string line = discreet(text);
        EXPECT_LE(line.size(), kLongestLine);
        EXPECT_TRUE(line.ends_with("µ…"));
    }
}

}  // namespace
}  // namespace passung::run
