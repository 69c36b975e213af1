#include "study/run/files/disk_store.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <iterator>
#include <map>
#include <string>

#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

TEST(DiskStore, GivesBackWhatItKept) {
    // Truth: invariant. Bytes of every value; written over; nothing else is left in the folder, which is made.
    const TempFolder folder;
    run::DiskStore store(folder.path() / "new" / "folder");
    EXPECT_FALSE(store.load("a.build"));
    std::string bytes;
    for (int i = 0; i < 70000; ++i) bytes.push_back(static_cast<char>(i));
    store.keep("a.build", "short");
    store.keep("a.build", bytes);
    EXPECT_EQ(store.load("a.build"), bytes);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "new" / "folder"))
        files += entry.is_regular_file() ? 1 : 0;
    EXPECT_EQ(files, 1u);
}

TEST(DiskStore, KeepsNothingWhereItCannotWrite) {
    // Truth: invariant. Its folder is a file; the name is that of a folder.
    const TempFolder folder;
    writeText(folder / "file", "");
    run::DiskStore nowhere(folder / "file");
    nowhere.keep("a.build", "x");
    EXPECT_FALSE(nowhere.load("a.build"));
    std::filesystem::create_directory(folder / "a.build");
    run::DiskStore store(folder.path());
    store.keep("a.build", "x");
    EXPECT_FALSE(store.load("a.build"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

TEST(DiskStore, QueriesGiveTheSameAnswersFromAnEmptyAFullAndASpoiledCache) {
    // Truth: invariant. The first run fills the folder, the second reads it, before the third one every file is cut in
    // half; all write the same bytes but for the time that a query took, as does a run without a cache.
    const TempFolder folder;
    writeText(folder / "a.off", "OFF\n4 4 0\n0 0 0\n20 0 0\n0 20 0\n0 0 20\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    writeText(folder / "p.csv", "x_m,y_m,z_m,qw,qx,qy,qz\n0.004,0.003,0.002,1,0,0,0\n0.019,0,0,1,0,0,0\n");
    const auto answers = [&](const char* no_cache) {
        setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
        setenv("PASSUNG_NO_CACHE", no_cache, 1);
        const Ended ended = runProgram(
            folder.path(), {"query", "a.off", "a.off", "--poses", "p.csv", "--out", "r.csv", "--spacing-mm", "2"});
        setenv("PASSUNG_NO_CACHE", "1", 1);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        std::string text;
        for (const std::string& line : linesOf(readText(folder / "r.csv")))
            text += line.substr(0, line.rfind(',')) + "\n";
        std::filesystem::remove(folder / "r.csv");
        return text;
    };
    const auto cache = folder.path() / "passung";
    const std::string without = answers("1");
    EXPECT_FALSE(std::filesystem::exists(cache));
    EXPECT_EQ(answers(""), without);
    ASSERT_TRUE(std::filesystem::exists(cache));
    std::map<std::string, std::string> kept;
    for (const auto& entry : std::filesystem::directory_iterator(cache)) kept[entry.path()] = readText(entry.path());
    EXPECT_GE(kept.size(), 2u);
    EXPECT_EQ(answers(""), without);
    for (const auto& [path, bytes] : kept) writeText(path, bytes.substr(0, bytes.size() / 2));
    EXPECT_EQ(answers(""), without);
    for (const auto& [path, bytes] : kept) EXPECT_EQ(readText(path), bytes);
}

}  // namespace
}  // namespace passung::test
