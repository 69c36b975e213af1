#include <gtest/gtest.h>

#include <sstream>

#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;

/// The text of all blocks of the language in a Markdown file.
std::string codeOf(const std::string& markdown, const std::string& language) {
    std::string code;
    bool inside = false;
    for (const std::string& line : linesOf(markdown)) {
        if (inside && line == "```") inside = false;
        if (inside) code += line + "\n";
        if (line == "```" + language) inside = true;
    }
    return code;
}

TEST(FirstStudy, TheStudyThatTheTutorialWritesRunsAsItSays) {
    // Truth: invariant: what a newcomer types is what the program takes.
    const fs::path protocols = PASSUNG_SOURCE_DIR "/protocols";
    const std::string tutorial = readText(protocols / "FIRST_STUDY.md");
    const TempFolder folder;
    writeText(folder / "study.toml", codeOf(tutorial, "toml"));
    fs::copy_file(protocols / "questionnaires/nasa_tlx_raw.toml", folder / "nasa_tlx_raw.toml");
    const Ended checked = runProgram(folder.path(), {"check", "study.toml"});
    EXPECT_EQ(checked.err, "");
    EXPECT_EQ(checked.out, "study.toml: ok: tight_or_soft 1.0, 4 conditions, 14 trials for each of 8 participants\n");
    const Ended effect = runProgram(folder.path(), {"power", "study.toml", "--effect", "clearance:0.25=+0.5~0.3",
                                                    "--simulation", "model", "--repeats", "20"});
    EXPECT_EQ(effect.exit_code, 0) << effect.err;
    EXPECT_NE(tutorial.find("--effect \"clearance:0.25=+0.5~0.3\" --simulation model"), std::string::npos);
}

/// The words of a line of a shell without quotes, up to its comment.
std::vector<std::string> wordsOf(const std::string& line) {
    std::istringstream stream(line.substr(0, line.find('#')));
    return {std::istream_iterator<std::string>(stream), {}};
}

TEST(FirstStudy, TheSmallestStudyOfTheFrontPageRunsByTheCommandsBelowIt) {
    // Truth: invariant: what the front page shows is what the program takes.
    const std::string page = readText(PASSUNG_SOURCE_DIR "/README.md");
    const TempFolder folder;
    writeText(folder / "first.toml", codeOf(page, "toml"));
    int commands = 0;
    for (const std::string& line : linesOf(codeOf(page, "sh"))) {
        std::vector<std::string> words = wordsOf(line);
        ASSERT_GE(words.size(), 2u) << line;
        ASSERT_EQ(words.front(), "passung") << line;
        words.erase(words.begin());
        const Ended ended = runProgram(folder.path(), words);
        EXPECT_EQ(ended.exit_code, 0) << line << "\n" << ended.err;
        EXPECT_EQ(ended.err, "") << line;
        ++commands;
    }
    EXPECT_EQ(commands, 3);
    for (const char* file : {"report/codebook.csv", "report/analysis.Rmd"})
        EXPECT_TRUE(fs::is_regular_file(folder / file)) << file;
}

}  // namespace
}  // namespace passung::test
