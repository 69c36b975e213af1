#include "analysis/power/power_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analysis/power/power_summary.h"
#include "analysis/stats/paired_t.h"

namespace passung::power {
namespace {

PowerJob job(int repeats) {
    PowerJob job;
    job.program = "0.1.0";
    job.study = "small 1.0";
    job.plan_sha256 = "0123";
    job.seed = 18446744073709551615u;
    job.simulation = "model";
    job.participants = 12;
    job.repeats = repeats;
    job.measure = "completion_time_s";
    job.effect = "method:b=c=+0.5";
    job.against = "a";
    job.test = "paired_t";
    job.alpha = 0.05;
    return job;
}

PowerResult result(int repeats, const Shard& shard = {}) {
    PowerResult all{job(repeats), shard, {}};
    for (std::int64_t run = 0; run < repeats; ++run) {
        if (!shard.has(run)) continue;
        const auto r = static_cast<double>(run);
        all.tests.push_back({run, {12, 0.1 + r / 3.0, 0.7, 1.0 / (r + 1.0), run % 4 == 0 ? 0.01 : 0.5}});
    }
    return all;
}

template <class T>
T require(Result<T> value) {
    if (!value) throw std::runtime_error(toString(value.errors().front()));
    return *std::move(value);
}

std::string errorOf(const std::string& text) {
    const auto read = readPowerText(text, "p.csv");
    return read ? std::string("accepted") : toString(read.errors().front());
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    return text.replace(text.find(what), what.size(), by);
}

TEST(PowerFile, ReadsBackWhatItWrote) {
    // Truth: invariant, byte for byte; missing numbers too
    PowerResult written = result(5, {2, 3});
    written.tests[0].test.sd = written.tests[0].test.p = std::numeric_limits<double>::quiet_NaN();
    const std::string text = powerText(written);
    const PowerResult read = require(readPowerText(text, "p.csv"));
    EXPECT_EQ(read.job, written.job);
    EXPECT_EQ(read.shard, written.shard);
    EXPECT_EQ(read.tests.size(), 2u);
    EXPECT_EQ(read.tests[1].test.mean, written.tests[1].test.mean);
    EXPECT_TRUE(std::isnan(read.tests[0].test.p));
    EXPECT_EQ(powerText(read), text);
}

TEST(PowerFile, SaysWhereAFileIsWrong) {
    // Truth: invariant; each planted fault with its line
    const std::string text = powerText(result(3));
    EXPECT_EQ(errorOf("nonsense"), "p.csv:1:1: error: nonsense: must be \"# passung power, format 3\"");
    EXPECT_EQ(errorOf(replaced(text, "# seed = 1", "# seed = x1")),
              "p.csv:5:1: error: seed: x18446744073709551615: must be a number of its kind");
    EXPECT_EQ(errorOf(replaced(text, "# repeats", "# repeat")),
              "p.csv:8:1: error: repeats: # repeat = 3: must stand here");
    EXPECT_EQ(errorOf(replaced(text, "shard = 1/1", "shard = 2/1")),
              "p.csv:15:1: error: shard: 2/1: must be i/n with 1 ≤ i ≤ n");
    EXPECT_NE(errorOf(replaced(text, "\n1,12", "\n2,12")).find("p.csv:18:1: error: run:"), std::string::npos);
    EXPECT_NE(errorOf(text.substr(0, text.size() - 8)).find("p.csv:19:1: error: run:"), std::string::npos) << "torn";
    EXPECT_NE(errorOf(text + "3,12,1,1,1,1\n").find("p.csv:20:1: error:"), std::string::npos);
}

TEST(PowerFile, ShardsMergeToTheUnshardedBytesInAnyOrder) {
    // Truth: invariant, byte for byte
    for (const int of : {1, 2, 3, 7}) {
        std::vector<PowerResult> shards;
        std::vector<std::string> files;
        for (int i = of; i >= 1; --i) {
            shards.push_back(require(readPowerText(powerText(result(10, {i, of})), "s")));
            files.push_back("s" + std::to_string(i));
        }
        EXPECT_EQ(powerText(require(merge(shards, files))), powerText(result(10))) << of;
    }
}

TEST(PowerFile, MergeRefusesAMissingADoubleAndAForeignShard) {
    // Truth: invariant
    const auto errorOfMerge = [](const std::vector<PowerResult>& shards, const std::vector<std::string>& files) {
        const auto whole = merge(shards, files);
        return whole ? std::string("accepted") : toString(whole.errors().front());
    };
    const PowerResult one = result(10, {1, 3}), two = result(10, {2, 3}), three = result(10, {3, 3});
    EXPECT_EQ(errorOfMerge({one, three}, {"a", "c"}), "error: --merge: shard 2 of 3 is missing");
    EXPECT_EQ(errorOfMerge({one, two, two}, {"a", "b", "c"}), "c: error: is shard 2 again, after b");
    PowerResult foreign = three;
    foreign.job.effect = "method:d=+0.5";
    EXPECT_EQ(errorOfMerge({one, two, foreign}, {"a", "b", "c"}), "c: error: is a shard of another job than a");
    EXPECT_EQ(errorOfMerge({one, two, result(10, {3, 4})}, {"a", "b", "c"}),
              "c: error: is a shard of another job than a");
}

TEST(PowerSummary, CountsAndEstimates) {
    // Truth: closed form. Of 8 studies 2 are significant; their means are 0.1, 0.1 + 1/3 …, every sd 0.7.
    PowerResult some = result(8);
    some.tests[5].test = {1, 0.3, std::nan(""), std::nan(""), std::nan("")};
    const PowerSummary summary = summarise(some);
    EXPECT_EQ(summary.studies, 8u);
    EXPECT_EQ(summary.significant, 2u);
    EXPECT_EQ(summary.untested, 1u);
    EXPECT_DOUBLE_EQ(summary.power, 0.25);
    EXPECT_TRUE(summary.power_interval.holds(0.25));
    EXPECT_NEAR(summary.difference, 0.1 + 23.0 / 21.0, 1e-12);  // runs 0 … 7 without 5: sum 23
    EXPECT_NEAR(summary.sd, 0.7, 1e-12);
    // half-width 0.4448 = t(11, 0.975) 0.7 / sqrt(12); 0.5 lies in the intervals of 0.1 + 1/3 and 0.1 and 0.1 + 2/3
    ASSERT_TRUE(summary.coverage);
    EXPECT_NEAR(*summary.coverage, 3.0 / 7.0, 1e-12);
    EXPECT_NEAR(summary.closed_form, stats::pairedPower(summary.difference / 0.7, 12, 0.05), 1e-12);
    some.job.simulation = "haptic";
    EXPECT_FALSE(summarise(some).coverage);
    EXPECT_NE(summaryText(some).find("2 of 8"), std::string::npos);
    some.job.test = "welch_t";
    some.tests[0].test.sd = std::nan("");
    EXPECT_EQ(summarise(some).untested, 1u) << "between groups nobody has a difference";
    EXPECT_EQ(summaryText(some).find("closed form"), std::string::npos);
}

}  // namespace
}  // namespace passung::power
