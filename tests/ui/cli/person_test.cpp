// What sets simulated participants apart reaches the data, and the data can still be computed again.
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "study/store/read/store_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

/// Kruskal and Wallis' H without correction for ties, of groups of equal size.
double rankedVariance(std::map<std::string, std::vector<double>> groups) {
    std::vector<double> all;
    for (const auto& [name, values] : groups) all.insert(all.end(), values.begin(), values.end());
    const auto n = static_cast<double>(all.size());
    double sum = 0.0;
    for (const auto& [name, values] : groups) {
        double ranks = 0.0;
        for (const double value : values)
            for (const double other : all) ranks += other < value ? 1.0 : other == value ? 0.5 : 0.0;
        ranks += 0.5 * static_cast<double>(values.size());
        sum += ranks * ranks / static_cast<double>(values.size());
    }
    return 12.0 / (n * (n + 1.0)) * sum - 3.0 * (n + 1.0);
}

TEST(Person, PeopleDifferMoreThanTheirTrialsDoAndReplayHolds) {
    // Truth: closed form: H of twelve equal people is near chi-square with 11 degrees of freedom, above 24.7 once in
    // 100 studies; ranks, because a lapse makes a trial long. Replay: invariant.
    const TempFolder folder;
    writeText(folder / "fair.toml", fairStudy());
    const Ended run = runProgram(folder.path(), {"run", "fair.toml", "--simulated", "12", "--db", "s.db"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto reader = store::StoreReader::open(folder / "s.db");
    ASSERT_TRUE(reader);
    const auto attempts = reader->attempts();
    ASSERT_TRUE(attempts);
    std::map<std::string, std::vector<double>> times;
    for (const auto& attempt : *attempts)
        if (const auto time = attempt.measures.find("completion_time_s"); time != attempt.measures.end())
            times[attempt.participant_id].push_back(time->second);
    ASSERT_EQ(times.size(), 12u);
    for (const auto& [code, values] : times) ASSERT_EQ(values.size(), 6u) << code;
    std::printf("H = %.1f\n", rankedVariance(times));
    EXPECT_GT(rankedVariance(times), 24.7);

    const Ended replay = runProgram(folder.path(), {"replay", "s.db"});
    EXPECT_EQ(replay.exit_code, 0) << replay.out << replay.err;
}

}  // namespace
}  // namespace passung::test
