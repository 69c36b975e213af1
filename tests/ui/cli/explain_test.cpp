#include <gtest/gtest.h>

#include <algorithm>

#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

/// Lines that head a table of stages.
std::vector<std::string> groupsOf(const std::string& out) {
    std::vector<std::string> groups;
    for (const std::string& line : linesOf(out)) {
        if (line.starts_with("  conditions ")) groups.push_back(line.substr(13));
    }
    return groups;
}

std::string smallStudyWith(const std::string& factor) {
    std::string study = smallStudy();
    const auto begin = study.find("[[factor]]");
    study.replace(begin, study.find("[task]") - begin, factor);
    return study;
}

TEST(Explain, GivesConditionsOfAnotherGeometryOrResolutionATableOfTheirOwn) {
    // Truth: invariant (what a stage costs depends on cells, points and clearance; not on stiffness)
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudyWith(R"([[factor]]
name = "place"
levels = [
  { label = "wide", set = { "contact.cell_mm" = 1.0 } },
  { label = "fine", set = { "contact.cell_mm" = 0.9 } },
  { label = "tight", set = { "part.plate.shape.bore_diameter" = 21 } },
]
[[factor]]
name = "stiffness"
key = "contact.stiffness_N_per_m"
levels = [500, 1000]

)"));
    const Ended ended = runProgram(folder.path(), {"explain", "study.toml"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(groupsOf(ended.out),
              (std::vector<std::string>{"wide/500, wide/1000", "fine/500, fine/1000", "tight/500, tight/1000"}));
}

TEST(Explain, KnowsAStudyByItsKeysHoweverTheyAreWritten) {
    // Truth: invariant (TOML lets a table be written in several ways)
    const TempFolder folder;
    const std::string plain = smallStudy();
    std::string spaced = plain;
    spaced.replace(spaced.find("[study]"), 7, "  [ study ]");
    std::string inlined = plain;
    const auto begin = inlined.find("[study]");
    inlined.replace(begin, inlined.find("\n\n[scene]") - begin,
                    "study = { name = \"small\", version = \"1\", seed = 7, participants = 4 }");
    for (const std::string& text : {plain, spaced, inlined}) {
        writeText(folder / "s.toml", text);
        const Ended ended = runProgram(folder.path(), {"explain", "s.toml"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_NE(ended.out.find("study small"), std::string::npos) << text;
    }
    writeText(folder / "scene.toml",
              "# [study] stands in a comment only\n[[part]]\nname = \"ball\"\nheld = true\n"
              "shape = { kind = \"sphere\", diameter = 20 }\n[contact]\ncell_mm = 2.0\nspacing_mm = 4.0\n");
    const Ended scene = runProgram(folder.path(), {"explain", "scene.toml"});
    EXPECT_EQ(scene.exit_code, 0) << scene.err;
    EXPECT_NE(scene.out.find("stage of the tick"), std::string::npos);
}

TEST(Explain, GivesTheDiameterOfAFit) {
    // Truth: closed form: 20 g6 is 19.980 to 19.993 mm; the least clearance takes the thicker.
    const TempFolder folder;
    writeText(folder / "scene.toml",
              "[[part]]\nname = \"peg\"\nheld = true\n"
              "shape = { kind = \"peg\", fit = \"H7/g6\", nominal_diameter = 20, deviation = \"min\", length = 50 }\n"
              "[contact]\ncell_mm = 2.0\nspacing_mm = 4.0\n");
    const Ended ended = runProgram(folder.path(), {"explain", "scene.toml"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NE(ended.out.find("peg, diameter 19.993, length 50, chamfer 0 mm"), std::string::npos) << ended.out;
}

TEST(Check, WarnsOnTheErrorStreamAndStillSucceeds) {
    // Truth: invariant (a warning is not a result)
    const TempFolder folder;
    std::string study = smallStudy();
    study.replace(study.find("participants = 4"), 16, "participants = 3");
    study.insert(study.find("[scene.device]"), "variant = \"raw\"\n\n");
    writeText(folder / "study.toml", study);
    const Ended ended = runProgram(folder.path(), {"check", "study.toml"});
    EXPECT_EQ(ended.exit_code, 0);
    const auto lines = linesOf(ended.err);
    ASSERT_EQ(lines.size(), 2u) << ended.err;
    EXPECT_TRUE(lines[0].starts_with("study.toml: warning: contact.variant = \"raw\" ")) << lines[0];
    EXPECT_TRUE(lines[0].ends_with("conditions: none")) << lines[0];
    EXPECT_TRUE(lines[1].starts_with("study.toml: warning: study.participants = 3 ")) << lines[1];
    EXPECT_EQ(linesOf(ended.out).size(), 1u) << ended.out;
}

TEST(Doctor, NamesTheVersionsOfProgramAndLibraries) {
    // Truth: invariant (a report of a fault needs them)
    const TempFolder folder;
    const Ended ended = runProgram(folder.path(), {"doctor", "--seconds", "0.1"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const auto lines = linesOf(ended.out);
    for (const std::string name :
         {"passung", "Eigen", "assimp", "SQLite", "toml++", "fmt", "CLI11", "zlib", "OpenSSL", "compiler"}) {
        const auto line = std::find_if(lines.begin(), lines.end(),
                                       [&](const std::string& l) { return l.starts_with("  " + name + " "); });
        ASSERT_NE(line, lines.end()) << name;
        EXPECT_NE(line->find_first_of("0123456789", 2 + name.size()), std::string::npos) << *line;
    }
}

}  // namespace
}  // namespace passung::test
