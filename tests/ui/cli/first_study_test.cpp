#include <gtest/gtest.h>

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
    const Ended effect = runProgram(folder.path(), {"power", "study.toml", "--effect", "clearance:0.25=+0.5",
                                                    "--simulation", "model", "--repeats", "20"});
    EXPECT_EQ(effect.exit_code, 0) << effect.err;
    EXPECT_NE(tutorial.find("--effect \"clearance:0.25=+0.5\" --simulation model"), std::string::npos);
}

}  // namespace
}  // namespace passung::test
