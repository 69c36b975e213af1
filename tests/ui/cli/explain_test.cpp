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
    writeText(folder / "study.toml", onFields(smallStudyWith(R"([[factor]]
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

)")));
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

/// The named columns of a CSV without quotes, a line for each row; P for the first letter of each.
std::vector<std::string> columnsOf(const std::string& csv, const std::vector<std::string>& names) {
    const auto cellsOf = [](const std::string& line) {
        std::vector<std::string> cells(1);
        for (const char c : line) {
            if (c == ',')
                cells.emplace_back();
            else
                cells.back() += c;
        }
        return cells;
    };
    const auto lines = linesOf(csv);
    const auto head = cellsOf(lines.at(0));
    std::vector<std::string> rows;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const auto cells = cellsOf(lines[i]);
        std::string row;
        for (const auto& name : names)
            row += cells.at(static_cast<std::size_t>(std::find(head.begin(), head.end(), name) - head.begin())) + ' ';
        row.front() = 'P';
        rows.push_back(row);
    }
    return rows;
}

TEST(Explain, OrdersAsATableAreWhatARehearsalOfTheSameNumbersGets) {
    // Truth: invariant: a rehearsal shows what people will get. Told by the bytes of an export; shuffles, groups and
    // catch trials are drawn per participant.
    const TempFolder folder;
    std::string study = smallStudyWith(R"([[factor]]
name = "chance"
levels = [
  { label = "none", set = { "task.timeout_s" = 0.4 } },
  { label = "short", set = { "task.timeout_s" = 0.5 } },
  { label = "long", set = { "task.timeout_s" = 0.6 } },
]
[[factor]]
name = "stiffness"
kind = "between"
key = "contact.stiffness_N_per_m"
levels = [500, 1000]

)");
    study += "[[block]]\nname = \"mixed\"\norder = \"random\"\nrepetitions = 2\n";
    writeText(folder / "study.toml", study);
    const Ended planned = runProgram(folder.path(), {"explain", "study.toml", "--orders", "csv"});
    ASSERT_EQ(planned.exit_code, 0) << planned.err;
    const Ended ran =
        runProgram(folder.path(), {"run", "study.toml", "--simulated", "4", "--db", "s.db", "--no-backup"});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const Ended told = runProgram(folder.path(), {"export", "s.db", "--out", "e", "--no-samples"});
    ASSERT_EQ(told.exit_code, 0) << told.err;
    const std::vector<std::string> names = {"participant_id", "group",     "session", "block_index", "block",
                                            "phase",          "condition", "chance",  "stiffness"};
    const auto expected = columnsOf(planned.out, names);
    EXPECT_EQ(expected.size(), 4u * (3 * 3 + 3 * 2));
    EXPECT_EQ(columnsOf(readText(folder / "e/trials.csv"), names), expected);
}

TEST(Explain, HasNoOrdersOfAScene) {
    // Truth: invariant (a scene has no participants)
    const TempFolder folder;
    writeText(folder / "scene.toml",
              "[[part]]\nname = \"ball\"\nheld = true\nshape = { kind = \"sphere\", diameter = 20 }\n");
    const Ended ended = runProgram(folder.path(), {"explain", "scene.toml", "--orders", "csv"});
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_EQ(ended.err, "scene.toml: error: a scene has no orders: --orders is for study files\n");
}

TEST(Explain, TellsWhatIsNotRunBuiltOrPaired) {
    // Truth: the scene by hand: closed forms, no effect, two parts at rest.
    const TempFolder folder;
    writeText(folder / "scene.toml", R"(unit = "mm"
part = [
  { name = "ball", held = true, shape = { kind = "sphere", diameter = 10 }, pose = { position = [0, 0, 20] } },
  { name = "a", shape = { kind = "box", width = 20, depth = 20, height = 20 } },
  { name = "b", shape = { kind = "box", width = 20, depth = 20, height = 20 }, pose = { position = [40, 0, 0] } },
]
)");
    const Ended ended = runProgram(folder.path(), {"explain", "scene.toml"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    for (const char* line : {"\n  contact transients      effects.transients is not set\n",
                             "\n  contacts at the hand    contact is computed from the shapes' closed forms\n",
                             "\n  distance fields         contact is computed from closed forms\n",
                             "\n  1 pair of parts         nobody holds either of them; 2 of 3 parts rest\n"})
        EXPECT_NE(ended.out.find(line), std::string::npos) << line << ended.out;
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
