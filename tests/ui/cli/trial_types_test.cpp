#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/base/tick_record.h"
#include "study/session/rendered_scenes.h"
#include "study/store/read/store_reader.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/typed_studies.h"

namespace passung::test {
namespace {

/// A study that ran with one simulated participant, and what became of it.
class TypedStudy {
public:
    TypedStudy(const std::string& name, const std::string& text) : name_(name) {
        writeText(folder_ / "study.toml", text);
        run_ = program({"run", "study.toml", "--simulated", "1", "--db", "study.db"});
        auto reader = store::StoreReader::open(folder_ / "study.db");
        if (!reader) return;
        if (auto attempts = reader->attempts()) attempts_ = *attempts;
        for (const auto& attempt : attempts_)
            if (auto records = reader->records(attempt.attempt_id)) records_[attempt.attempt_id] = *records;
    }

    Ended program(std::vector<std::string> arguments) const { return runProgram(folder_.path(), arguments); }
    const Ended& run() const { return run_; }
    const std::vector<store::AttemptRow>& attempts() const { return attempts_; }
    const std::vector<TickRecord>& records(const store::AttemptRow& attempt) const {
        return records_.at(attempt.attempt_id);
    }

    /// Every bit of every attempt and every measure again; the tables have the type's columns.
    void expectReplayAndExport(const std::vector<std::string>& columns) const {
        EXPECT_EQ(run_.exit_code, 0) << run_.err;
        ASSERT_EQ(attempts_.size(), 4u) << name_;
        const Ended replay = program({"replay", "study.db"});
        EXPECT_EQ(replay.exit_code, 0) << replay.out << replay.err;
        const Ended exported = program({"export", "study.db", "--out", "tables", "--no-samples"});
        ASSERT_EQ(exported.exit_code, 0) << exported.err;
        const std::string trials = readText(folder_ / "tables/trials.csv");
        const std::string head = "," + trials.substr(0, trials.find('\n')) + ",";
        const std::string codebook = readText(folder_ / "tables/codebook.csv");
        for (const std::string& column : columns) {
            EXPECT_NE(head.find("," + column + ","), std::string::npos) << column << " in " << head;
            EXPECT_NE(codebook.find(column), std::string::npos) << column;
        }
        EXPECT_EQ(head.find(",search_time_s,"), std::string::npos) << "a column of another type";
    }

private:
    TempFolder folder_;
    std::string name_;
    Ended run_;
    std::vector<store::AttemptRow> attempts_;
    std::map<std::int64_t, std::vector<TickRecord>> records_;
};

TEST(TrialTypes, APairIsFeltTwiceAnsweredAndScored) {
    // Truth: invariant of the rows, and closed form: the slope of force over way in an interval is the stiffness that
    // was rendered in it (a coupling of 1000 N/m for the standard), so the records tell which interval had which.
    const TypedStudy study("pairs", pairStudy());
    study.expectReplayAndExport({"comparison_interval", "answer", "correct", "response_time_s"});
    std::set<double> intervals;
    for (const store::AttemptRow& attempt : study.attempts()) {
        SCOPED_TRACE("trial " + std::to_string(attempt.trial_index + 1) + ", " + attempt.condition);
        ASSERT_EQ(attempt.outcome, "success");
        EXPECT_TRUE(attempt.valid) << attempt.invalid_reason.value_or("");
        const double comparison = attempt.measures.at("comparison_interval");
        EXPECT_EQ(comparison, session::comparisonInterval(attempt.seed));
        intervals.insert(comparison);
        EXPECT_EQ(attempt.measures.at("correct"), attempt.measures.at("answer") == comparison ? 1.0 : 0.0);
        EXPECT_GT(attempt.measures.at("response_time_s"), 0.1);
        // Force against the depth at the hand's pose in the two engaged stretches.
        std::array<double, 2> slope{};
        std::size_t interval = 0;
        bool before = false;
        std::array<double, 5> sums{};
        const auto close = [&] {
            slope.at(interval++) = (sums[0] * sums[4] - sums[1] * sums[2]) / (sums[0] * sums[3] - sums[1] * sums[1]);
            sums = {};
        };
        for (const TickRecord& record : study.records(attempt)) {
            const bool now = (record.status & kEngaged) != 0;
            if (before && !now) close();
            before = now;
            if (!now || record.force_N[2] < 0.5f || (record.status & (kRateLimited | kForceLimited)) != 0) continue;
            const double depth = static_cast<double>(record.proxy_position_m[2] - record.hand_position_m[2]);
            const double force = record.force_N[2];
            sums[0] += 1;
            sums[1] += depth;
            sums[2] += force;
            sums[3] += depth * depth;
            sums[4] += depth * force;
        }
        ASSERT_EQ(interval, 2u);
        const double level = std::stod(attempt.condition);
        const auto c = static_cast<std::size_t>(comparison) - 1;
        EXPECT_NEAR(slope[c], level, 0.2 * level);
        EXPECT_NEAR(slope[1 - c], 1000.0, 200.0);
    }
    EXPECT_EQ(intervals.size(), 2u) << "four pairs of this seed have the comparison in either interval";
}

TEST(TrialTypes, APersonTellsAStiffWallFromASoftOne) {
    // Truth: closed form: a factor of four is many times the error of feeling (0.15 of the logarithm, twice):
    // ln 4 / (0.15 √2) = 6.5 standard deviations; the stiffer one is named every time.
    std::string text = pairStudy();
    const std::string levels = "levels = [330, 1500]";
    text.replace(text.find(levels), levels.size(), "levels = [250, 4000]");
    const TypedStudy study("pairs", text);
    ASSERT_EQ(study.attempts().size(), 4u) << study.run().err;
    for (const store::AttemptRow& attempt : study.attempts())
        EXPECT_EQ(attempt.measures.at("correct"), attempt.condition == "4000" ? 1.0 : 0.0) << attempt.condition;
}

TEST(TrialTypes, ABallGoesThroughAPassage) {
    // Truth: invariant of the rows; the last record of the trial lies below the passage.
    const TypedStudy study("passage", passageStudy());
    study.expectReplayAndExport(
        {"passage_time_s", "passage_path_m", "passage_contact_time_s", "passage_peak_force_N", "passage_entries"});
    for (const store::AttemptRow& attempt : study.attempts()) {
        ASSERT_EQ(attempt.outcome, "success");
        EXPECT_GT(attempt.measures.at("passage_path_m"), 0.0139);
        EXPECT_GE(attempt.measures.at("passage_entries"), 1.0);
        EXPECT_LE(attempt.measures.at("passage_contact_time_s"), attempt.measures.at("passage_time_s") + 1e-9);
        const auto end = static_cast<std::size_t>((*attempt.end_ns - attempt.start_ns) / kTickNanoseconds);
        EXPECT_LT(study.records(attempt).at(end).proxy_position_m[2], -0.014f);
        EXPECT_GE(study.records(attempt).at(end - 1).proxy_position_m[2], -0.014f);
    }
}

TEST(TrialTypes, ALineIsFollowedWithTheAskedForce) {
    // Truth: invariant: the asked force comes out to within half of it, and more is pressed where more is asked.
    const TypedStudy study("contour", contourStudy());
    study.expectReplayAndExport({"contour_progress", "contour_deviation_m", "contour_max_deviation_m",
                                 "contour_force_N", "contour_force_error_N"});
    for (const store::AttemptRow& attempt : study.attempts()) {
        ASSERT_EQ(attempt.outcome, "success");
        EXPECT_GE(attempt.measures.at("contour_progress"), 0.95);
        EXPECT_LT(attempt.measures.at("contour_deviation_m"), 0.006);
        const double asked = std::stod(attempt.condition);
        EXPECT_NEAR(attempt.measures.at("contour_force_N"), asked, 0.5 * asked) << attempt.condition;
    }
}

TEST(TrialTypes, APartIsPutDownAndConfirmed) {
    // Truth: invariant: the outcome is what the stored errors and the tolerances say.
    const TypedStudy study("placement", placementStudy());
    study.expectReplayAndExport({"position_error_m", "angle_error_rad"});
    for (const store::AttemptRow& attempt : study.attempts()) {
        const double position = attempt.measures.at("position_error_m"), angle = attempt.measures.at("angle_error_rad");
        const double tolerance = 1e-3 * std::stod(attempt.condition);
        const bool there = position <= tolerance && angle <= 5.0 * M_PI / 180.0;
        EXPECT_EQ(attempt.outcome, there ? "success" : "failure") << attempt.condition << " " << position;
        EXPECT_LT(position, 0.004);
        EXPECT_LT(angle, 0.15);
    }
}

}  // namespace
}  // namespace passung::test
