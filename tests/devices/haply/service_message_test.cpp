#include "devices/haply/service_message.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/random.h"

namespace passung::haply {
namespace {

using json = nlohmann::json;

const char* const kInventory = R"({"session_id":1,"inverse3":[{"device_id":"049D","config":{"type":"inverse3",
"extended_firmware_version":"7.4.0","basis":{"permutation":"XYZ"},"filters":{"force_gate":{"gain":0.3},
"damping":{"scalar":0.5}}},"state":{"cursor_position":{"x":0.01,"y":-0.12,"z":0.15},"cursor_velocity":{"x":0,"y":0,
"z":-0.5},"body_orientation":{"w":1,"x":0,"y":0,"z":0}},"status":{"calibrated":true}}],
"verse_grip":[{"device_id":"G","state":{"orientation":{"w":0,"x":0,"y":0,"z":1},"buttons":{"a":true,"b":false,"c":true}}}]})";

TEST(ServiceMessage, ReadsADeviceItsFiltersAndItsGrip) {
    // Truth: the service's public pages (3.5, realtime/websocket-protocol), typed in by hand.
    const auto devices = readMessage(kInventory);
    ASSERT_TRUE(devices);
    ASSERT_EQ(devices->size(), 1u);
    const SaidOfDevice& said = devices->front();
    EXPECT_EQ(said.id, "049D");
    EXPECT_EQ(said.position, Vec3(0.01, -0.12, 0.15));
    EXPECT_EQ(said.velocity, Vec3(0, 0, -0.5));
    EXPECT_EQ(said.body->w(), 1.0);
    EXPECT_EQ(said.grip->z(), 1.0);
    EXPECT_EQ(said.buttons, 5u);
    EXPECT_EQ(said.firmware, "7.4.0");
    EXPECT_EQ(said.basis, "XYZ");
    EXPECT_EQ(said.filters.gate_gain, 0.3);
    EXPECT_EQ(said.filters.damping, 0.5);
    EXPECT_EQ(said.calibrated, true);
}

TEST(ServiceMessage, WhatIsNoMessageOrNoNumberIsNotThere) {
    // Truth: invariant; independent program (nlohmann-json 3.11.2) for what is JSON at all.
    for (const char* text : {"", "NaN", "[]", "7", "{", R"({"inverse3":7})", R"({"inverse3":[{"x":NaN}]})",
                             R"({"inverse3":[{"x":1e999}]})"})
        EXPECT_FALSE(readMessage(text)) << text;
    for (const char* p : {"null", "7", R"({"x":1,"y":2})", R"({"x":1,"y":"2","z":3})", R"({"x":1,"y":null,"z":3})"}) {
        const auto devices =
            readMessage(R"({"inverse3":[{"device_id":"A","state":{"cursor_position":)" + std::string(p) + "}}]}");
        ASSERT_TRUE(devices) << p;
        EXPECT_FALSE(devices->front().position) << p;
    }
    const std::string whole = kInventory;
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(readMessage(std::string_view(whole).substr(0, length))) << length;
}

TEST(ServiceMessage, CommandsAForceUnderItsDocumentedKeyAndOpensTheGateOnce) {
    // Truth: the service's public pages (3.5, realtime/control-commands): `vector`, not `values` as in 3.1.
    const json message = json::parse(forceMessage("04\"D", Vec3(1.5, -2.25, 1e-17), false));
    const json& device = message["inverse3"][0];
    EXPECT_EQ(device["device_id"], "04\"D");
    EXPECT_EQ(device["commands"]["set_cursor_force"]["vector"], (json{{"x", 1.5}, {"y", -2.25}, {"z", 1e-17}}));
    EXPECT_FALSE(device.contains("configure"));
    const json opening = json::parse(forceMessage("A", Vec3::Zero(), true));
    EXPECT_EQ(opening["inverse3"][0]["configure"]["force_gate"]["gain"], 1.0);
    EXPECT_EQ(opening["inverse3"][0]["configure"]["damping"]["scalar"], 0.0);
}

TEST(ServiceMessage, AThousandPosesReturnThroughTextAndFrameToTheirLastPlace) {
    // Truth: invariant: texts hold 64-bit numbers whole; the frame moves the origin, which rounds at 1 part in 1e16.
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));
        const Vec3 cursor = toCursor(p);
        const json text = {
            {"inverse3",
             {{{"device_id", "A"},
               {"state", {{"cursor_position", {{"x", cursor.x()}, {"y", cursor.y()}, {"z", cursor.z()}}}}}}}}};
        const auto devices = readMessage(text.dump());
        ASSERT_TRUE(devices);
        EXPECT_LE((toBase(*devices->front().position) - p).cwiseAbs().maxCoeff(), 1e-15);
    }
}

TEST(ServiceMessage, AnEventHarmsTheDeviceThatItIsAbout) {
    // Truth: the service's public pages (3.5, events).
    const auto event = [](const char* name, const char* id) {
        return json{{"name", name}, {"data", {{"device_id", id}, {"safety_type", "ebrake_triggered"}}}}.dump();
    };
    EXPECT_NE(harmOf(event("device-disconnected", "A"), "A"), "");
    EXPECT_NE(harmOf(event("device-safety-triggered", "A"), "A").find("ebrake_triggered"), std::string::npos);
    EXPECT_EQ(harmOf(event("device-disconnected", "B"), "A"), "");
    EXPECT_EQ(harmOf(event("device-connected", "A"), "A"), "");
    EXPECT_EQ(harmOf("no json", "A"), "");
}

}  // namespace
}  // namespace passung::haply
