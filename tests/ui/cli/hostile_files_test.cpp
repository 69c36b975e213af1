#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "core/base/sanitizer.h"
#include "core/import/mesh_import.h"
#include "tests/support/hostile_scene.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

constexpr const char* kDeviceThatNeverEnds = "/dev/zero";

/// Runs the program to its end; what takes too long is ended, with exit code 124.
Ended runWithin(const std::filesystem::path& folder, std::vector<std::string> arguments, int seconds = 60) {
    std::string line = "cd '" + folder.string() + "' && timeout " + std::to_string(seconds) + " '" PASSUNG_PROGRAM "'";
    for (const std::string& argument : arguments) line += " '" + argument + "'";
    const int status = std::system((line + " >.out 2>.err").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(folder / ".out"), readText(folder / ".err")};
}

/// Exit code 1 and one line that holds `requirement`.
void expectOneLine(const Ended& ended, const std::string& requirement, const std::string& what) {
    EXPECT_EQ(ended.exit_code, 1) << what << "\n" << ended.err;
    const auto lines = linesOf(ended.err);
    ASSERT_EQ(lines.size(), 1u) << what << "\n" << ended.err.substr(0, 2000);
    EXPECT_NE(lines[0].find(requirement), std::string::npos) << what << "\n" << lines[0];
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

const std::string kOff = "OFF\n4 4 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const std::string kPart = "[[part]]\nname = \"a\"\nheld = true\nmesh = \"a.off\"\n";

TEST(HostileFiles, PipeOrDeviceBehindAPathIsRefusedAtOnce) {
    // Truth: invariant (nobody writes into the pipe: a program that opens it waits for ever; the device never ends).
    const TempFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    for (const char* name : {"pipe.off", "pipe.3mf", "pipe.db", "pipe.toml", "pipe.csv"})
        std::filesystem::create_symlink("pipe", folder.path() / name);
    for (const char* name : {"zero.off", "zero.3mf", "zero.db", "zero.toml", "zero.csv"})
        std::filesystem::create_symlink(kDeviceThatNeverEnds, folder.path() / name);
    writeText(folder / "a.off", kOff);
    writeText(folder / "scene.toml", kPart);
    writeText(folder / "damaged.db", std::string("SQLite format 3\0", 16) + std::string(5000, 'x'));
    for (const std::string kind : {"pipe", "zero"}) {
        writeText(folder / (kind + "_mesh.toml"), replaced(kPart, "a.off", kind + ".off"));
        writeText(folder / (kind + "_include.toml"), "include = \"" + kind + ".toml\"\n" + smallStudy());
        writeText(folder / (kind + "_forms.toml"),
                  smallStudy() + "\n[[questionnaire]]\nkey = \"q\"\nfile = \"" + kind + ".toml\"\nwhen = \"end\"\n");
        const std::vector<std::vector<std::string>> calls{
            {"check", kind + ".toml"},
            {"check", kind + "_include.toml"},
            {"check", kind + "_forms.toml"},
            {"explain", kind + ".toml"},
            {"run", kind + ".toml"},
            {"mesh", kind + ".off"},
            {"mesh", kind + ".3mf"},
            {"mesh", kind + "_mesh.toml"},
            {"simulate", kind + ".toml", "--trajectory", "a.csv", "--out", "t.csv"},
            {"simulate", "scene.toml", "--trajectory", kind + ".csv", "--out", "t.csv"},
            {"query", "a.off", "a.off", "--poses", kind + ".csv", "--out", "r.csv"},
            {"power", "--merge", kind + ".csv"},
            {"export", kind + ".db", "--out", "e"},
            {"replay", kind + ".db"},
            {"resume", kind + ".db"},
            {"participant", "list", kind + ".db"},
            {"merge", kind + ".db", "--out", "m.db"},
            {"push", kind + ".db", "--to", "postgresql://nobody@127.0.0.1:1/none"},
            {"verify", kind + ".db"},
            {"restore", kind + ".db", "--from", "damaged.db"},
            {"restore", "damaged.db", "--from", kind + ".db"},
        };
        for (const auto& call : calls) {
            const Ended ended = runWithin(folder.path(), call);
            std::string words;
            for (const std::string& word : call) words += word + " ";
            EXPECT_EQ(ended.exit_code, 1) << words << ended.err;
            EXPECT_FALSE(ended.err.empty()) << words;
        }
    }
}

TEST(HostileFiles, PipeBesideADatabaseIsRefusedAtOnceAndADatabaseIsNoOutput) {
    // Truth: invariant (nobody writes into the pipes; the database keeps its bytes).
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudy());
    ASSERT_EQ(runWithin(folder.path(), {"run", "study.toml", "--simulated", "1", "--db", "s.db"}).exit_code, 0);
    const std::string whole = readText(folder / "s.db");
    for (const char* beside : {"s.db-journal", "s.db-wal"}) {
        ASSERT_EQ(mkfifo((folder / beside).c_str(), 0600), 0);
        EXPECT_EQ(runWithin(folder.path(), {"verify", "s.db"}).exit_code, 1) << beside;
        EXPECT_EQ(runWithin(folder.path(), {"export", "s.db", "--out", "e"}).exit_code, 1) << beside;
        std::filesystem::remove(folder / beside);
    }
    ASSERT_EQ(mkfifo((folder / "s.db.lock").c_str(), 0600), 0);
    EXPECT_EQ(runWithin(folder.path(), {"verify", "s.db"}).exit_code, 0) << "a lock that nobody holds";
    std::filesystem::remove(folder / "s.db.lock");
    std::filesystem::create_directory(folder / "e");
    for (const char* name : {"codebook.json", "SHA256SUMS"})
        ASSERT_EQ(mkfifo((folder.path() / "e" / name).c_str(), 0600), 0);
    EXPECT_EQ(runWithin(folder.path(), {"export", "s.db", "--out", "e"}).exit_code, 1);

    writeText(folder / "a.off", kOff);
    writeText(folder / "p.csv", "x_m,y_m,z_m,qw,qx,qy,qz\n0,0,1,1,0,0,0\n");
    expectOneLine(runWithin(folder.path(), {"query", "a.off", "a.off", "--poses", "p.csv", "--out", "s.db"}),
                  "is a database", "query");
    EXPECT_TRUE(readText(folder / "s.db") == whole);
}

TEST(HostileFiles, TextThatIsTooDeepOrTooLargeIsRefusedInOneLine) {
    // Truth: closed form. One row per way to exhaust a reader of text.
    const TempFolder folder;
    std::string dotted = "a", many;
    for (int i = 0; i < 20'000; ++i) dotted += ".a";
    for (int i = 0; i < 20'000; ++i) many += std::string(i == 0 ? "" : ".") + "\"a\"";
    std::string tables = "x = ";
    for (int i = 0; i < 40; ++i) tables += "{ a.b.c.d.e.f.g.h = ";
    writeText(folder / "dotted.toml", dotted + " = 1\n");
    writeText(folder / "head.toml", "[" + many + "]\n");
    writeText(folder / "lists.toml", "x = " + std::string(200'000, '[') + "\n");
    writeText(folder / "tables.toml", tables + "1" + std::string(40, '}') + "\n");
    writeText(folder / "large.toml", "# " + std::string(std::size_t{5} << 20, 'x') + "\n" + smallStudy());
    writeText(folder / "d0.toml", "# the end\n");
    for (int i = 1; i <= 30; ++i) {
        const std::string line = "include = \"d" + std::to_string(i - 1) + ".toml\"\n";
        writeText(folder / ("d" + std::to_string(i) + ".toml"), line + line);
    }
    for (const char* name : {"dotted.toml", "head.toml", "lists.toml", "tables.toml"})
        expectOneLine(runWithin(folder.path(), {"check", name}), ":1:", name);
    expectOneLine(runWithin(folder.path(), {"check", "dotted.toml"}), "64 levels deep", "dotted");
    expectOneLine(runWithin(folder.path(), {"check", "large.toml"}), "at most 4 MiB", "large");
    expectOneLine(runWithin(folder.path(), {"check", "d30.toml"}), "256 files", "includes");
}

TEST(HostileFiles, LengthsAndCellsThatCannotBeBuiltAreFoundByCheckAtTheirPlace) {
    // Truth: closed form (a diameter of 1e-100 mm; cells of 0.5 µm on a plate of 40 x 40 mm need terabytes).
    const TempFolder folder;
    const std::string tiny = replaced(smallStudy(), "kind = \"peg\", diameter = 20, length = 20, chamfer = 1",
                                      "kind = \"sphere\", diameter = 1e-100");
    writeText(folder / "tiny.toml", tiny);
    writeText(folder / "cells.toml", replaced(smallStudy(), "cell_mm = 1.0", "cell_mm = 0.0005"));
    writeText(folder / "sound.toml", smallStudy());
    expectOneLine(runWithin(folder.path(), {"check", "tiny.toml"}), "diameter: 1e-100: must be at least", "tiny");
    const Ended cells = runWithin(folder.path(), {"check", "cells.toml"});
    expectOneLine(cells, "GiB, more than 2", "cells");
    EXPECT_EQ(cells.err.substr(0, 11), "cells.toml:") << cells.err;
    EXPECT_NE(cells.err.find("cell_mm"), std::string::npos);
    EXPECT_EQ(runWithin(folder.path(), {"check", "sound.toml"}).exit_code, 0);
}

TEST(HostileFiles, MeshOfMoreThanAReaderMayTakeIsOneLineThatNamesTheOption) {
    // Truth: invariant (64 MiB of memory do not hold a mesh of 600 000 triangles; the usual limit does).
    const TempFolder folder;
    std::string off = "OFF\n300000 600000 0\n";
    for (int i = 0; i < 300'000; ++i) off += std::to_string(i % 640) + " " + std::to_string(i / 640) + " 0\n";
    for (int i = 0; i < 600'000; ++i)
        off += "3 " + std::to_string(i % 299'000) + " " + std::to_string(i % 299'000 + 1) + " " +
               std::to_string(i % 299'000 + (i < 300'000 ? 640 : 641)) + "\n";
    writeText(folder / "a.off", off);
    expectOneLine(runWithin(folder.path(), {"mesh", "a.off", "--import-seconds", "1"}), "--import-seconds", "time");
    if (!kSanitized)
        expectOneLine(runWithin(folder.path(), {"mesh", "a.off", "--import-memory-mb", "64"}), "--import-memory-mb",
                      "memory");
    for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
             {"itself.3mf", package(assembly("1", "1", 1), item("1"))}, {"deep.gltf", std::string(200'000, '[')}}) {
        writeText(folder / name, content);
        expectOneLine(runWithin(folder.path(), {"mesh", name}), "must be a mesh that can be read", name);
    }
}

TEST(HostileFiles, MeshReadElsewhereIsThatReadHere) {
    // Truth: invariant (the same bytes by either way: what the program prints is the report of the library).
    const TempFolder folder;
    writeText(folder / "a.off", kOff);
    writeText(folder / "b.3mf", tens(1));
    for (const std::string name : {"a.off", "b.3mf"}) {
        const auto here = importer::importMesh(folder / name, 1e-3);
        ASSERT_TRUE(here);
        const Ended there = runWithin(folder.path(), {"mesh", name});
        ASSERT_EQ(there.exit_code, 0) << there.err;
        EXPECT_NE(there.out.find("triangles             " + std::to_string(here->report.triangles)), std::string::npos)
            << there.out;
        for (const std::string& note : here->report.notes) EXPECT_NE(there.out.find(note), std::string::npos) << note;
    }
}

/// True if a terminal would take a byte of `text` for a command.
bool commands(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if ((c < 0x20 && c != '\n' && c != '\t') || c == 0x7f) return true;
        if (c == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0) return true;
    }
    return false;
}

TEST(HostileFiles, ControlCharactersOfAFileReachNoTerminal) {
    // Truth: invariant (no byte of the output is a control character), from every place that a file can put one.
    const TempFolder folder;
    const std::string escape = "\x1b]0;owned\x07\x1b[2J";
    const std::string name = "a" + escape + ".off";
    writeText(folder.path() / name, kOff);
    writeText(folder.path() / ("b" + escape + ".toml"), smallStudy());
    writeText(folder / "key.toml", "\"\\u001b[2J\" = 1\n" + smallStudy());
    writeText(folder / "value.toml", replaced(smallStudy(), "preset = \"sigma7\"", "preset = \"\\u001b[2J\\u009b\""));
    writeText(folder / "name.toml", smallStudy("\\u001b[2J"));
    writeText(folder / "raw.toml", escape + "\n");
    writeText(folder / "bad.off", "OFF\n4 4 0\n0 0 " + escape + "\n");
    writeText(folder / "bad.csv", "t_s,x_m," + escape + "\n1,2,3\n");
    writeText(folder / "scene.toml", replaced(kPart, "a.off", "b.off"));
    writeText(folder / "b.off", kOff);
    const std::vector<std::vector<std::string>> calls{
        {"mesh", name},
        {"mesh", escape},
        {"mesh", "bad.off"},
        {"check", "b" + escape + ".toml"},
        {"check", "key.toml"},
        {"check", "value.toml"},
        {"check", "name.toml"},
        {"check", "raw.toml"},
        {"explain", "value.toml"},
        {"simulate", "scene.toml", "--trajectory", "bad.csv", "--out", "t.csv"},
        {"participant", "list", escape},
        {escape},
        {"check", "--" + escape},
    };
    for (const auto& call : calls) {
        const Ended ended = runWithin(folder.path(), call);
        EXPECT_FALSE(commands(ended.out)) << call.back();
        EXPECT_FALSE(commands(ended.err)) << call.back();
        EXPECT_FALSE((ended.out + ended.err).empty());
    }
    const Ended mesh = runWithin(folder.path(), {"mesh", name});
    EXPECT_EQ(mesh.exit_code, 0);
    EXPECT_NE(mesh.out.find("\\x1b]0;owned\\x07"), std::string::npos) << mesh.out;
    EXPECT_NE(runWithin(folder.path(), {"check", "key.toml"}).err.find("no control characters"), std::string::npos);
}

}  // namespace
}  // namespace passung::test
