#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "study/protocol/protocol_reader.h"
#include "study/store/store_reader.h"
#include "tests/ui/cli/program.h"
#include "ui/app/known_names.h"
#include "ui/app/simulated_perception.h"

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
    replace("interval_s = 3\n", "interval_s = 0.4\n");
    replace("max_trials = 60\n", "max_trials = 20\n");
    replace("spacing_mm = 2\n", "spacing_mm = 4\n");
    return text;
}

TEST(AccuracyThreshold, RunsFromItsFileToTheThresholdsOfThePeople) {
    // Truth: closed form: the threshold with which each simulated person answers, within three posterior deviations.
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
    const auto plan =
        protocol::readProtocol((folder.path() / "study.toml").string(), app::presetDevices(), app::knownMeasures());
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    const auto reader = store::StoreReader::open(folder / "s.db");
    ASSERT_TRUE(reader);
    std::map<std::string, store::StaircaseStepRow> last;
    const auto attempts = reader->attempts();
    const auto steps = reader->staircaseSteps();
    ASSERT_TRUE(attempts && steps);
    for (const store::AttemptRow& attempt : *attempts)
        for (const store::StaircaseStepRow& step : *steps)
            if (step.attempt_id == attempt.attempt_id && step.track) last[attempt.participant_id] = step;
    ASSERT_EQ(last.size(), 2u);
    for (const auto& [code, step] : last) {
        const double truth = app::SimulatedPerception(*plan, code).of(0).threshold;
        ASSERT_TRUE(step.estimate && step.estimate_sd);
        EXPECT_LT(std::abs(std::log10(*step.estimate) - truth), 3.0 * *step.estimate_sd) << code;
        EXPECT_LT(*step.estimate_sd, 0.4) << "before the first trial it is 0.52 decades";
    }
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/thresholds.csv"));
}

}  // namespace
}  // namespace passung::test
