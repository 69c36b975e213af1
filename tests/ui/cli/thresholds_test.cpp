#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "study/person/simulated_person.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/support/length.h"
#include "tests/ui/cli/program.h"

// The shipped study of thresholds with one person and 12 trials of each quantity; PASSUNG_LONG=1: as it is, with four.

namespace passung::test {
namespace {

std::string reduced() {
    std::string text = readText(PASSUNG_SOURCE_DIR "/protocols/thresholds/study.toml");
    const std::string trials = "max_trials = 40\n";
    int staircases = 0;
    for (auto at = text.find(trials); at != std::string::npos; at = text.find(trials, at + 1), ++staircases)
        text.replace(at, trials.size(), atFullLength() ? trials : "max_trials = 12\n");
    if (staircases != 5) throw std::runtime_error("the study has not five staircases of 40 trials");
    return text;
}

TEST(Thresholds, TheErrorOfEachPersonComesOutOfEveryQuantitysIntervals) {
    // Truth: closed form: who compares two impressions that err by feeling_error each has that sigma, whatever the
    // quantity; it is a trait of the person, drawn from study, code and seed. What a hand adds by its tremor and by
    // starts a little apart is small beside it. 95 % of the intervals have it: of 20, 15 or more but once in 400 runs
    // (binomial), of those that a few trials give all but two.
    const TempFolder folder;
    const std::string people = atFullLength() ? "4" : "1";
    writeText(folder.path() / "study.toml", reduced());
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"check", "study.toml"},
                                               {"run", "study.toml", "--simulated", people, "--db", "s.db"},
                                               {"export", "s.db", "--out", "out", "--no-samples"},
                                               {"verify", "s.db"}}) {
        const Ended ended = runProgram(folder.path(), arguments);
        ASSERT_EQ(ended.exit_code, 0) << arguments[0] << ": " << ended.out << ended.err;
    }
    const auto thresholds = fake::readCsv(readText(folder.path() / "out/thresholds.csv"));
    ASSERT_EQ(thresholds.rows.size(), atFullLength() ? 20u : 5u);
    const std::map<std::string, std::string> references{
        {"force", "1000"}, {"stiffness", "800"}, {"viscosity", "10"}, {"inertia", "0.2"}, {"position", "15"}};
    int covered = 0, missed = 0;
    for (std::size_t row = 0; row < thresholds.rows.size(); ++row) {
        const std::string code = thresholds.at(row, "participant_id"), quantity = thresholds.at(row, "staircase");
        const double truth = person::personOf("thresholds", code, 20261128).feeling_error;
        const auto bound = [&](const char* name, double otherwise) {
            const std::string& cell = thresholds.at(row, name);
            return cell == "NA" ? otherwise : std::stod(cell);
        };
        const bool any = thresholds.at(row, "sigma") != "NA";
        const bool has = any && bound("sigma_low", 0.0) <= truth && truth <= bound("sigma_high", 1e9);
        covered += has ? 1 : 0;
        missed += any && !has ? 1 : 0;
        std::printf("%s %-9s sigma %.3f: %s [%s, %s]%s\n", code.c_str(), quantity.c_str(), truth,
                    thresholds.at(row, "sigma").c_str(), thresholds.at(row, "sigma_low").c_str(),
                    thresholds.at(row, "sigma_high").c_str(), has ? "" : "  not in it");
        EXPECT_EQ(thresholds.at(row, "n_trials"), atFullLength() ? "40" : "12");
        EXPECT_EQ(thresholds.at(row, "reference"), references.at(quantity));
    }
    EXPECT_LE(missed, atFullLength() ? 5 : 2);
    EXPECT_GE(covered, atFullLength() ? 15 : 1);
}

}  // namespace
}  // namespace passung::test
