#include "study/protocol/station/station_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "study/protocol/protocol_reader.h"
#include "tests/study/protocol/known_names.h"
#include "tests/support/temp_folder.h"
#include "tests/ui/cli/small_study.h"

namespace passung::protocol {
namespace {

Result<std::vector<DeviceChoice>> read(const std::string& text) {
    const test::TempFolder folder;
    const std::string path = (folder.path() / "station.toml").string();
    std::ofstream(path) << text;
    return readStationFile(path);
}

TEST(StationFile, SaysWhichUnitServesEachHand) {
    // Truth: the example of protocols/KEYS.md, by hand.
    const auto devices = read(R"([station.device.right]
kind = "sigma7"
backend = "dhd"
serial = "0815"
heartbeat_ms = 8
[station.device.left]
kind = "spacemouse"
backend = "spacenavd"
address = "/run/other.sock"
axes = "x -z y"
)");
    ASSERT_TRUE(devices);
    ASSERT_EQ(devices->size(), 2u);
    const DeviceChoice& right = devices->front();
    EXPECT_EQ(right.hand + right.kind + right.backend + right.serial + right.address, "rightsigma7dhd0815");
    EXPECT_EQ(right.heartbeat_ms, 8);
    EXPECT_EQ(devices->back().heartbeat_ms, 5) << "where nothing is said";
    EXPECT_EQ(devices->back().hand, "left");
    EXPECT_EQ(devices->back().address, "/run/other.sock");
    EXPECT_EQ(devices->back().axes, "x -z y");
}

TEST(StationFile, IsReadAsItWasWritten) {
    // Truth: invariant.
    const std::vector<DeviceChoice> devices{{"right", "inverse3", "haply", "04\"D", {}, {}},
                                            {"left", "spacemouse", "spacenavd", {}, "/run/a b", "x y z", 7}};
    const auto again = read(stationFileText(devices));
    ASSERT_TRUE(again);
    ASSERT_EQ(again->size(), 2u);
    EXPECT_EQ(stationFileText(*again), stationFileText(devices));
    EXPECT_EQ(again->front().serial, "04\"D");
    EXPECT_EQ(again->back().heartbeat_ms, 7);
}

TEST(StationFile, TellsWhatIsWrongAndWhere) {
    // Truth: invariant: the line of each.
    const auto devices =
        read("[station.device.right]\nkind = \"sigma7\"\nbakend = \"dhd\"\n[station.device.Left]\nkind = 7\n");
    ASSERT_FALSE(devices);
    std::string all;
    for (const Error& error : devices.errors()) all += std::to_string(error.line) + " " + error.key + "\n";
    EXPECT_NE(all.find("3 station.device.right.bakend"), std::string::npos) << all;
    EXPECT_NE(all.find("4 station.device.Left"), std::string::npos) << all;
    EXPECT_FALSE(read("[stations]\n"));
    EXPECT_FALSE(read("[station.device.right]\nkind = \"sigma7\"\nbackend = \"dhd\"\nheartbeat_ms = 51\n"));
    EXPECT_FALSE(readStationFile("/nonexistent/station.toml"));
}

/// The small study on another device; its stiffness is a number.
Result<plan::StudyPlan> studyOn(const std::string& device) {
    std::string text = test::smallStudy();
    const std::string preset = "preset = \"sigma7\"\n";
    text.replace(text.find(preset), preset.size(), device);
    text.replace(text.find("cell_mm = 1.0"), 13, "cell_mm = 1.0\nstiffness_N_per_m = 500");
    return readProtocolText(text, "study.toml", knownDevices(), knownMeasures());
}

TEST(Kind, AnyDeviceIsAskedForNoMoreThanWhatItMustDo) {
    // Truth: invariant: the limits of the scene are the least force and torque, so that all units render the same.
    const auto plan = studyOn("kind = \"any\"\nleast_force_N = 3\nleast_degrees = 3\n");
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    const plan::Condition& condition = plan->conditions.front();
    EXPECT_EQ(condition.device, "any");
    ASSERT_TRUE(condition.needs);
    EXPECT_EQ(condition.needs->degrees, 3);
    EXPECT_EQ(condition.scene.limits.max_force, 3.0);
    EXPECT_FALSE(condition.scene.limits.actuates_torque);
    const auto turning = studyOn("kind = \"any\"\nleast_force_N = 3\nleast_torque_Nm = 0.1\n");
    ASSERT_TRUE(turning);
    EXPECT_EQ(turning->conditions.front().scene.limits.max_torque, 0.1);
    EXPECT_TRUE(turning->conditions.front().scene.limits.actuates_torque);
    EXPECT_NE(condition.params_json.find(R"("device_needs":{"force_N":3,"torque_Nm":0,"degrees":3})"),
              std::string::npos);
}

TEST(Kind, IsTheSameByItsEarlierName) {
    // Truth: invariant: everything that follows from it.
    const auto kind = studyOn("kind = \"hug\"\n"), preset = studyOn("preset = \"hug\"\n");
    ASSERT_TRUE(kind && preset);
    EXPECT_EQ(kind->conditions.front().params_json, preset->conditions.front().params_json);
}

TEST(Kind, RefusesWhatContradictsItself) {
    // Truth: invariant.
    const auto why = [](const std::string& device) {
        const auto plan = studyOn(device);
        return plan ? std::string("none") : toString(plan.errors().front());
    };
    EXPECT_NE(why("kind = \"any\"\n").find("least_force_N"), std::string::npos);
    EXPECT_NE(why("kind = \"sigma7\"\nleast_force_N = 3\n").find("only with kind"), std::string::npos);
    EXPECT_NE(why("kind = \"sigma7\"\npreset = \"sigma7\"\n").find("leave one of them out"), std::string::npos);
    EXPECT_NE(why("kind = \"any\"\nleast_force_N = 50\n").find("must not exceed"), std::string::npos);
    EXPECT_NE(why("kind = \"sigma\"\n").find("unknown device"), std::string::npos);
}

}  // namespace
}  // namespace passung::protocol
