#include "study/protocol/view_reader.h"

#include <gtest/gtest.h>

#include "study/protocol/protocol_reader.h"
#include "tests/study/protocol/fake_devices.h"

namespace passung::protocol {
namespace {

const std::string kStudy = R"(passung = 1
study = { name = "demo", version = "2", seed = 42, participants = 4 }
[scene]
device = { preset = "arm" }
part = [
  { name = "plate", shape = { kind = "box", width = 60, depth = 60, height = 30 } },
  { name = "peg", held = true, shape = { kind = "peg", diameter = 20, length = 50 }, pose = { position = [0, 0, 50] } },
]
[task]
type = "contour_following"
target = "plate"
points = [[0, 0, 15], [10, 0, 15]]
[[block]]
name = "main"
order = "listed"
)";

Result<plan::StudyPlan> read(const std::string& text) {
    static const auto devices = fakeDevices();
    return readProtocolText(text, "p.toml", devices, std::vector<std::string>{"completion_time_s"});
}

std::string errorOf(const std::string& view) {
    const auto plan = read(kStudy + "[view]\n" + view + "\n");
    return plan ? "" : toString(plan.errors().front());
}

TEST(ViewReader, TakesEveryKeyInSiUnits) {
    // Truth: closed form: each key written out, with the unit in its name.
    const auto plan = read(kStudy + R"([view]
theme = "light"
text_percent = 150
camera_from = [0, -2, 1]
camera_target_mm = [10, 20, 30]
camera_distance_mm = 400
camera_angle_deg = 45
light_from = [0, 0, 1]
light_percent = 80
fill_light_percent = 10
ambient_light_percent = 20
shadow_percent = 0
ground = false
max_picture_age_ms = 250
min_pictures_per_s = 20
)");
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    const plan::View& view = plan->view;
    EXPECT_EQ(view.theme, plan::Theme::Light);
    EXPECT_DOUBLE_EQ(view.text_scale, 1.5);
    EXPECT_EQ(view.camera_from, Vec3(0, -2, 1));
    EXPECT_NEAR((*view.camera_target - Vec3(0.01, 0.02, 0.03)).norm(), 0.0, 1e-15);
    EXPECT_DOUBLE_EQ(*view.camera_distance, 0.4);
    EXPECT_DOUBLE_EQ(view.camera_opening, 0.25 * 3.14159265358979323846);
    EXPECT_EQ(*view.light_from, Vec3(0, 0, 1));
    EXPECT_DOUBLE_EQ(view.light, 0.8);
    EXPECT_DOUBLE_EQ(view.fill_light, 0.1);
    EXPECT_DOUBLE_EQ(view.ambient_light, 0.2);
    EXPECT_EQ(view.shadow, 0.0);
    EXPECT_FALSE(view.ground);
    EXPECT_DOUBLE_EQ(view.max_picture_age, 0.25);
    EXPECT_DOUBLE_EQ(view.min_pictures_per_s, 20.0);
}

TEST(ViewReader, AnEmptyTableIsTheSameAsNone) {
    // Truth: invariant: the defaults of the key table are those of the value.
    const auto none = read(kStudy), empty = read(kStudy + "[view]\n");
    ASSERT_TRUE(none && empty);
    EXPECT_EQ(plan::viewJson(empty->view), plan::viewJson(plan::View{}));
    EXPECT_EQ(none->expanded_json, empty->expanded_json);
}

TEST(ViewReader, EveryKeyIsStoredWithThePlan) {
    // Truth: invariant: plans that differ in one key of [view] differ in what is stored of them.
    const auto plain = read(kStudy);
    ASSERT_TRUE(plain);
    for (const char* line :
         {"theme = \"light\"", "text_percent = 101", "camera_from = [1, 0, 0]", "camera_target_mm = [0, 0, 0]",
          "camera_distance_mm = 9", "camera_angle_deg = 31", "light_from = [0, 0, 1]", "light_percent = 99",
          "fill_light_percent = 31", "ambient_light_percent = 35", "shadow_percent = 54", "ground = false",
          "max_picture_age_ms = 499", "min_pictures_per_s = 9"}) {
        const auto other = read(kStudy + "[view]\n" + line + "\n");
        ASSERT_TRUE(other) << line << ": " << toString(other.errors().front());
        EXPECT_NE(other->expanded_json, plain->expanded_json) << line;
    }
}

TEST(ViewReader, RefusesWhatCannotBeDrawn) {
    // Truth: closed form: line and column of each value in the file above.
    EXPECT_EQ(errorOf("theme = \"grey\""), "p.toml:17:9: error: view.theme: \"grey\": must be \"dark\" or \"light\"");
    EXPECT_EQ(errorOf("camera_from = [0, 0, 0]"),
              "p.toml:17:15: error: view.camera_from: [0, 0, 0]: must point somewhere: not all three numbers may be 0");
    EXPECT_EQ(errorOf("shadow_percent = 101"), "p.toml:17:18: error: view.shadow_percent: 101: must be from 0 to 100");
    EXPECT_EQ(errorOf("camera_distance_mm = 0"), "p.toml:17:22: error: view.camera_distance_mm: 0: must be > 0");
    EXPECT_NE(errorOf("camera_angle = 3").find("camera_angle_deg"), std::string::npos);
}

}  // namespace
}  // namespace passung::protocol
