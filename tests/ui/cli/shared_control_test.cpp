#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "study/store/read/store_reader.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/support/length.h"
#include "tests/ui/cli/program.h"

// Shared control as a study meets it: the shipped protocol, its data and its replay.

namespace passung::test {
namespace {

/// The shipped study with simulated people, in a folder beside the instruments that it names.
class SharedControl : public testing::Test {
protected:
    void SetUp() override {
        const std::string text = readText(PASSUNG_SOURCE_DIR "/protocols/shared_control/study.toml");
        std::filesystem::create_directories(folder_ / "study");
        writeText(folder_ / "study/study.toml", text);
        std::filesystem::copy(PASSUNG_SOURCE_DIR "/protocols/questionnaires", folder_ / "questionnaires");
        run_ = runProgram(folder_.path(),
                          {"run", "study/study.toml", "--simulated", atFullLength() ? "12" : "2", "--db", "study.db"});
    }

    TempFolder folder_;
    Ended run_;
};

TEST_F(SharedControl, WhoSeesNothingSucceedsWhereTheGuideLeads) {
    // Truth: the mark: with a share of 1 a simulated hand that sees nothing succeeds. What the guide adds is at most
    // its share of stiffness times lead, 5 N, and what was recorded of it is told in every tick of the trial; a share
    // of 0 has none.
    ASSERT_EQ(run_.exit_code, 0) << run_.err;
    auto reader = store::StoreReader::open(folder_ / "study.db");
    ASSERT_TRUE(reader);
    const auto attempts = reader->attempts();
    ASSERT_TRUE(attempts);
    struct Count {
        int success = 0, all = 0;
        double seconds = 0.0, most = 0.0;
    };
    std::map<std::string, Count> counts;
    for (const auto& attempt : *attempts) {
        Count& count = counts[attempt.condition];
        ++count.all;
        count.success += attempt.outcome == "success";
        const auto records = reader->records(attempt.attempt_id, 0);
        ASSERT_TRUE(records);
        count.seconds += 1e-3 * static_cast<double>(records->size());
        const double share = std::stod(attempt.condition);
        for (const TickRecord& record : *records) {
            const auto& guide = record.effect_wrench[static_cast<std::size_t>(WrenchEffect::Guidance)];
            const double force = std::hypot(guide[0], guide[1], guide[2]);
            count.most = std::max(count.most, force);
            ASSERT_LE(force, 5.0 * share * (1.0 + 1e-6));
            const bool guided = share > 0.0 && (record.status & kEngaged) != 0;
            ASSERT_EQ(record.effects, guided ? 8u : 0u);
            ASSERT_EQ((record.status & kAidedInAir) != 0, guided);
        }
    }
    for (const auto& [condition, count] : counts)
        std::printf("%-12s %d of %d, %.1f s each, guide at most %.2f N\n", condition.c_str(), count.success, count.all,
                    count.seconds / count.all, count.most);
    ASSERT_EQ(counts.size(), 5u);
    EXPECT_EQ(counts.at("1/unseen").success, counts.at("1/unseen").all);
    EXPECT_GT(counts.at("1/unseen").all, 5);
    EXPECT_GT(counts.at("1/unseen").most, 1.0);
}

TEST_F(SharedControl, ReplaysAndExportsWhatTheGuideAdded) {
    // Truth: invariants: every bit again from the inputs; columns only where the condition has them.
    ASSERT_EQ(run_.exit_code, 0) << run_.err;
    const Ended replayed = runProgram(folder_.path(), {"replay", "study.db"});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
    const Ended exported = runProgram(folder_.path(), {"export", "study.db", "--out", "out"});
    ASSERT_EQ(exported.exit_code, 0) << exported.err;
    // In the air the guide's force is no contact: the way to the hole takes a second at least.
    const fake::CsvFile trials = fake::readCsv(readText(folder_ / "out/trials.csv"));
    for (std::size_t row = 0; row < trials.rows.size(); ++row)
        EXPECT_LT(std::stod(trials.at(row, "contact_time_s")), std::stod(trials.at(row, "trial_time_s")) - 1.0) << row;
    const std::string codebook = readText(folder_ / "out/codebook.csv");
    EXPECT_NE(codebook.find("guidance_force_x_N"), std::string::npos);
    EXPECT_NE(codebook.find("only in files of conditions with effects.record"), std::string::npos);
}

}  // namespace
}  // namespace passung::test
