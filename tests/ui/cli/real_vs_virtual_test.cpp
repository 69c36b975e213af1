#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/analysis/export/csv_reader.h"
#include "tests/ui/cli/program.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;

/// The shipped study at a size that takes a second: coarse parts, a wide and shallow hole near the start, one pass.
class RealVsVirtual : public testing::Test {
protected:
    RealVsVirtual() {
        const fs::path shipped = fs::path(PASSUNG_SOURCE_DIR) / "protocols";
        fs::copy(shipped / "questionnaires", folder_.path() / "questionnaires");
        fs::copy(shipped / "real_vs_virtual", folder_.path() / "study", fs::copy_options::recursive);
        std::string text = readText(study());
        const std::map<std::string, std::string> smaller = {
            {"height = 30, bore_diameter = 21.0, bore_depth = 25, chamfer = 0.5",
             "height = 12, bore_diameter = 22.0, bore_depth = 10, chamfer = 1"},
            {"length = 50, chamfer = 0.5", "length = 20, chamfer = 1"},
            {"position = [20, 0, 30]", "position = [4, 0, 8]"},
            {"insertion_depth_mm = 20", "insertion_depth_mm = 6\nleave_radius_mm = 2"},
            {"success_fraction = 0.95", "success_fraction = 0.9"},
            {"max_speed_mm_per_s = 5", "max_speed_mm_per_s = 20"},
            {"hold_s = 0.5", "hold_s = 0.05"},
            {"hold_ms = 200", "hold_ms = 20"},
            {"position_tolerance_mm = 3", "position_tolerance_mm = 5"},
            {"angle_tolerance_deg = 5", "angle_tolerance_deg = 10"},
            {"repetitions = 2", "repetitions = 1"},
        };
        for (const auto& [from, to] : smaller) {
            std::size_t at = text.find(from);
            EXPECT_NE(at, std::string::npos) << from;
            for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
        }
        writeText(study(), text);
    }

    fs::path study() const { return folder_.path() / "study/study.toml"; }
    Ended run(const std::vector<std::string>& arguments) const { return runProgram(folder_.path(), arguments); }
    Ended runStudy() const { return run({"run", "study/study.toml", "--simulated", "1", "--db", "s.db"}); }
    fake::CsvFile table(const std::string& name) const {
        return fake::readCsv(readText(folder_.path() / "out" / name));
    }

    TempFolder folder_;
};

TEST_F(RealVsVirtual, RunsToItsDataAndReplaysBitForBit) {
    // Truth: closed form: 6 environments in practice and three blocks, and the secondary task alone once: 25 trials.
    const Ended ended = runStudy();
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const Ended exported = run({"export", "s.db", "--out", "out"});
    ASSERT_EQ(exported.exit_code, 0) << exported.err;
    const auto trials = table("trials.csv");
    ASSERT_EQ(trials.rows.size(), 25u);
    std::map<std::string, std::set<std::string>> given;  // by environment
    double most_force = 0.0, most_withheld = 0.0, touches = 0.0;
    for (std::size_t row = 0; row < trials.rows.size(); ++row) {
        const std::string environment = trials.at(row, "environment");
        given[environment].insert(trials.at(row, "feedback_given"));
        EXPECT_EQ(trials.at(row, "kind"), "simulated");
        EXPECT_EQ(trials.at(row, "valid"), "1");
        const bool watched = environment != "real" && environment != "alone";
        EXPECT_EQ(trials.at(row, "timed_by"), watched ? "program" : environment == "real" ? "experimenter" : "clock");
        EXPECT_NE(trials.at(row, "trial_time_s"), "NA");
        EXPECT_EQ(trials.at(row, "path_length_m") == "NA", !watched) << "nothing was in the device";
        const bool force = environment.starts_with("kinesthetic");
        if (watched) {
            double& most = force ? most_force : most_withheld;
            most = std::max(most, std::stod(trials.at(row, "peak_force_N")));
            if (!force) touches += std::stod(trials.at(row, "contact_onsets"));
        }
        EXPECT_EQ(trials.at(row, "secondary_stimuli") == "NA", trials.at(row, "block") != "secondary_task");
    }
    EXPECT_GT(most_force, 0.1);
    EXPECT_EQ(most_withheld, 0.0);
    EXPECT_GT(touches, 0.0) << "contact is recorded all the same";
    // Given is what was delivered: at least once somewhere, and nothing that the condition does not have; the noise in
    // every trial that has it.
    const std::map<std::string, std::set<std::string>> had = {{"real", {}},
                                                              {"none", {}},
                                                              {"visual", {"visual"}},
                                                              {"vibrotactile", {"vibrotactile"}},
                                                              {"kinesthetic", {"kinesthetic"}},
                                                              {"kinesthetic_visual", {"kinesthetic", "visual"}},
                                                              {"alone", {}}};
    for (const auto& [environment, feedback] : had) {
        std::set<std::string> seen;
        for (const std::string& text : given[environment])
            for (std::size_t at = 0, plus = 0; plus != std::string::npos; at = plus + 1) {
                plus = text.find('+', at);
                seen.insert(text.substr(at, plus - at));
            }
        EXPECT_EQ(seen.erase("masking_noise"), environment == "alone" ? 0u : 1u) << environment;
        seen.erase("none");
        EXPECT_EQ(seen, feedback) << environment;
    }
    const Ended replayed = run({"replay", "s.db"});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.out;
    EXPECT_NE(replayed.out.find("25 attempts replayed, 0 differ"), std::string::npos) << replayed.out;
}

TEST_F(RealVsVirtual, TheSecondaryTaskAndTheExperimentersClockAreInTheExport) {
    // Truth: closed form: stimuli 1.5 to 2.5 s apart, presses from 100 to 1500 ms: 20 s alone hold 8 to 13 of them; two
    // commands a trial with real parts, of which there are 4.
    ASSERT_EQ(runStudy().exit_code, 0);
    ASSERT_EQ(run({"export", "s.db", "--out", "out"}).exit_code, 0);
    const auto secondary = table("secondary.csv");
    int alone = 0, hits = 0;
    for (std::size_t row = 0; row < secondary.rows.size(); ++row) {
        EXPECT_EQ(secondary.at(row, "block"), "secondary_task");
        EXPECT_EQ(secondary.at(row, "stimulus"), "audio");
        const bool hit = secondary.at(row, "result") == "hit";
        EXPECT_EQ(secondary.at(row, "response_time_s") != "NA", hit);
        if (secondary.at(row, "onset_s") == "NA") continue;
        if (secondary.at(row, "condition") == "alone@secondary_task") ++alone;
        if (!hit) continue;
        ++hits;
        EXPECT_GE(std::stod(secondary.at(row, "response_time_s")), 0.1);
        EXPECT_LE(std::stod(secondary.at(row, "response_time_s")), 1.5);
    }
    EXPECT_GE(alone, 8);
    EXPECT_LE(alone, 13);
    EXPECT_GT(hits, 5);

    const auto events = table("events.csv");
    std::map<std::string, int> said;
    std::vector<std::string> pages;
    for (std::size_t row = 0; row < events.rows.size(); ++row) {
        if (events.at(row, "event").starts_with("command_")) {
            EXPECT_EQ(events.at(row, "source"), "simulated") << "nobody was there";
            ++said[events.at(row, "event")];
        }
        if (events.at(row, "event") != "instruction") continue;
        EXPECT_EQ(events.at(row, "source"), "simulated") << "nobody read it";
        pages.push_back(events.at(row, "payload_json"));
    }
    EXPECT_EQ(said["command_start"], 4);
    EXPECT_EQ(said["command_done"] + said["command_failed"], 4);
    ASSERT_EQ(pages.size(), 5u);
    EXPECT_NE(pages.front().find("pictures/task.png"), std::string::npos);
    EXPECT_NE(pages.back().find("thanks"), std::string::npos);
}

TEST_F(RealVsVirtual, AnotherPictureNeedsAnotherVersionOfTheStudy) {
    // Truth: invariant: people who read two pages must not mix under one protocol.
    const fs::path picture = folder_.path() / "study/pictures/task.png";
    const std::string bytes = readText(picture);
    writeText(picture, "GIF89a");
    const Ended wrong = run({"check", "study/study.toml"});
    EXPECT_EQ(wrong.exit_code, 1);
    EXPECT_NE(wrong.err.find("error: instruction.picture: \"pictures/task.png\": must be a PNG or JPEG picture"),
              std::string::npos)
        << wrong.err;
    writeText(picture, bytes);
    ASSERT_EQ(runStudy().exit_code, 0);
    writeText(picture, bytes + "more");
    const Ended refused = runStudy();
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("the picture pictures/task.png has changed"), std::string::npos) << refused.err;
    EXPECT_EQ(run({"replay", "s.db", "--attempt", "1"}).exit_code, 0) << "a replay needs no picture";
}

TEST_F(RealVsVirtual, CheckNamesEveryMissingTranslation) {
    // Truth: closed form: one text is taken from German.
    std::string text = readText(study());
    const std::string line = "thanks = \"Danke.";
    ASSERT_NE(text.find(line), std::string::npos);
    text.replace(text.find(line), 6, "danke");
    writeText(study(), text);
    const Ended ended = run({"check", "study/study.toml"});
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.err.find("error: text.de.thanks: the text is missing, which [text.en] has"), std::string::npos)
        << ended.err;
    EXPECT_NE(ended.err.find("error: text.en.danke: the text is missing, which [text.de] has"), std::string::npos)
        << ended.err;
}

}  // namespace
}  // namespace passung::test
