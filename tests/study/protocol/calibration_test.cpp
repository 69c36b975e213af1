#include "study/protocol/calibration.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/study/protocol/fake_devices.h"

namespace passung::protocol {
namespace {

std::string fileWith(const std::string& text) {
    const auto path = std::filesystem::path(testing::TempDir()) / "passung_arm.calibration.toml";
    std::ofstream(path) << text;
    return path.string();
}

Calibration calibration() {
    return {.device = "arm",
            .stable_stiffness = 700.0 + 1.0 / 3.0,
            .rotational_stiffness = 5.0,
            .calm_stiffness = 1000.5,
            .calm_rotational_stiffness = 7.0,
            .damping = 5.0,
            .rotational_damping = 0.002};
}

TEST(Calibration, ReadsWhatItWrites) {
    // Truth: invariant, to the bit.
    const auto written = calibration();
    const auto read = readCalibration(fileWith(calibrationText(written)));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->device, written.device);
    EXPECT_EQ(read->stable_stiffness, written.stable_stiffness);
    EXPECT_EQ(read->rotational_stiffness, written.rotational_stiffness);
    EXPECT_EQ(read->calm_stiffness, written.calm_stiffness);
    EXPECT_EQ(read->calm_rotational_stiffness, written.calm_rotational_stiffness);
    EXPECT_EQ(read->damping, written.damping);
    EXPECT_EQ(read->rotational_damping, written.rotational_damping);
}

TEST(Calibration, ReplacesTheMaximaAndSaysSo) {
    // Truth: closed form; a device that does not actuate torque keeps having none.
    const auto devices = fakeDevices();
    const auto arm = calibrated(devices[0], calibration(), "c.toml");
    ASSERT_TRUE(arm);
    EXPECT_EQ(arm->stable_stiffness_N_per_m, calibration().stable_stiffness);
    EXPECT_EQ(arm->stable_rotational_stiffness_Nm_per_rad, 5.0);
    EXPECT_EQ(arm->stability_source,
              "calibration on this machine: translation: 700.3 N/m, found calm up to 1000; rotation: 5 N·m/rad, found "
              "calm up to 7");
    auto of_stick = calibration();
    of_stick.device = "stick";
    const auto stick = calibrated(devices[1], of_stick, "c.toml");
    ASSERT_TRUE(stick);
    EXPECT_EQ(stick->stable_rotational_stiffness_Nm_per_rad, 0.0);
}

TEST(Calibration, IsRefusedForAnotherDeviceOrAnotherDamping) {
    // Truth: closed form: file, key and value of what does not fit.
    const auto arm = fakeDevices()[0];
    auto other = calibration();
    other.device = "leg";
    auto refused = calibrated(arm, other, "c.toml");
    ASSERT_FALSE(refused);
    EXPECT_EQ(toString(refused.errors()[0]),
              "c.toml: error: device: \"leg\": must be arm, whose calibration the file is by its name");
    other = calibration();
    other.damping = 4.0;
    other.rotational_damping = 0.1;
    refused = calibrated(arm, other, "c.toml");
    ASSERT_FALSE(refused);
    ASSERT_EQ(refused.errors().size(), 2u);
    EXPECT_EQ(
        toString(refused.errors()[0]),
        "c.toml: error: damping_Ns_per_m: 4: must be what arm recommends now, 5: find its stiffness anew, or remove "
        "the file");
}

TEST(Calibration, CollectsWhatIsWrongWithAFile) {
    // Truth: closed form: line and column.
    auto wrong = calibration();
    wrong.stable_stiffness = 2000.0;
    wrong.rotational_damping = -1.0;
    const std::string path = fileWith(calibrationText(wrong));
    const auto read = readCalibration(path);
    ASSERT_FALSE(read);
    ASSERT_EQ(read.errors().size(), 2u);
    EXPECT_EQ(
        toString(read.errors()[0]),
        path + ":3:28: error: stable_stiffness_N_per_m: 2000: must not exceed what the device was calm at: 1000.5");
    EXPECT_EQ(toString(read.errors()[1]), path + ":8:34: error: rotational_damping_Nms_per_rad: -1: must be ≥ 0");
}

}  // namespace
}  // namespace passung::protocol
