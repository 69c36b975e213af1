#include <gtest/gtest.h>

#include <algorithm>

#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

std::string joined(const Arguments& arguments) {
    std::string text = "passung";
    for (const std::string& argument : arguments) text += " " + argument;
    return text;
}

/// Names in a folder but for the two files with the program's output.
std::vector<std::string> filesIn(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name != ".out" && name != ".err") names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// A folder with good and bad input files; nothing may be added to it.
class ExitCode : public testing::Test {
protected:
    void SetUp() override {
        writeText(folder_ / "study.toml", smallStudy());
        std::string unknown = smallStudy();
        const auto place = static_cast<std::ptrdiff_t>(unknown.find("hold_s"));
        const auto line = 1 + std::count(unknown.begin(), unknown.begin() + place, '\n');
        unknown_key_ = "unknown_key.toml:" + std::to_string(line) + ":1: error: task.hold_for_s: ";
        unknown.insert(static_cast<std::size_t>(place), "hold_for_s = 1\n");
        writeText(folder_ / "unknown_key.toml", unknown);
        writeText(folder_ / "ball.toml", "[[part]]\nname = \"ball\"\nshape = { kind = \"sphere\", diameter = 20 }\n");
        writeText(folder_ / "no_part.toml", "unit = \"mm\"\n");
        writeText(folder_ / "scene.toml",
                  "[[part]]\nname = \"ball\"\nheld = true\nshape = { kind = \"sphere\", diameter = 20 }\n"
                  "[contact]\ncell_mm = 2.0\nspacing_mm = 4.0\n");
        writeText(folder_ / "poses.csv", "x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0.03,1,0,0,0\n");
        writeText(folder_ / "bad_poses.csv", "x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0.03,1,0,0,0\n0,0,zero,1,0,0,0\n");
        writeText(folder_ / "long_quaternion.csv", "x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0.03,2,0,0,0\n");
        writeText(folder_ / "path.csv", "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.01,0,0,0,1,0,0,0\n");
        writeText(folder_ / "bad_path.csv", "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0,0,0,0,1,0,0,0\n");
        writeText(folder_ / "text.db", "this is no database, however long one looks at it");
        writeText(folder_ / "broken.stl", "solid broken\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n");
        fs::create_directory(folder_ / "full");
        writeText(folder_ / "full/precious.txt", "somebody's");
        before_ = filesIn(folder_.path());
    }

    void expectOnlyInput() const { EXPECT_EQ(filesIn(folder_.path()), before_); }

    TempFolder folder_;
    std::vector<std::string> before_;
    std::string unknown_key_;  // how the line of the error begins
};

TEST_F(ExitCode, IsTwoForWrongUsage) {
    // Truth: invariant (the contract of the command line)
    const std::vector<Arguments> wrong = {
        {"dance"},
        {"run"},
        {"run", "study.toml", "--simulated", "0"},
        {"run", "study.toml", "--simulated", "many"},
        {"run", "study.toml", "--simulated", "2", "--participant", "S001"},
        {"run", "study.toml", "--seed", "-1"},
        {"run", "study.toml", "--fast"},
        {"check"},
        {"export", "study.db"},
        {"replay"},
        {"replay", "study.db", "--attempt", "0"},
        {"mesh", "broken.stl", "--unit", "parsec"},
        {"query", "ball.toml", "ball.toml", "--poses", "poses.csv"},
        {"query", "ball.toml", "--poses", "poses.csv", "--out", "r.csv"},
        {"query", "ball.toml", "ball.toml", "--poses", "poses.csv", "--out", "r.csv", "--mode", "cubist"},
        {"query", "ball.toml", "ball.toml", "--poses", "poses.csv", "--out", "r.csv", "--proximity-mm", "-1"},
        {"query", "ball.toml", "ball.toml", "--poses", "poses.csv", "--out", "r.csv", "--quality", "1.5"},
        {"query", "ball.toml", "ball.toml", "--poses", "poses.csv", "--out", "r.csv", "--spacing-mm", "0"},
        {"simulate", "scene.toml", "--out", "t.csv"},
        {"doctor", "--seconds", "0"},
    };
    for (const Arguments& arguments : wrong) {
        SCOPED_TRACE(joined(arguments));
        const Ended ended = runProgram(folder_.path(), arguments);
        EXPECT_EQ(ended.exit_code, 2);
        EXPECT_EQ(ended.out, "");
        EXPECT_NE(ended.err, "");
        expectOnlyInput();
    }
}

TEST_F(ExitCode, IsOneWithOneLineThatNamesTheFileForBadInput) {
    // Truth: invariant (the contract of the command line; nothing half-written)
    struct Case {
        Arguments arguments;
        std::string line_begins, line_holds;
    };
    const std::vector<Case> bad = {
        {{"check", "none.toml"}, "none.toml: error: ", ""},
        {{"check", "unknown_key.toml"}, unknown_key_, "unknown key"},
        {{"run", "none.toml", "--db", "new.db"}, "none.toml: error: ", ""},
        {{"run", "unknown_key.toml", "--db", "new.db"}, unknown_key_, "unknown key"},
        {{"run", "study.toml", "--db", "text.db"}, "text.db: error: ", ""},
        {{"run", "study.toml", "--db", "nowhere/new.db"}, "nowhere/new.db: error: ", ""},
        {{"explain", "none.toml"}, "none.toml: error: ", ""},
        {{"export", "none.db", "--out", "tables"}, "none.db: error: ", "no such file"},
        {{"export", "text.db", "--out", "tables"}, "text.db: error: ", ""},
        {{"replay", "none.db"}, "none.db: error: ", "no such file"},
        {{"mesh", "none.stl"}, "none.stl: error: ", ""},
        {{"mesh", "broken.stl"}, "broken.stl", "error: "},
        {{"query", "ball.toml", "none.toml", "--poses", "poses.csv", "--out", "r.csv"}, "none.toml: error: ", ""},
        {{"query", "none.stl", "ball.toml", "--poses", "poses.csv", "--out", "r.csv"}, "none.stl: error: ", ""},
        {{"query", "no_part.toml", "ball.toml", "--poses", "poses.csv", "--out", "r.csv"}, "no_part.toml:", "part"},
        {{"query", "ball.toml", "ball.toml", "--poses", "none.csv", "--out", "r.csv"}, "none.csv: error: ", ""},
        {{"query", "ball.toml", "ball.toml", "--poses", "bad_poses.csv", "--out", "r.csv"},
         "bad_poses.csv:3:5: error: ",
         "zero"},
        {{"query", "ball.toml", "ball.toml", "--poses", "long_quaternion.csv", "--out", "r.csv"},
         "long_quaternion.csv:2:",
         "quaternion"},
        {{"query", "ball.toml", "ball.toml", "--poses", "poses.csv", "--out", "nowhere/r.csv", "--cell-mm", "2",
          "--spacing-mm", "4"},
         "nowhere/r.csv: error: ",
         "cannot be written"},
        {{"simulate", "none.toml", "--trajectory", "path.csv", "--out", "t.csv"}, "none.toml: error: ", ""},
        {{"simulate", "scene.toml", "--trajectory", "none.csv", "--out", "t.csv"}, "none.csv: error: ", ""},
        {{"simulate", "scene.toml", "--trajectory", "bad_path.csv", "--out", "t.csv"}, "bad_path.csv:3:", "rise"},
        {{"simulate", "scene.toml", "--trajectory", "path.csv", "--out", "nowhere/t.csv"},
         "nowhere/t.csv: error: ",
         "cannot be written"},
    };
    for (const Case& c : bad) {
        SCOPED_TRACE(joined(c.arguments));
        const Ended ended = runProgram(folder_.path(), c.arguments);
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_EQ(ended.out, "");
        EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
        EXPECT_EQ(ended.err.substr(0, c.line_begins.size()), c.line_begins) << ended.err;
        EXPECT_NE(ended.err.find(c.line_holds), std::string::npos) << ended.err;
        expectOnlyInput();
    }
}

TEST_F(ExitCode, IsOneForAnAttemptThatIsNotThere) {
    // Truth: invariant (the contract of the command line)
    ASSERT_EQ(runProgram(folder_.path(), {"run", "study.toml", "--db", "s.db"}).exit_code, 0);
    const Ended ended = runProgram(folder_.path(), {"replay", "s.db", "--attempt", "77"});
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_EQ(ended.err, "s.db: error: there is no attempt 77\n");
}

TEST_F(ExitCode, IsOneForAnExportIntoSomebodysFolder) {
    // Truth: invariant (what is not an export is never replaced)
    ASSERT_EQ(runProgram(folder_.path(), {"run", "study.toml", "--db", "s.db"}).exit_code, 0);
    const Ended refused = runProgram(folder_.path(), {"export", "s.db", "--out", "full"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_EQ(linesOf(refused.err).size(), 1u) << refused.err;
    EXPECT_EQ(refused.err.substr(0, 12), "full: error:") << refused.err;
    EXPECT_EQ(filesIn(folder_ / "full"), Arguments{"precious.txt"});
}

TEST_F(ExitCode, AUnitSlipIsRefusedBeforeAnythingIsBuilt) {
    // Truth: closed form: right triangles of 30 m sides have 450 m2, three of them and one of 779 m2 make 2129 m2; at
    // 1 mm that is 2.1e9 points. The peg of 20 x 20 mm in m: pi 20 (10 + 20) m2; 10 m is the most of an edge.
    writeText(
        folder_ / "tetra.stl",
        "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 30 0\nvertex 30 0 0\nendloop\nendfacet\n"
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 30 0 0\nvertex 0 0 30\nendloop\nendfacet\n"
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 30\nvertex 0 30 0\nendloop\nendfacet\n"
        "facet normal 0 0 1\nouter loop\nvertex 30 0 0\nvertex 0 30 0\nvertex 0 0 30\nendloop\nendfacet\nendsolid "
        "t\n");
    const Ended query = runProgram(folder_.path(), {"query", "ball.toml", "tetra.stl", "--poses", "poses.csv", "--out",
                                                    "r.csv", "--cell-mm", "2", "--shell-unit", "m"});
    EXPECT_EQ(query.exit_code, 1);
    EXPECT_EQ(query.err,
              "tetra.stl: error: part tetra.stl: points 1 mm apart on a part of 3e+04 x 3e+04 x 3e+04 mm are about "
              "2.1e+09, more than 2e+06: check its unit, or choose a spacing of at least 32.8 mm\n");
    std::string slip = onFields(smallStudy());
    slip.replace(slip.find("unit = \"mm\""), 11, "unit = \"cm\"");
    slip.replace(slip.find("spacing_mm = 3.0"), 16, "spacing_mm = 0.2");
    slip.replace(slip.find("position = [4, 0, 8]"), 20, "position = [4, 0, 9]");
    writeText(folder_ / "slip.toml", slip);
    for (const char* command : {"check", "run"}) {
        const Ended ended = runProgram(folder_.path(), {command, "slip.toml"});
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
        EXPECT_NE(ended.err.find("0.2 mm apart on a part of 200 x 200 x 200 mm are about 4.7e+06, more than 2e+06: "
                                 "check its unit"),
                  std::string::npos)
            << ended.err;
    }
}

TEST_F(ExitCode, IsOneForAnOutputThatIsAnInput) {
    // Truth: invariant (an input is never lost; another name of it is the same file)
    fs::create_symlink("poses.csv", folder_.path() / "link.csv");
    const std::vector<Arguments> wrong = {
        {"query", "ball.toml", "ball.toml", "--poses", "poses.csv", "--out", "poses.csv"},
        {"query", "ball.toml", "ball.toml", "--poses", "poses.csv", "--out", "./ball.toml"},
        {"query", "ball.toml", "ball.toml", "--poses", "link.csv", "--out", "poses.csv"},
        {"simulate", "scene.toml", "--trajectory", "path.csv", "--out", "path.csv"},
        {"simulate", "scene.toml", "--trajectory", "path.csv", "--out", "scene.toml"},
    };
    for (const Arguments& arguments : wrong) {
        SCOPED_TRACE(joined(arguments));
        const std::string before = readText(folder_ / arguments.back());
        const Ended ended = runProgram(folder_.path(), arguments);
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_EQ(
            ended.err,
            arguments.back() + ": error: is an input of this command and would be lost: name another file for --out\n");
        EXPECT_EQ(readText(folder_ / arguments.back()), before);
    }
}

TEST_F(ExitCode, AFileOfAnotherKindIsNamedAsWhatItIs) {
    // Truth: invariant (one line: what it is, what is wanted)
    const std::vector<std::pair<Arguments, std::string>> mixed = {
        {{"simulate", "study.toml", "--trajectory", "path.csv", "--out", "t.csv"},
         "study.toml:1:1: error: is a study file (it has a [study]); wanted here is a scene file"},
        {{"query", "study.toml", "ball.toml", "--poses", "poses.csv", "--out", "r.csv"},
         "study.toml:1:1: error: is a study file (it has a [study]); wanted here is a part file"},
        {{"query", "ball.toml", "scene.toml", "--poses", "poses.csv", "--out", "r.csv", "--cell-mm", "2"},
         "scene.toml:1:1: error: is a scene file"},
        {{"check", "scene.toml"}, "scene.toml:1:1: error: is a scene file"},
        {{"check", "ball.toml"}, "ball.toml:1:1: error: is a part file"},
        // The key alone makes no study of it.
        {{"simulate", "versioned.toml", "--trajectory", "path.csv", "--out", "t.csv"},
         "versioned.toml:1:1: error: passung: "},
        {{"check", "versioned.toml"}, "versioned.toml:1:1: error: is a scene file"},
    };
    writeText(folder_ / "versioned.toml", "passung = 1\n" + readText(folder_ / "scene.toml"));
    for (const auto& [arguments, begins] : mixed) {
        SCOPED_TRACE(joined(arguments));
        const Ended ended = runProgram(folder_.path(), arguments);
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
        EXPECT_EQ(ended.err.substr(0, begins.size()), begins);
    }
    const Ended header =
        runProgram(folder_.path(), {"query", "ball.toml", "ball.toml", "--poses", "path.csv", "--out", "r.csv"});
    EXPECT_NE(header.err.find("must be x_m,y_m,z_m,qw,qx,qy,qz"), std::string::npos) << header.err;
}

TEST_F(ExitCode, WrongWordsAndNumbersAreNamed) {
    // Truth: invariant (what was written, what is wanted)
    const std::vector<std::pair<Arguments, std::string>> wrong = {
        {{"chek", "study.toml"}, "unknown command \"chek\"; did you mean \"check\"?"},
        {{"run", "study.toml", "--simulated", "0"}, "must be a whole number ≥ 1, not \"0\""},
        {{"run", "study.toml", "--seed", "abc"}, "must be a whole number ≥ 0, not \"abc\""},
        {{"run", "study.toml", "--seed", "-1"}, "must be a whole number ≥ 0, not \"-1\""},
        {{"doctor", "--seconds", "0"}, "must be a number from 0.1 to 3600, not \"0\""},
    };
    for (const auto& [arguments, words] : wrong) {
        SCOPED_TRACE(joined(arguments));
        const Ended ended = runProgram(folder_.path(), arguments);
        EXPECT_EQ(ended.exit_code, 2);
        EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
        for (const std::string& line : linesOf(ended.err)) EXPECT_LE(line.size(), 160u) << line;
    }
}

TEST_F(ExitCode, AnInterruptedRunEndsCleanlyAndSaysHowToGoOn) {
    // Truth: invariant (the signal comes once the first trial is durable; 50 participants would take minutes)
    for (const int signal : {SIGINT, SIGTERM}) {
        Program program(folder_.path(), {"run", "study.toml", "--db", "s.db", "--simulated", "50"}, true);
        EXPECT_NE(program.nextAcknowledgement(), "");
        program.send(signal);
        EXPECT_EQ(program.wait(), 1);
        EXPECT_NE(program.err().find("s.db: error: interrupted: "), std::string::npos) << program.err();
        EXPECT_EQ(linesOf(program.err()).size(), 1u) << program.err();
        const store::Database database(folder_ / "s.db", store::OpenMode::ReadOnly);
        EXPECT_EQ(database.integer("SELECT count(*) FROM attempt WHERE outcome IN ('running', 'crashed')"), 0);
        EXPECT_EQ(database.integer("SELECT count(*) FROM session WHERE end_state IS NULL OR end_state='crashed'"), 0);
        EXPECT_GE(database.integer("SELECT count(*) FROM session WHERE end_state='aborted'"), 1);
        EXPECT_GE(database.integer("SELECT count(*) FROM event WHERE event='session_interrupted'"), 1);
    }
    const Ended again = runProgram(folder_.path(), {"run", "study.toml", "--db", "s.db"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(again.out.find("killed"), std::string::npos) << again.out;
}

TEST_F(ExitCode, IsZeroForHelpAndVersion) {
    // Truth: invariant (the contract of the command line)
    for (const char* option : {"--help", "--version"}) {
        const Ended ended = runProgram(folder_.path(), {option});
        EXPECT_EQ(ended.exit_code, 0);
        EXPECT_NE(ended.out, "");
        EXPECT_EQ(ended.err, "");
    }
    for (const char* command : {"check", "explain", "run", "export", "replay", "mesh", "query", "simulate", "doctor"}) {
        EXPECT_EQ(runProgram(folder_.path(), {command, "--help"}).exit_code, 0) << command;
    }
}

TEST_F(ExitCode, IsOneForEveryInvalidProtocolAndNoDatabaseAppears) {
    // Truth: invariant (the error's place and words are checked with the reader; here: the exit code, nothing written)
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(PASSUNG_SOURCE_DIR) / "tests/data/invalid")) {
        if (entry.path().extension() != ".toml") continue;
        SCOPED_TRACE(entry.path().filename().string());
        ++count;
        for (const Arguments& arguments : {Arguments{"check", entry.path()}, Arguments{"run", entry.path()}}) {
            const Ended ended = runProgram(folder_.path(), arguments);
            EXPECT_EQ(ended.exit_code, 1);
            EXPECT_EQ(ended.out, "");
            EXPECT_EQ(ended.err.substr(0, entry.path().string().size()), entry.path().string());
            EXPECT_NE(ended.err.find(": error: "), std::string::npos);
        }
        expectOnlyInput();
    }
    EXPECT_GE(count, 12u);
}

}  // namespace
}  // namespace passung::test
