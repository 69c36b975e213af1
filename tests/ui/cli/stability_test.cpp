#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

/// A study on a device whose maximum is a share of the border and not its maker's limit, so that a calibration shows.
std::string study(const std::string& contact_key) {
    std::string text = smallStudy();
    text.replace(text.find("sigma7"), 6, "falcon");
    text.insert(text.find("cell_mm = 1.0"), contact_key + "\n");
    return text;
}

/// This user's calibrations are in the folder's own `data`.
class Stability : public testing::Test {
protected:
    Stability() { setenv("XDG_DATA_HOME", (folder / "data").c_str(), 1); }

    std::string calibrationFile() const { return folder / "data/passung/falcon.calibration.toml"; }
    void calibrate(double stable) const {
        std::filesystem::create_directories(folder / "data/passung");
        writeText(calibrationFile(), "device = \"falcon\"\nstable_stiffness_N_per_m = " + std::to_string(stable) +
                                         "\nstable_rotational_stiffness_Nm_per_rad = 0\ncalm_stiffness_N_per_m = 5000\n"
                                         "calm_rotational_stiffness_Nm_per_rad = 0\ndamping_Ns_per_m = 5\n"
                                         "rotational_damping_Nms_per_rad = 0\n");
    }
    Ended run(std::vector<std::string> arguments) const { return runProgram(folder.path(), arguments); }
    double keptStiffness() const {
        const auto reader = store::StoreReader::open(folder / "small.db");
        const auto attempt = reader->attempt(1);
        const std::string& json = attempt->params_json;
        const std::string key = "\"stiffness_N_per_m\":";
        return std::stod(json.substr(json.find(key) + key.size()));
    }

    TempFolder folder;
};

TEST_F(Stability, WhatTheDeviceBearsIsFoundKeptAndThenWhatMaxStandsFor) {
    // Truth: invariant. The procedure writes a file that the reader takes; its maximum is 0.7 of what was calm, and
    // explain resolves "max" against it and says so.
    const Ended found = run({"doctor", "--device", "falcon", "--find-stiffness"});
    ASSERT_EQ(found.exit_code, 0) << found.err;
    const std::string text = readText(calibrationFile());
    const auto numberOf = [&](const std::string& key) {
        return std::stod(text.substr(text.find(key + " = ") + key.size() + 3));
    };
    const double stable = numberOf("stable_stiffness_N_per_m");
    EXPECT_NEAR(stable, 0.7 * numberOf("calm_stiffness_N_per_m"), 1e-6 * stable);
    EXPECT_NE(found.out.find("calibration on this machine"), std::string::npos);

    calibrate(2345.0);
    writeText(folder / "s.toml", study("stiffness_N_per_m = \"max\""));
    const Ended explained = run({"explain", "s.toml"});
    ASSERT_EQ(explained.exit_code, 0) << explained.err;
    EXPECT_NE(explained.out.find("falcon, 2345 N/m"), std::string::npos) << explained.out;
    EXPECT_NE(explained.out.find("calibration on this machine: translation: 2345 N/m"), std::string::npos);
    // 2345 of the exact border, 3587 N/m
    EXPECT_NE(explained.out.find(" 0.65 "), std::string::npos) << explained.out;
}

TEST_F(Stability, AStudyKeepsTheMaximumWithWhichItBeganAndReplaysWithIt) {
    // Truth: invariant. Calibrated 2000, then 1500, then none: all sessions have 2000 and every attempt replays.
    writeText(folder / "s.toml", study("stiffness_N_per_m = \"max\""));
    calibrate(2000.0);
    ASSERT_EQ(run({"run", "s.toml"}).exit_code, 0);
    EXPECT_EQ(keptStiffness(), 2000.0);
    calibrate(1500.0);
    const Ended again = run({"run", "s.toml"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.err.find("the study keeps the stable maximum of falcon with which it began, 2000 N/m"),
              std::string::npos)
        << again.err;
    std::filesystem::remove(calibrationFile());
    const Ended replayed = run({"replay", "small.db"});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
    const auto reader = store::StoreReader::open(folder / "small.db");
    const auto attempts = reader->attempts();
    ASSERT_TRUE(attempts);
    EXPECT_GT(attempts->size(), 10u);
    for (const auto& attempt : *attempts)
        EXPECT_NE(reader->attempt(attempt.attempt_id)->params_json.find("\"stiffness_N_per_m\":2000,"),
                  std::string::npos);
    const auto kept = reader->stableStiffness(attempts->front().protocol_sha256);
    ASSERT_TRUE(kept);
    ASSERT_EQ(kept->size(), 1u);
    EXPECT_EQ(kept->front().device, "falcon");
    EXPECT_NE(kept->front().origin.find("calibration"), std::string::npos);
    EXPECT_NE(run({"explain", "s.toml", "--db", "small.db"}).out.find("falcon, 2000 N/m"), std::string::npos);
}

TEST_F(Stability, AStiffnessBeyondItIsAnErrorUnlessTheProtocolTakesResponsibility) {
    // Truth: closed form: the line of the key; 6000 N/m is beyond the border of 3587 as well.
    writeText(folder / "s.toml", study("stiffness_N_per_m = 6000"));
    const Ended refused = run({"check", "s.toml"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(
        refused.err.find("error: scene.contact.stiffness_N_per_m: 6000: must not exceed the stable maximum of falcon"),
        std::string::npos)
        << refused.err;
    writeText(folder / "s.toml", study("allow_unstable = true\nstiffness_N_per_m = 6000"));
    const Ended allowed = run({"check", "s.toml"});
    EXPECT_EQ(allowed.exit_code, 0) << allowed.err;
    EXPECT_NE(allowed.err.find("warning: contact.allow_unstable"), std::string::npos) << allowed.err;
    EXPECT_NE(run({"explain", "s.toml"}).out.find("UNSTABLE by the model"), std::string::npos);
}

TEST_F(Stability, ACouplingBeyondTheBorderThroughItsToolIsAnErrorThoughARigidWallWouldBeStable) {
    // Truth: independent program (tests/core/loop/stability_test.cpp simulates such loops): the falcon's border is 3587
    // N/m at a rigid wall and 2152 N/m through a tool of 25 g against contacts of up to 3000 N/m; its maximum lies
    // between.
    const auto coupled = [](const std::string& keys) {
        std::string text = study("coupling = \"virtual\"\npenalty_stiffness_N_per_m = 3000\n" + keys);
        const std::string god_object = "\"god_object_heuristic\"";
        return text.replace(text.find(god_object), god_object.size(), "\"penalty\"");
    };
    writeText(folder / "s.toml", coupled("stiffness_N_per_m = \"max\""));
    const Ended refused = run({"check", "s.toml"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("contact.stiffness_N_per_m: 2511.04: must be below 2152 N/m, where falcon is no longer"),
              std::string::npos)
        << refused.err;
    EXPECT_EQ(run({"run", "s.toml"}).exit_code, 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "small.db"));
    writeText(folder / "s.toml", coupled("stiffness_N_per_m = 2045"));
    EXPECT_EQ(run({"check", "s.toml"}).exit_code, 0);
    EXPECT_NE(run({"explain", "s.toml"}).out.find(" 0.95 "), std::string::npos);
    writeText(folder / "s.toml", coupled("allow_unstable = true\nstiffness_N_per_m = 2500"));
    EXPECT_EQ(run({"check", "s.toml"}).exit_code, 0);
    EXPECT_NE(run({"explain", "s.toml"}).out.find("UNSTABLE by the model"), std::string::npos);
}

TEST_F(Stability, ACalibrationThatIsNotSoundIsAnErrorWithItsPlace) {
    // Truth: closed form: line and column in the file.
    writeText(folder / "s.toml", study("stiffness_N_per_m = \"max\""));
    calibrate(6000.0);  // more than it was calm at
    const Ended wrong = run({"check", "s.toml"});
    EXPECT_EQ(wrong.exit_code, 1);
    EXPECT_NE(wrong.err.find("falcon.calibration.toml:2:28: error: stable_stiffness_N_per_m: 6000"), std::string::npos)
        << wrong.err;
    writeText(calibrationFile(), "device = \"falcon\"\n");
    EXPECT_NE(run({"check", "s.toml"}).err.find("calm_stiffness_N_per_m: required"), std::string::npos);
    EXPECT_EQ(run({"doctor", "--device", "falcon", "--find-stiffness"}).exit_code, 0) << "finds it anew";
    EXPECT_EQ(run({"check", "s.toml"}).exit_code, 0);
}

/// Two blocks of one condition each, the second on another device.
std::string twoDevices() {
    std::string text = smallStudy();
    const std::size_t factor = text.find("[[factor]]"), task = text.find("[task]");
    text.replace(factor, task - factor,
                 "[[factor]]\nname = \"robot\"\nkey = \"device.preset\"\nlevels = [\"sigma7\", "
                 "\"falcon\"]\n\n");
    text.replace(text.find("timeout_s = 20"), 14, "timeout_s = 0.3");
    text.replace(text.find("order = \"williams\"\nrepetitions = 3"), 34,
                 "order = \"listed\"\nblocked = \"robot\"\nblocked_order = \"listed\"\nrepetitions = 1");
    return text;
}

TEST_F(Stability, WhoSwapsDevicesIsToldWhatTheirCalibrationIsWorth) {
    // Truth: invariant: never calibrated; calibrated before the session; found to bear less than the study keeps.
    writeText(folder / "s.toml", twoDevices());
    const TempFolder console;
    const auto session = [&](const std::string& action) {
        return runProgram(console.path(), {"session", action, folder / "small.db"});
    };
    const auto toldAtSwap = [&] {
        Program program(folder.path(), {"run", "s.toml", "--db", "small.db", "--wait"});
        while (session("start").exit_code != 0) continue;
        while (program.out().find("put it in place") == std::string::npos) continue;
        EXPECT_EQ(session("continue").exit_code, 0);
        EXPECT_EQ(program.wait(), 0) << program.err();
        const std::string out = program.out(), begin = "the next trial is on falcon: put it in place";
        const std::size_t place = out.find(begin);
        return place == std::string::npos
                   ? out
                   : out.substr(place + begin.size(), out.find('\n', place) - place - begin.size());
    };
    EXPECT_EQ(toldAtSwap(),
              "; falcon has never been calibrated on this machine: `passung doctor --device falcon --find-stiffness` "
              "does it");
    calibrate(4000.0);
    EXPECT_EQ(toldAtSwap(),
              "; falcon has not been calibrated since this session began: `passung doctor --device falcon "
              "--find-stiffness` does it");
    calibrate(100.0);
    EXPECT_NE(toldAtSwap().find("falcon bears 100 N/m and 0 Nm/rad by its calibration, less than the"),
              std::string::npos);
}

TEST_F(Stability, InRealTimeTheCalibrationOfEveryDeviceInUseIsStored) {
    // Truth: invariant: an event whenever a device comes into use (a busy machine has trials repeated, so that one
    // comes back), with what the study keeps and when the file was written; none in virtual time, where no clock
    // reaches the data.
    writeText(folder / "s.toml", twoDevices());
    calibrate(2000.0);
    const std::string payloads =
        "SELECT group_concat(payload_json->>'device' || ' ' || (payload_json->>'stable_stiffness_N_per_m' = 2000) || "
        "' ' || (payload_json->>'calibrated_utc' GLOB '20*Z'), ', ') FROM (SELECT payload_json FROM event WHERE "
        "event='device_calibration' GROUP BY payload_json ORDER BY min(event_id))";
    ASSERT_EQ(run({"run", "s.toml", "--db", "small.db", "--real-time"}).exit_code, 0);
    EXPECT_EQ(store::Database(folder / "small.db", store::OpenMode::ReadOnly).text(payloads), "sigma7 0 0, falcon 1 1");
    ASSERT_EQ(run({"run", "s.toml", "--db", "virtual.db"}).exit_code, 0);
    EXPECT_EQ(store::Database(folder / "virtual.db", store::OpenMode::ReadOnly).text(payloads), "");
}

}  // namespace
}  // namespace passung::test
