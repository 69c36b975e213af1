#include "study/measures/hint_watch.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

// When hints come up, and to which step. Truth of all: by hand, from what hint_watch.h says.

namespace passung::measures {
namespace {

/// The second waits for the third; the others wait for none.
std::vector<scene::AssemblyStep> steps() {
    std::vector<scene::AssemblyStep> steps(3);
    steps[1].after = scene::stepBit(2);
    return steps;
}

/// "step@time" of each hint that comes up in ticks 5 … 5 + done.size() - 1, and what is shown after the last.
std::string hintsOf(std::int64_t after, const std::vector<scene::StepSet>& done) {
    HintWatch watch(steps(), after);
    std::string text;
    for (std::size_t i = 0; i < done.size(); ++i)
        if (watch.follow(5 + static_cast<std::int64_t>(i), done[i]))
            text += std::to_string(watch.shown().value()) + "@" + std::to_string(5 + i) + " ";
    return text + (watch.shown() ? "shown" : "none");
}

TEST(HintWatch, ComesUpOnceTheTimeIsOverAndStays) {
    EXPECT_EQ(hintsOf(3, {0, 0, 0}), "none");
    EXPECT_EQ(hintsOf(3, {0, 0, 0, 0}), "0@8 shown");
    EXPECT_EQ(hintsOf(3, std::vector<scene::StepSet>(20, 0)), "0@8 shown");
}

TEST(HintWatch, CountsAnewFromEachChangeOfWhatIsDone) {
    // The first step is done at 7 and taken back at 12; what is next after it is the third, which the second waits for.
    EXPECT_EQ(hintsOf(3, {0, 0, 1, 1, 1}), "none");
    EXPECT_EQ(hintsOf(3, {0, 0, 1, 1, 1, 1, 1}), "2@10 shown");
    EXPECT_EQ(hintsOf(3, {0, 0, 1, 1, 1, 1, 1, 0}), "2@10 none");
    EXPECT_EQ(hintsOf(3, {0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 0}), "2@10 0@15 shown");
    EXPECT_EQ(hintsOf(3, {5, 5, 5, 5, 5}), "1@8 shown");
}

TEST(HintWatch, ComesUpNeitherWithoutATimeNorWithoutAStepThatIsLeft) {
    EXPECT_EQ(hintsOf(0, std::vector<scene::StepSet>(20, 0)), "none");
    EXPECT_EQ(hintsOf(3, std::vector<scene::StepSet>(20, 7)), "none");
    HintWatch none;
    EXPECT_FALSE(none.follow(0, 0));
    EXPECT_FALSE(none.follow(1'000'000, 0));
}

TEST(HintWatch, MissedCyclesAreTime) {
    HintWatch watch(steps(), 100);
    EXPECT_FALSE(watch.follow(0, 0));
    EXPECT_FALSE(watch.follow(1, 0));
    EXPECT_TRUE(watch.follow(150, 0));
}

}  // namespace
}  // namespace passung::measures
