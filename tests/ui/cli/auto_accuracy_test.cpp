#include <gtest/gtest.h>

#include "study/store/read/store_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

std::string automaticStudy(const std::string& budget) {
    std::string text = smallStudy();
    const std::string fixed = "cell_mm = 1.0\nspacing_mm = 3.0\n";
    return text.replace(text.find(fixed), fixed.size(), "accuracy = \"auto\"\naccuracy_budget_us = " + budget + "\n");
}

std::vector<store::AccuracyRow> keptIn(const std::string& database) {
    auto reader = store::StoreReader::open(database);
    if (!reader) throw std::runtime_error(toString(reader.errors().front()));
    return *reader->accuracy();
}

TEST(AutoAccuracyStudy, PicksOnceKeepsTheCalibrationAndReplaysWithIt) {
    // Truth: invariant. Two hundred microseconds fit something on any machine: the fewest points take a few. What was
    // picked when the study first ran holds for the second participant, for replay, explain and export.
    const TempFolder folder;
    writeText(folder / "s.toml", automaticStudy("200"));
    const auto run = [&](std::vector<std::string> words) { return runProgram(folder.path(), words); };
    const Ended first = run({"run", "s.toml", "--db", "s.db"});
    ASSERT_EQ(first.exit_code, 0) << first.err;
    const auto rows = keptIn(folder / "s.db");
    ASSERT_GT(rows.size(), 3u);
    std::size_t picked = 0;
    for (const store::AccuracyRow& row : rows) {
        if (row.picked_for_us.empty()) continue;
        ++picked;
        EXPECT_EQ(row.picked_for_us, std::vector{200.0});
        EXPECT_LE(row.time_p99_us, 200.0);
        for (const store::AccuracyRow& other : rows)
            EXPECT_TRUE(other.time_p99_us > 200.0 || other.error_p99_um >= row.error_p99_um);
    }
    EXPECT_EQ(picked, 1u);

    const Ended second = run({"run", "s.toml", "--db", "s.db"});
    ASSERT_EQ(second.exit_code, 0) << second.err;
    const auto again = keptIn(folder / "s.db");
    ASSERT_EQ(again.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        EXPECT_EQ(again[i].time_median_us, rows[i].time_median_us) << "measured anew";

    const Ended replay = run({"replay", "s.db"});
    EXPECT_EQ(replay.exit_code, 0) << replay.out << replay.err;
    const Ended explain = run({"explain", "s.toml", "--db", "s.db"});
    EXPECT_EQ(explain.exit_code, 0) << explain.err;
    EXPECT_NE(explain.out.find("<- picked"), std::string::npos) << explain.out;
    const Ended exported = run({"export", "s.db", "--out", "e", "--no-samples"});
    ASSERT_EQ(exported.exit_code, 0) << exported.err;
    EXPECT_EQ(linesOf(readText(folder / "e/accuracy.csv")).size(), rows.size() + 1);
}

TEST(AutoAccuracyStudy, RefusesABudgetThatNothingFitsAndLeavesNothingBehind) {
    // Truth: invariant (no query takes a nanosecond; the line names where the budget stands; a corrected protocol of
    // the same version runs)
    const TempFolder folder;
    const std::string bad = automaticStudy("0.001");
    const auto run = [&](const std::string& text) {
        writeText(folder / "s.toml", text);
        return runProgram(folder.path(), {"run", "s.toml", "--db", "s.db"});
    };
    const auto before = linesOf(bad.substr(0, bad.find("0.001")));
    const std::string place =
        "s.toml:" + std::to_string(before.size()) + ":" + std::to_string(before.back().size() + 1) + ": error: ";
    const auto refused = [&] {
        const Ended ended = run(bad);
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_TRUE(ended.err.starts_with(place)) << ended.err << place;
        EXPECT_NE(ended.err.find("no setting fits on this machine"), std::string::npos) << ended.err;
        EXPECT_EQ(linesOf(ended.err).size(), 1u) << ended.err;
    };
    refused();
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        EXPECT_EQ(entry.path().filename().string().find("s.db"), std::string::npos) << entry.path();

    // In a database that is there, of another version of the study.
    std::string other = smallStudy();
    const std::string version = "version = \"";
    other.insert(other.find(version) + version.size(), "0.");
    ASSERT_EQ(run(other).exit_code, 0);
    refused();
    const Ended corrected = run(smallStudy());
    EXPECT_EQ(corrected.exit_code, 0) << corrected.err;
}

}  // namespace
}  // namespace passung::test
