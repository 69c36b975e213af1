#include <cstdlib>

#include "tests/ui/cli/program.h"

// The windows' program where no display is: help is printed, everything else is one line.

namespace passung::test {
namespace {

class NoDisplay : public testing::Test {
protected:
    void SetUp() override {
        for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) unsetenv(name);
    }

    void expectOneLine(const std::vector<std::string>& arguments) {
        const Ended ended = runProgram(folder_.path(), arguments);
        EXPECT_EQ(ended.exit_code, 1);
        const auto lines = linesOf(ended.err);
        ASSERT_EQ(lines.size(), 1u) << ended.err;
        EXPECT_EQ(lines[0].find("error: no display: "), 0u) << lines[0];
        EXPECT_EQ(ended.out, "");
    }

    TempFolder folder_;
};

TEST_F(NoDisplay, HelpNeedsNone) {
    // Truth: invariant: every option of the program stands in its help.
    for (const char* asks : {"--help", "-h", "--help-all"}) {
        const Ended ended = runProgram(folder_.path(), {asks});
        EXPECT_EQ(ended.exit_code, 0) << asks;
        EXPECT_EQ(ended.err, "") << asks;
        for (const char* option : {"FOLDER", "--language", "--light", "--text-size", "--first-picture"})
            EXPECT_NE(ended.out.find(option), std::string::npos) << asks << ": " << option;
    }
}

TEST_F(NoDisplay, EverythingElseIsOneLine) {
    // Truth: invariant. No display is named, one is named at which nobody answers, a platform is asked for.
    expectOneLine({});
    expectOneLine({"--language", "de"});
    expectOneLine({"--unknown"});
    setenv("DISPLAY", ":4711", 1);
    expectOneLine({});
    setenv("WAYLAND_DISPLAY", "nobody", 1);
    expectOneLine({});
    setenv("QT_QPA_PLATFORM", "xcb", 1);
    expectOneLine({});
}

TEST_F(NoDisplay, AValueThatAnOptionDoesNotTakeIsOneLine) {
    // Truth: invariant. Qt's platform without a screen stands in for a display, which these never come to use.
    setenv("QT_QPA_PLATFORM", "offscreen", 1);
    for (const auto& [arguments, line] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"--language", "fr"}, "error: --language: \"fr\": must be en or de"},
             {{"--text-size", "large"}, "error: --text-size: \"large\": must be a number from 75 to 200"},
             {{"--text-size", "74"}, "error: --text-size: \"74\": must be a number from 75 to 200"},
             {{"absent"}, "error: absent: no such folder"}}) {
        const Ended ended = runProgram(folder_.path(), arguments);
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_EQ(linesOf(ended.err).back(), line);
    }
}

}  // namespace
}  // namespace passung::test
