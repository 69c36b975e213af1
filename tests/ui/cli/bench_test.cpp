#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;

/// A copy of the program in a folder of its own: passung-bench is looked for beside the program that runs.
class CopiedProgram {
public:
    CopiedProgram() {
        fs::create_directory(folder_);
        fs::copy_file(PASSUNG_PROGRAM, folder_ / "passung");
    }

    /// Something that says how it was called and ends with `exit_code`.
    void putBench(const std::string& place, int exit_code) {
        fs::create_directories(folder_ / place);
        const fs::path file = folder_ / place / "passung-bench";
        writeText(file, "#!/bin/sh\nprintf '<%s>' \"$@\"\nexit " + std::to_string(exit_code) + "\n");
        fs::permissions(file, fs::perms::owner_all);
    }

    Ended run(const std::string& arguments) {
        const std::string line = "cd '" + folder_.string() + "' && ./passung " + arguments + " >.out 2>.err";
        const int status = std::system(line.c_str());
        return {WEXITSTATUS(status), readText(folder_ / ".out"), readText(folder_ / ".err")};
    }

private:
    TempFolder parent_;
    const fs::path folder_ = parent_.path() / "own";
};

TEST(Bench, WithoutTheSeparateProgramSaysInOneLineHowToBuildIt) {
    // Truth: invariant
    CopiedProgram program;
    const Ended ended = program.run("bench --out b.csv");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
    EXPECT_NE(ended.err.find("./dev build"), std::string::npos) << ended.err;
}

TEST(Bench, PassesItsOptionsOnAndEndsWithTheOtherProgramsExitCode) {
    // Truth: invariant
    for (const char* place : {".", "../release"}) {
        CopiedProgram program;
        program.putBench(place, 7);
        const Ended ended = program.run("bench --filter 'bore 10 mm' --check --out b.csv");
        EXPECT_EQ(ended.exit_code, 7) << place;
        EXPECT_EQ(ended.out, "<--out><b.csv><--filter><bore 10 mm><--check>") << place;
    }
}

}  // namespace
}  // namespace passung::test
