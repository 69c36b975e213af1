#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "study/store/read/store_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/typed_studies.h"

// Simulated observers judge what the two intervals of a pair rendered.

namespace passung::test {
namespace {

/// A study of pairs, 1000 replaced by `reference` [N/m] in every place; `more`: instead of its factor.
std::string study(const std::string& reference, const std::string& more, const std::string& block = "") {
    std::string text = pairStudy();
    const auto replace = [&](const std::string& what, const std::string& by) {
        const auto at = text.find(what);
        if (at == std::string::npos) throw std::runtime_error("the study does not say " + what);
        text.replace(at, what.size(), by);
    };
    const auto factor = text.find("[[factor]]");
    text.erase(factor, text.find("[task]") - factor);
    text.insert(factor, more);
    replace("stiffness_N_per_m = 1000", "stiffness_N_per_m = " + reference);
    if (!block.empty()) {
        text.erase(text.find("[[block]]"));
        text += block;
    }
    return text;
}

std::vector<store::AttemptRow> run(const TempFolder& folder, const std::string& text, const std::string& people) {
    writeText(folder.path() / "study.toml", text);
    const Ended ended = runProgram(folder.path(), {"run", "study.toml", "--simulated", people, "--db", "s.db"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const auto reader = store::StoreReader::open(folder / "s.db");
    EXPECT_TRUE(reader);
    auto attempts = reader->attempts();
    return attempts ? *attempts : std::vector<store::AttemptRow>{};
}

/// Where "the comparison is stiffer" is said in half of the trials, on the logarithm: the mean of the distribution
/// whose shares below the levels are those that were counted (Spearman-Kaerber).
double equalityPoint(const std::string& reference) {
    const TempFolder folder;
    const std::vector<double> levels{500, 650, 850, 1100, 1400};
    const auto attempts = run(folder, study(reference, R"([[factor]]
name = "comparison"
unit = "N/m"
key = "task.comparison.contact.stiffness_N_per_m"
levels = [500, 650, 850, 1100, 1400]

)"),
                              "6");
    std::map<double, std::pair<double, double>> said;  // level: how often stiffer, of
    for (const store::AttemptRow& attempt : attempts) {
        const double level = std::stod(attempt.levels.front().second);
        said[level].first += attempt.measures.at("answer") == attempt.measures.at("comparison_interval") ? 1.0 : 0.0;
        said[level].second += 1.0;
    }
    const auto x = [&](std::size_t i) { return std::log(levels[i]); };
    const double step = (x(levels.size() - 1) - x(0)) / static_cast<double>(levels.size() - 1);
    double mean = 0.0, share_below = 0.0, x_below = x(0) - step;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const double share = said[levels[i]].first / said[levels[i]].second;
        std::printf("reference %s, comparison %.0f: stiffer in %.2f\n", reference.c_str(), levels[i], share);
        mean += (share - share_below) * 0.5 * (x_below + x(i));
        share_below = share;
        x_below = x(i);
    }
    mean += (1.0 - share_below) * (x_below + 0.5 * step);
    std::printf("reference %s: equal at %.0f\n", reference.c_str(), std::exp(mean));
    return std::exp(mean);
}

TEST(Reference, TheObserversPointOfEqualityIsTheReference) {
    // Truth: closed form: the two intervals feel alike where they are alike; steps of 30 %, so within one of them.
    const double low = equalityPoint("700"), high = equalityPoint("1050");
    EXPECT_GT(low, 700 / 1.25);
    EXPECT_LT(low, 700 * 1.25);
    EXPECT_GT(high, 1050 / 1.25);
    EXPECT_LT(high, 1050 * 1.25);
    EXPECT_GT(high / low, 1.2);
}

/// Mean level of the last trials of one staircase over the same levels, against this reference.
double threshold(const std::string& reference) {
    const TempFolder folder;
    run(folder, study(reference, "", R"([[block]]
name = "main"
order = "listed"

[[staircase]]
name = "stiffness"
block = "main"
key = "task.comparison.contact.stiffness_N_per_m"
unit = "N/m"
low = 1020
high = 1640
count = 16
logarithmic = true
rule = "1_up_2_down"
step_down = 0.04
max_trials = 20
tracks = [{ name = "down", start = 1500 }]
measure = "correct"
above = 0.5
)"),
        "3");
    const auto reader = store::StoreReader::open(folder / "s.db");
    const auto steps = reader->staircaseSteps();
    EXPECT_TRUE(steps);
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < steps->size(); ++i) {
        if (i % 20 < 12) continue;
        sum += (*steps)[i].level;
        count += 1.0;
    }
    std::printf("reference %s: %.0f\n", reference.c_str(), sum / count);
    return sum / count;
}

TEST(Reference, AnotherReferenceMovesTheThresholdOverTheSameLevels) {
    // Truth: closed form: 2 down 1 up ends where 0.707 are right: 0.545 · sqrt 2 · 0.12 of the logarithm above the
    // reference, 10 %; against 500 N/m every level is plainly stiffer, so that the track goes to the lowest.
    const double near = threshold("1000"), far = threshold("500");
    EXPECT_LT(far, 1070);
    EXPECT_LT(near, 1400);
    EXPECT_GT(near, far * 1.03);
}

}  // namespace
}  // namespace passung::test
