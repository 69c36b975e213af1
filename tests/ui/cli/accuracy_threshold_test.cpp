#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "study/store/read/store_reader.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"

// The shipped study, at a size for every day: shorter intervals, fewer trials, two people.

namespace passung::test {
namespace {

std::string reduced() {
    std::string text = readText(PASSUNG_SOURCE_DIR "/protocols/accuracy_threshold/study.toml");
    const auto replace = [&](const std::string& what, const std::string& by) {
        const auto at = text.find(what);
        if (at == std::string::npos) throw std::runtime_error("the study does not say " + what);
        text.replace(at, what.size(), by);
    };
    replace("interval_s = 3\n", "interval_s = 2\n");
    replace("max_trials = 60\n", "max_trials = 30\n");
    return text;
}

TEST(AccuracyThreshold, RunsFromItsFileToThresholdsThatFollowFromWhatWasRendered) {
    // Truth: invariant: whoever judges what is rendered is mostly right where the contact is far coarser than the
    // reference; so the estimates lie inside the levels.
    const TempFolder folder;
    writeText(folder.path() / "study.toml", reduced());
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"check", "study.toml"},
                                               {"run", "study.toml", "--simulated", "2", "--db", "s.db"},
                                               {"export", "s.db", "--out", "out", "--no-samples"},
                                               {"replay", "s.db"}}) {
        const Ended ended = runProgram(folder.path(), arguments);
        ASSERT_EQ(ended.exit_code, 0) << arguments[0] << ": " << ended.out << ended.err;
    }
    const auto reader = store::StoreReader::open(folder / "s.db");
    ASSERT_TRUE(reader);
    const auto attempts = reader->attempts();
    const auto steps = reader->staircaseSteps();
    ASSERT_TRUE(attempts && steps);
    std::map<std::string, store::StaircaseStepRow> last;
    int coarse = 0, right = 0;
    for (const store::AttemptRow& attempt : *attempts)
        for (const store::StaircaseStepRow& step : *steps) {
            if (step.attempt_id != attempt.attempt_id || !step.positive) continue;
            if (step.track) last[attempt.participant_id] = step;
            if (step.level < 120.0) continue;
            ++coarse;
            right += *step.positive ? 1 : 0;
        }
    std::printf("%d of %d right from 120 um on\n", right, coarse);
    EXPECT_GT(right, 3 * coarse / 4);
    ASSERT_EQ(last.size(), 2u);
    for (const auto& [code, step] : last) {
        ASSERT_TRUE(step.estimate && step.estimate_sd);
        std::printf("%s: %.0f um\n", code.c_str(), *step.estimate);
        EXPECT_GT(*step.estimate, 30.0);
        EXPECT_LT(*step.estimate, 240.0);
    }
    // Truth: closed form: on the levels' logarithmic axis, as the protocol plans it.
    const auto thresholds = fake::readCsv(readText(folder.path() / "out/thresholds.csv"));
    ASSERT_GE(thresholds.rows.size(), 2u);
    for (std::size_t row = 0; row < thresholds.rows.size(); ++row)
        EXPECT_NEAR(std::stod(thresholds.at(row, "log10_estimate")),
                    std::log10(std::stod(thresholds.at(row, "estimate"))), 1e-12);
    const auto analyses = fake::readCsv(readText(folder.path() / "out/analyses.csv"));
    ASSERT_EQ(analyses.rows.size(), 1u);
    EXPECT_EQ(analyses.at(0, "value_column"), "log10_estimate");
    EXPECT_EQ(analyses.at(0, "r_call"), "t.test(log10_estimate ~ 1, data = data)");
}

}  // namespace
}  // namespace passung::test
