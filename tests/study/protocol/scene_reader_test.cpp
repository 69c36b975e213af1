#include "study/protocol/scene_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/shape/shape.h"
#include "tests/study/protocol/fake_devices.h"
#include "tests/support/off_file.h"
#include "tests/support/temp_folder.h"

namespace passung::protocol {
namespace {

const std::string kParts = R"(
[[part]]
name = "plate"
shape = { kind = "bore_plate", width = 60, depth = 50, height = 30, bore_diameter = 21, bore_depth = "through" }
shown_offset = [0, 0, 1]
[[part]]
name = "peg"
held = true
shape = { kind = "peg", diameter = 20, length = 50, chamfer = 1 }
pose = { position = [20, 0, 30], rotation_deg = [10, 20, 30] }
)";

Result<scene::SceneSpec> read(const std::string& text) {
    static const auto devices = fakeDevices();
    return readSceneText(text, "s.toml", devices);
}

/// All error lines, or "" if the scene is sound.
std::string errorsOf(const std::string& text) {
    const auto scene = read(text);
    std::string lines;
    if (scene) return lines;
    for (const auto& error : scene.errors()) {
        if (!lines.empty()) lines += '\n';
        lines += toString(error);
    }
    return lines;
}

TEST(SceneReader, ReadsLengthsInTheFilesUnit) {
    // Truth: closed form: millimetres to metres, by hand.
    const auto scene = read(kParts);
    ASSERT_TRUE(scene) << errorsOf(kParts);
    const auto& plate = std::get<shape::BorePlate>(std::get<shape::Shape>(scene->parts[0].geometry));
    EXPECT_EQ(plate.width, 0.060);
    EXPECT_EQ(plate.depth, 0.050);
    EXPECT_EQ(plate.bore_diameter, 0.021);
    EXPECT_EQ(plate.bore_depth, 0.030) << "a through bore is as deep as the plate";
    EXPECT_EQ(plate.chamfer, 0.0);
    const auto& peg = scene->parts[1];
    EXPECT_TRUE(peg.held);
    EXPECT_EQ(peg.X_WP.p, Vec3(0.020, 0.0, 0.030));
    EXPECT_EQ(scene->parts[0].shown_offset, Vec3(0, 0, 0.001));
}

TEST(SceneReader, ReadsEveryShape) {
    // Truth: closed form: millimetres to metres, every key another number.
    const auto shapeOf = [](const std::string& keys) {
        const auto scene = read("[[part]]\nname = \"a\"\nheld = true\nshape = { kind = " + keys + " }\n");
        return scene ? std::get<shape::Shape>(scene->parts[0].geometry) : shape::Shape(shape::Sphere{0.0});
    };
    const auto valuesOf = [&](const std::string& keys) {
        std::string text;
        const auto shape = shapeOf(keys);
        text += shape::kindName(shape);
        for (const auto& [key, value] : shape::namedDimensions(shape)) {
            text += ' ';
            text += key;
            text += ' ' + std::to_string(std::lround(1e3 * value));
        }
        return text;
    };
    EXPECT_EQ(valuesOf(R"("torus", tube_diameter = 12, diameter = 40)"), "torus diameter 40 tube_diameter 12");
    EXPECT_EQ(valuesOf(R"("square_peg", length = 50, width = 20, depth = 15, chamfer = 2)"),
              "square_peg width 20 depth 15 length 50 chamfer 2");
    EXPECT_EQ(valuesOf(R"("keyed_peg", diameter = 20, length = 50, key_height = 3, key_width = 6)"),
              "keyed_peg diameter 20 length 50 key_width 6 key_height 3 chamfer 0");
    EXPECT_EQ(valuesOf(R"("square_bore_plate", width = 60, depth = 50, height = 30, pocket_width = 21, )"
                       "pocket_depth = 16, bore_depth = 25, chamfer = 1"),
              "square_bore_plate width 60 depth 50 height 30 pocket_width 21 pocket_depth 16 bore_depth 25 chamfer 1");
    EXPECT_EQ(valuesOf(R"("keyed_bore_plate", width = 60, depth = 50, height = 30, bore_diameter = 21, )"
                       R"(key_width = 7, key_height = 4, bore_depth = "through")"),
              "keyed_bore_plate width 60 depth 50 height 30 bore_diameter 21 key_width 7 key_height 4 bore_depth 30 "
              "chamfer 0");
    EXPECT_EQ(
        valuesOf(R"("thread_bolt", length = 50, pitch = 2, nominal_diameter = 20)"),
        "thread_bolt nominal_diameter 20 pitch 2 length 50 chamfer 0 clearance 0 flank_angle_deg 1047 flank_height 0");
    EXPECT_EQ(valuesOf(R"("thread_nut", outer_diameter = 60, pitch = 8, nominal_diameter = 40, height = 16, )"
                       R"(chamfer = 2, flank_angle_deg = 60, clearance = 1)"),
              "thread_nut nominal_diameter 40 pitch 8 outer_diameter 60 height 16 chamfer 2 clearance 1 "
              "flank_angle_deg 1047 flank_height 0");
    const auto unbuilt =
        read(R"(part = [{ name = "a", held = true, shape = { kind = "thread_bolt", length = 50, pitch = 2, )"
             R"(nominal_diameter = 20, flank_angle_deg = 1 } }])");
    ASSERT_FALSE(unbuilt);
    EXPECT_EQ(unbuilt.errors().front().key, "part.a.shape.flank_angle_deg");
}

const std::string kPartStart = "[[part]]\nname = \"p\"\nheld = true\n";

/// A part of one shape, alone in a scene.
std::string partOf(const std::string& shape) { return kPartStart + "shape = { " + shape + " }\n"; }

TEST(SceneReader, MakesDiametersOfFits) {
    // Truth: closed form: 20 H7 is 20.000 to 20.021, 20 g6 19.980 to 19.993 mm. The shaft's part goes to a peg, the
    // hole's to a plate; the nominal diameter is in the file's unit.
    const auto diameterOf = [](const std::string& shape) {
        const auto scene = read(partOf(shape));
        EXPECT_TRUE(scene) << errorsOf(partOf(shape));
        if (!scene) return 0.0;
        for (const auto& [key, value] : shape::namedDimensions(std::get<shape::Shape>(scene->parts[0].geometry)))
            if (std::string(key).ends_with("diameter")) return value;
        return 0.0;
    };
    const std::string fit = R"(, fit = "H7/g6", nominal_diameter = 20)";
    const std::string plate = "width = 60, depth = 50, height = 30, bore_depth = 25";
    const std::string key = ", key_width = 6, key_height = 3";
    EXPECT_NEAR(diameterOf(R"(kind = "peg", length = 50)" + fit), 0.0199865, 1e-15);
    EXPECT_NEAR(diameterOf(R"(kind = "peg", length = 50, deviation = "min")" + fit), 0.019993, 1e-15);
    EXPECT_NEAR(diameterOf(R"(kind = "peg", length = 50, deviation = "max")" + fit), 0.01998, 1e-15);
    EXPECT_NEAR(diameterOf(R"(kind = "keyed_peg", length = 50)" + key + fit), 0.0199865, 1e-15);
    EXPECT_NEAR(diameterOf(R"(kind = "bore_plate", )" + plate + fit), 0.0200105, 1e-15);
    EXPECT_NEAR(diameterOf(R"(kind = "bore_plate", deviation = "min", )" + plate + fit), 0.02, 1e-15);
    EXPECT_NEAR(diameterOf(R"(kind = "keyed_bore_plate", deviation = "max", )" + plate + key + fit), 0.020021, 1e-15);
    const auto inches =
        read("unit = \"in\"\n" + partOf(R"(kind = "peg", length = 2, fit = "H8/h7", nominal_diameter = 1)"));
    ASSERT_TRUE(inches);
    EXPECT_NEAR(std::get<shape::Peg>(std::get<shape::Shape>(inches->parts[0].geometry)).diameter, 0.0254 - 10.5e-6,
                1e-15);
}

TEST(SceneReader, ReportsWhatIsWrongWithAFitWhereItIsWritten) {
    // Truth: closed form: one line per rule.
    const std::string peg = R"(kind = "peg", length = 50, )";
    const auto lines = [&](const std::string& keys) { return errorsOf(partOf(peg + keys)); };
    EXPECT_EQ(lines("chamfer = 0"), "s.toml:4:9: error: part.p.shape.diameter: required");
    EXPECT_EQ(lines(R"(fit = "H7/g6")"), "s.toml:4:9: error: part.p.shape.nominal_diameter: required by the fit");
    EXPECT_EQ(lines(R"(diameter = 20, fit = "H7/g6", nominal_diameter = 20)"),
              "s.toml:4:59: error: part.p.shape.fit: \"H7/g6\": gives the diameter, which stands here too");
    EXPECT_EQ(lines(R"(fit = "g6", nominal_diameter = 20)"),
              "s.toml:4:44: error: part.p.shape.fit: \"g6\": must be a hole's and a shaft's tolerance class, such as "
              "\"H7/g6\"");
    EXPECT_EQ(
        lines(R"(fit = "H7/g6", nominal_diameter = 501)"),
        "s.toml:4:72: error: part.p.shape.nominal_diameter: 501: must be above 0 and at most 500 mm for an ISO 286 "
        "fit");
    EXPECT_EQ(lines(R"(diameter = 20, deviation = "min")"),
              "s.toml:4:65: error: part.p.shape.deviation: \"min\": needs a fit");
    EXPECT_EQ(lines(R"(fit = "H7/g6", nominal_diameter = 20, deviation = "middle")"),
              "s.toml:4:88: error: part.p.shape.deviation: \"middle\": must be \"mean\", \"min\" or \"max\"");
    EXPECT_EQ(errorsOf(partOf(R"(kind = "sphere", diameter = 20, fit = "H7/g6")")),
              "s.toml:4:43: error: part.p.shape.fit: unknown key; known keys: kind, diameter");
}

TEST(SceneReader, KnowsItsUnits) {
    // Truth: closed form: definition of the units; the part's own unit wins.
    const std::string sphere = "[[part]]\nname = \"ball\"\nheld = true\nshape = { kind = \"sphere\", diameter = 2 }\n";
    const auto diameter = [](const Result<scene::SceneSpec>& scene) {
        return std::get<shape::Sphere>(std::get<shape::Shape>(scene->parts[0].geometry)).diameter;
    };
    EXPECT_EQ(diameter(read(sphere)), 2e-3);
    EXPECT_EQ(diameter(read("unit = \"m\"\n" + sphere + "[contact]\nspacing_mm = 10\n")), 2.0);
    EXPECT_EQ(diameter(read("unit = \"cm\"\n" + sphere)), 2e-2);
    EXPECT_EQ(diameter(read("unit = \"um\"\n" + sphere)), 2e-6);
    EXPECT_DOUBLE_EQ(diameter(read("unit = \"in\"\n" + sphere)), 0.0508);
    EXPECT_EQ(diameter(read("unit = \"m\"\n" + sphere + "unit = \"mm\"\n")), 2e-3);
}

/// A plate in the hand `hand`, a peg in the first one, and those further hands.
std::string handScene(const std::string& hand, const std::string& hands, const std::string& more = "") {
    return R"([[part]]
name = "plate"
held = true
)" + hand + R"(
shape = { kind = "box", width = 60, depth = 50, height = 30 }
[[part]]
name = "peg"
held = true
shape = { kind = "box", width = 10, depth = 10, height = 10 }
pose = { position = [0, 0, 40] }
)" + more + hands;
}

TEST(SceneReader, ReadsFurtherHandsWithTheirDevices) {
    // Truth: the file, by hand. A hand without a device of its own has the first one's.
    const std::string device = "[device]\npreset = \"arm\"\nmax_force_N = 9\n";
    const auto same = read(handScene("hand = \"left\"", "[[hand]]\nname = \"left\"\n", device));
    ASSERT_TRUE(same) << toString(same.errors().front());
    ASSERT_EQ(same->handCount(), 2u);
    EXPECT_EQ(same->heldBy(0), 1u);
    EXPECT_EQ(same->heldBy(1), 0u);
    EXPECT_EQ(same->hand(1).name, "left");
    EXPECT_EQ(same->hand(1).limits.max_force, 9.0);
    EXPECT_EQ(same->hand(1).registration.scale, 1.0);

    const auto own = read(handScene("hand = \"left\"",
                                    "[[hand]]\nname = \"left\"\ndevice = { preset = \"arm\", max_force_N = 7 }\n"
                                    "registration = { position = [100, 0, 0] }\nstart_gate = { hold_ms = 50 }\n",
                                    device));
    ASSERT_TRUE(own) << toString(own.errors().front());
    EXPECT_EQ(own->hand(0).limits.max_force, 9.0);
    EXPECT_EQ(own->hand(1).limits.max_force, 7.0);
    EXPECT_EQ(own->hand(1).registration.X_WB.p, Vec3(0.1, 0, 0));
    EXPECT_EQ(own->hand(1).start_gate.hold_ticks, 50);
    EXPECT_EQ(own->hand(0).start_gate.hold_ticks, 0);
}

TEST(SceneReader, TellsWhatIsWrongWithHands) {
    // Truth: the rules of KEYS.md; place, key, value, requirement.
    const std::string left = "[[hand]]\nname = \"left\"\n";
    EXPECT_EQ(errorsOf(handScene("hand = \"right\"", left)),
              "s.toml:4:8: error: part.plate.hand: \"right\": no [[hand]] has this name; there are: left\n"
              "s.toml:8:8: error: part.held: true: only one part can be held by each hand\n"
              "s.toml:11:1: error: hand: left: holds no part: one needs held = true and hand = \"left\"");
    EXPECT_EQ(errorsOf(handScene("hand = \"left\"", "")),
              "s.toml:4:8: error: part.plate.hand: \"left\": the scene has no [[hand]]\n"
              "s.toml:8:8: error: part.held: true: only one part can be held by each hand");
    std::string loose = handScene("hand = \"left\"", left);
    loose.replace(loose.find("held = true"), 11, "held = false");
    EXPECT_EQ(errorsOf(loose),
              "s.toml:4:8: error: part.plate.hand: \"left\": needs held = true\n"
              "s.toml:11:1: error: hand: left: holds no part: one needs held = true and hand = \"left\"");
    EXPECT_NE(errorsOf(handScene("hand = \"left\"", left + left)).find("is used by another hand"), std::string::npos);
    EXPECT_NE(errorsOf(handScene("hand = \"left\"", "[[hand]]\nname = \"left\"\nforce = 2\n"))
                  .find("hand.left.force: unknown key; known keys: name, device, registration, effects, start_gate"),
              std::string::npos);
}

TEST(SceneReader, TellsWhatHandsCannotHaveYet) {
    // Truth: core/scene/scene_spec.cpp refuses the same; here at its place.
    const std::string left = "[[hand]]\nname = \"left\"\n";
    EXPECT_NE(errorsOf(handScene("hand = \"left\"", left, "[contact]\ngeometry = \"field\"\nbudget_nodes = 9\n"))
                  .find("s.toml:13:16: error: contact.budget_nodes: 9: must be 0 with more than one hand"),
              std::string::npos);
    EXPECT_NE(errorsOf(handScene("hand = \"left\"\nfriction = 0.2", left, "friction = 0.3\n"))
                  .find("error: part.peg.friction: 0.3: must be 0 on all parts that hands hold but one"),
              std::string::npos);
    // A name that is none is told once.
    EXPECT_EQ(
        errorsOf(handScene("hand = \"left\"", "[[hand]]\nname = \"LEFT\"\n")),
        "s.toml:12:8: error: hand.name: \"LEFT\": must be lower-case letters, digits and _, beginning with a letter");
    EXPECT_EQ(errorsOf(handScene("hand = \"left\"", "[[hand]]\n")), "s.toml:11:1: error: hand.name: required");
}

/// A pickable peg on a plate that rests, an empty hand, and what else there is.
std::string pickScene(const std::string& part, const std::string& more) {
    return R"([[part]]
name = "plate"
shape = { kind = "box", width = 60, depth = 50, height = 30 }
[[part]]
name = "peg"
)" + part +
           R"(
shape = { kind = "box", width = 10, depth = 10, height = 10 }
pose = { position = [0, 0, 40] }
)" + more;
}

TEST(SceneReader, ReadsPartsThatHandsPickUp) {
    // Truth: the file, by hand. Hands may begin with nothing then, each with a start pose of its own.
    const auto scene =
        read(pickScene("pickable = true",
                       "[effects.pick]\nreach_mm = 7\n[start_gate]\nhold_ms = 50\npose = { position = [1, 2, 3] }\n"
                       "[[hand]]\nname = \"left\"\nstart_gate = { pose = { position = [4, 5, 6] }, hold_ms = 30 }\n"));
    ASSERT_TRUE(scene) << toString(scene.errors().front());
    EXPECT_EQ(scene->effects.pick.reach, 7e-3);
    EXPECT_EQ(scene->effects.pick.button, 1);
    EXPECT_FALSE(scene->effects.pick.on_press);
    EXPECT_FALSE(scene->effects.pick.locks);
    EXPECT_FALSE(scene->parts[0].pickable);
    EXPECT_TRUE(scene->parts[1].pickable);
    EXPECT_EQ(scene->heldBy(0), 2u) << "nothing";
    EXPECT_TRUE(scene->canPick(0));
    EXPECT_EQ(scene->obstaclesOf(1), (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(scene->hand(0).start_gate.X_WH.p, Vec3(1e-3, 2e-3, 3e-3));
    EXPECT_EQ(scene->hand(1).start_gate.X_WH.p, Vec3(4e-3, 5e-3, 6e-3));
    const auto other = read(pickScene("pickable = true\nheld = true",
                                      "[effects.pick]\nreach_mm = 7\nbutton = 24\nclosed = \"on_press\"\nlet_go = "
                                      "\"lock\"\n"));
    ASSERT_TRUE(other) << toString(other.errors().front());
    EXPECT_EQ(other->effects.pick.button, 24);
    EXPECT_TRUE(other->effects.pick.on_press);
    EXPECT_TRUE(other->effects.pick.locks);
    EXPECT_EQ(other->heldBy(0), 1u);
}

TEST(SceneReader, TellsWhatIsWrongWithPickingUp) {
    // Truth: the rules of KEYS.md; place, key, value, requirement.
    EXPECT_EQ(errorsOf(pickScene("pickable = true\nheld = true", "")),
              "s.toml:6:12: error: part.peg.pickable: true: needs effects.pick: nothing else picks parts up");
    EXPECT_EQ(errorsOf(pickScene("held = true", "[effects.pick]\nreach_mm = 7\n")),
              "s.toml:9:1: error: effects.pick: {...}: needs a part with pickable = true");
    EXPECT_EQ(errorsOf(pickScene("pickable = true", "[effects.pick]\n")),
              "s.toml:9:1: error: effects.pick.reach_mm: required");
    EXPECT_EQ(errorsOf(pickScene("pickable = true", "[effects.pick]\nreach_mm = 7\nbutton = 25\n")),
              "s.toml:11:10: error: effects.pick.button: 25: must be from 1 to 24");
    EXPECT_EQ(errorsOf(pickScene("pickable = true", "[effects.pick]\nreach_mm = 7\n[start_gate]\nhold_ms = 50\n")),
              "s.toml:12:11: error: start_gate.hold_ms: 50: needs `pose`: the hand begins with nothing");
    EXPECT_EQ(
        errorsOf(pickScene("pickable = true\nheld = true",
                           "[effects.pick]\nreach_mm = 7\n[start_gate]\npose = { position = [1, 2, 3] }\n")),
        "s.toml:13:8: error: start_gate.pose: {...}: is that of the part which the hand holds: only a hand that begins "
        "with nothing has its own");
}

TEST(SceneReader, ReadsALeastQualityOfThePenaltyUnderABudget) {
    // Truth: the rules of KEYS.md.
    const auto with = [](const std::string& contact) {
        return pickScene("held = true", "[contact]\ngeometry = \"field\"\n" + contact);
    };
    const auto scene = read(with("method = \"penalty\"\nbudget_nodes = 50\nquality = 0.6\n"));
    ASSERT_TRUE(scene) << toString(scene.errors().front());
    EXPECT_EQ(scene->contact.quality, 0.6);
    EXPECT_NE(errorsOf(with("method = \"penalty\"\nquality = 0.6\n")).find("contact.quality: 0.6: needs budget_nodes"),
              std::string::npos);
    EXPECT_NE(errorsOf(with("method = \"god_object\"\nbudget_nodes = 50\nquality = 0.6\n"))
                  .find("contact.quality: 0.6: needs method = \"penalty\""),
              std::string::npos);
    EXPECT_NE(errorsOf(with("method = \"penalty\"\nbudget_nodes = 50\nquality = 1.6\n"))
                  .find("contact.quality: 1.6: must be from 0 to 1"),
              std::string::npos);
}

TEST(SceneReader, RefusesAStiffnessThatAnotherHandsDeviceDoesNotBear) {
    // Truth: the device's stable maximum, 1000 N/m of "stick"; the scene's is that of "arm", 4000 N/m.
    const std::string device = "[device]\npreset = \"arm\"\n";
    const std::string stick = "[[hand]]\nname = \"left\"\ndevice = { preset = \"stick\" }\n";
    EXPECT_NE(errorsOf(handScene("hand = \"left\"", stick, device))
                  .find("stick displays contact.stiffness_N_per_m up to 1000 stably, the scene's is 4000"),
              std::string::npos);
    EXPECT_EQ(errorsOf(handScene("hand = \"left\"", stick, device + "[contact]\nstiffness_N_per_m = 900\n")), "");
    EXPECT_EQ(errorsOf(handScene("hand = \"left\"", stick, device + "[contact]\nallow_unstable = true\n")), "");
}

TEST(SceneReader, RotatesAboutFixedAxesInTheOrderXYZ) {
    // Truth: closed form: R = Rz Ry Rx written as matrices of sines and cosines.
    const auto scene = read(kParts);
    ASSERT_TRUE(scene);
    const double a = 10 * M_PI / 180, b = 20 * M_PI / 180, c = 30 * M_PI / 180;
    Mat3 rx, ry, rz;
    rx << 1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a);
    ry << std::cos(b), 0, std::sin(b), 0, 1, 0, -std::sin(b), 0, std::cos(b);
    rz << std::cos(c), -std::sin(c), 0, std::sin(c), std::cos(c), 0, 0, 0, 1;
    EXPECT_LT((scene->parts[1].X_WP.q.toRotationMatrix() - rz * ry * rx).norm(), 1e-14);
}

TEST(SceneReader, TakesWhatIsLeftOutFromTheDevice) {
    // Truth: closed form: the fake device's numbers.
    const auto scene = read(kParts + "[device]\npreset = \"arm\"\n");
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->contact.stiffness, 4000.0);
    EXPECT_EQ(scene->contact.rotational_stiffness, 8.0);
    EXPECT_EQ(scene->contact.damping, 5.0);
    EXPECT_EQ(scene->contact.rotational_damping, 0.002);
    EXPECT_EQ(scene->limits.max_force, 20.0);
    EXPECT_EQ(scene->limits.max_force_rate, 5000.0);
    EXPECT_EQ(scene->limits.delay_ticks, 0) << "the device's own delay is not added twice";
    EXPECT_TRUE(scene->limits.actuates_torque);
    const auto stick = read(kParts + "[device]\npreset = \"stick\"\n");
    ASSERT_TRUE(stick);
    EXPECT_FALSE(stick->limits.actuates_torque);
    EXPECT_EQ(stick->contact.rotational_stiffness, 0.0);
}

TEST(SceneReader, CouplesThePenaltyThroughATool) {
    // Truth: closed form: ten times the stiffness and a tenth of the device's inertia, as the key table says.
    std::vector<DeviceDescription> devices = fakeDevices();
    devices[0].mechanism = DeviceMechanism{.mass_kg = 0.6, .inertia_kg_m2 = 8e-4};
    const std::string head = kParts + "[device]\npreset = \"arm\"\n[contact]\nmethod = \"penalty\"\ncoupling = ";
    const auto scene = readSceneText(head + "\"virtual\"\n", "s.toml", devices);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->contact.coupling, scene::PenaltyCoupling::Virtual);
    EXPECT_EQ(scene->contact.penalty_stiffness, 40000.0);
    EXPECT_DOUBLE_EQ(scene->contact.tool_mass, 0.06);
    EXPECT_DOUBLE_EQ(scene->contact.tool_inertia, 8e-5);
    const auto named = readSceneText(
        head + "\"quasi_static\"\npenalty_stiffness_N_per_m = 7000\ntool_mass_kg = 0.2\ntool_inertia_kg_m2 = 0.001\n",
        "s.toml", devices);
    ASSERT_TRUE(named);
    EXPECT_EQ(named->contact.coupling, scene::PenaltyCoupling::QuasiStatic);
    EXPECT_EQ(named->contact.penalty_stiffness, 7000.0);
    EXPECT_EQ(named->contact.tool_mass, 0.2);
    EXPECT_EQ(named->contact.tool_inertia, 0.001);
    const auto unknown = read(kParts + "[contact]\nmethod = \"penalty\"\ncoupling = \"virtual\"\n");
    ASSERT_TRUE(unknown);
    EXPECT_EQ(unknown->contact.tool_mass, 0.05);
    EXPECT_EQ(unknown->contact.tool_inertia, 5e-5);
    EXPECT_NE(
        errorsOf(kParts + "[contact]\nmethod = \"god_object\"\ncoupling = \"virtual\"\n").find("contact.coupling"),
        std::string::npos);
}

TEST(SceneReader, ReadsTheGeometryOfContactAndSaysWhereItCannotBeHad) {
    // Truth: closed form: the table of keys; a part of a mesh and a penalty have no closed form.
    ASSERT_TRUE(read(kParts));
    EXPECT_EQ(read(kParts)->contact.geometry, scene::Geometry::Auto);
    const auto field = read(kParts + "[contact]\ngeometry = \"field\"\n");
    ASSERT_TRUE(field);
    EXPECT_EQ(field->contact.geometry, scene::Geometry::Field);
    const std::string penalty = "[contact]\nmethod = \"penalty\"\ngeometry = \"closed_form\"\n";
    EXPECT_NE(errorsOf(kParts + penalty).find("error: contact.geometry: \"closed_form\": "), std::string::npos)
        << errorsOf(kParts + penalty);
    EXPECT_NE(errorsOf(kParts + "[contact]\ngeometry = \"fields\"\n").find("contact.geometry: \"fields\""),
              std::string::npos);
}

TEST(SceneReader, TakesEncoderStepsFromTheDeviceIfTheyAreKnown) {
    // Truth: closed form: the numbers of a mechanism; of a device without one, as every real one, none are known.
    std::vector<DeviceDescription> devices = fakeDevices();
    devices[0].mechanism = DeviceMechanism{.quantum_m = 16e-6, .rotational_quantum_rad = 3e-4};
    const auto arm = readSceneText(kParts + "[device]\npreset = \"arm\"\n", "s.toml", devices);
    const auto stick = readSceneText(kParts + "[device]\npreset = \"stick\"\n", "s.toml", devices);
    ASSERT_TRUE(arm && stick);
    EXPECT_EQ(arm->limits.quantum, 16e-6);
    EXPECT_EQ(arm->limits.rotational_quantum, 3e-4);
    EXPECT_EQ(stick->limits.quantum, 0.0);
    EXPECT_EQ(stick->limits.rotational_quantum, 0.0);
}

TEST(SceneReader, ResolvesStiffnessAgainstTheStableMaximum) {
    // Truth: closed form: fractions of 4000 N/m and 8 N·m/rad.
    const auto with = [](const std::string& contact) {
        return read(kParts + "[device]\npreset = \"arm\"\n[contact]\n" + contact);
    };
    const auto fraction = with("stiffness_N_per_m = \"0.7 max\"");
    ASSERT_TRUE(fraction);
    EXPECT_DOUBLE_EQ(fraction->contact.stiffness, 2800.0);
    EXPECT_DOUBLE_EQ(fraction->contact.rotational_stiffness, 5.6);
    const auto number = with("stiffness_N_per_m = 1000");
    ASSERT_TRUE(number);
    EXPECT_DOUBLE_EQ(number->contact.rotational_stiffness, 2.0);
    const auto own = with("stiffness_N_per_m = \"max\"\nrotational_stiffness_Nm_per_rad = \"0.5 max\"");
    ASSERT_TRUE(own);
    EXPECT_DOUBLE_EQ(own->contact.rotational_stiffness, 4.0);
}

TEST(SceneReader, RefusesStiffnessAboveTheStableMaximum) {
    // Truth: closed form: 4000 N/m is the fake device's maximum; 11 lines stand before.
    EXPECT_EQ(
        errorsOf(kParts + "[device]\npreset = \"arm\"\n[contact]\nstiffness_N_per_m = 4000.5\n"),
        "s.toml:14:21: error: contact.stiffness_N_per_m: 4000.5: must not exceed the stable maximum of arm: 4000; "
        "allow_unstable = true lifts this");
    EXPECT_EQ(errorsOf(kParts + "[contact]\nstiffness_N_per_m = \"max\"\n"),
              "s.toml:12:21: error: contact.stiffness_N_per_m: \"max\": a fraction of the stable maximum needs "
              "device.preset");
    EXPECT_EQ(errorsOf(kParts + "[device]\npreset = \"arm\"\nmax_force_N = 21\n"),
              "s.toml:13:15: error: device.max_force_N: 21: must not exceed the limit of arm: 20");
}

TEST(SceneReader, RefusesWhatTheStableMaximumWasNotFoundFor) {
    // Truth: closed form: it holds for the fake device's damping 5 and 0.002 and no added delay; with a scale s the
    // hand feels K s and B s, so that 4000 and 5 are 800 and 1 at s = 5.
    const std::string arm = kParts + "[device]\npreset = \"arm\"\n";
    const std::string not_known = "the stable maximum of arm is not known for this; leave it out or set ";
    const std::string unless = ", or allow_unstable = true";
    EXPECT_EQ(errorsOf(arm + "delay_ticks = 20\n"),
              "s.toml:13:15: error: device.delay_ticks: 20: " + not_known + "0" + unless);
    EXPECT_EQ(errorsOf(arm + "[contact]\ndamping_Ns_per_m = 0\nstiffness_N_per_m = 4000\n"),
              "s.toml:14:20: error: contact.damping_Ns_per_m: 0: " + not_known + "the recommended 5" + unless);
    EXPECT_EQ(errorsOf(arm + "[contact]\nrotational_damping_Nms_per_rad = 0.1\n"),
              "s.toml:14:34: error: contact.rotational_damping_Nms_per_rad: 0.1: " + not_known +
                  "the recommended 0.002" + unless);
    const std::string scaled = arm + "[registration]\nscale = 5\n[contact]\n";
    EXPECT_EQ(errorsOf(scaled), "");
    EXPECT_EQ(errorsOf(scaled + "stiffness_N_per_m = 800\ndamping_Ns_per_m = 1\n"), "");
    EXPECT_EQ(errorsOf(scaled + "stiffness_N_per_m = 801\n"),
              "s.toml:16:21: error: contact.stiffness_N_per_m: 801: must not exceed the stable maximum of arm per the "
              "registration's scale of 5: 800; allow_unstable = true lifts this");
    EXPECT_EQ(errorsOf(scaled + "damping_Ns_per_m = 5\n"),
              "s.toml:16:20: error: contact.damping_Ns_per_m: 5: " + not_known + "the recommended 1" + unless);
    EXPECT_EQ(errorsOf(arm + "delay_ticks = 0\n[contact]\ndamping_Ns_per_m = 5\n"
                             "rotational_damping_Nms_per_rad = 0.002\n[registration]\nscale = 1\n"),
              "");
    EXPECT_EQ(errorsOf(kParts + "[device]\ndelay_ticks = 20\n[contact]\ndamping_Ns_per_m = 0\n"
                                "[registration]\nscale = 5\n"),
              "")
        << "without a preset nothing is promised";
    const auto unstable = read(arm +
                               "delay_ticks = 20\n[contact]\nallow_unstable = true\ndamping_Ns_per_m = 0\n"
                               "stiffness_N_per_m = 9000\nrotational_stiffness_Nm_per_rad = 20\n"
                               "[registration]\nscale = 5\n");
    ASSERT_TRUE(unstable) << "but who takes responsibility may";
    EXPECT_EQ(unstable->contact.stiffness, 9000.0);
    EXPECT_EQ(unstable->contact.rotational_stiffness, 20.0);
    EXPECT_NE(errorsOf(arm + "[contact]\nallow_unstable = false\nstiffness_N_per_m = 9000\n"), "");
}

TEST(SceneReader, ReadsAGuideAndItsWayInTheFilesUnit) {
    // Truth: closed form: millimetres to metres, degrees to a quaternion, each number another one; defaults of KEYS.md.
    const std::string way =
        "way = [{ position = [0, 0, 30] }, { position = [1, 2, -20], rotation_deg = [0, 0, 90] }]\n";
    EXPECT_EQ(read(kParts)->effects.guidance.share, 0.0);
    const auto scene = read(kParts +
                            "[effects]\nrecord = true\n[effects.guidance]\nshare = 0.4\nspeed_mm_per_s = 20\n"
                            "lead_mm = 7\nstiffness_N_per_m = 300\nrotational_stiffness_Nm_per_rad = 0.5\n" +
                            way);
    ASSERT_TRUE(scene) << toString(scene.errors().front());
    const scene::Guidance& guidance = scene->effects.guidance;
    EXPECT_TRUE(scene->effects.record);
    EXPECT_EQ(guidance.share, 0.4);
    EXPECT_DOUBLE_EQ(guidance.speed, 0.02);
    EXPECT_DOUBLE_EQ(guidance.lead, 0.007);
    EXPECT_EQ(guidance.stiffness, 300.0);
    EXPECT_EQ(guidance.rotational_stiffness, 0.5);
    ASSERT_EQ(guidance.X_WG.size(), 2u);
    EXPECT_LT((guidance.X_WG[1].p - Vec3(0.001, 0.002, -0.02)).norm(), 1e-15);
    EXPECT_LT((guidance.X_WG[1].q * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
    const auto defaults = read(kParts + "[effects.guidance]\nshare = 1\n" + way);
    ASSERT_TRUE(defaults);
    EXPECT_DOUBLE_EQ(defaults->effects.guidance.speed, 0.03);
    EXPECT_DOUBLE_EQ(defaults->effects.guidance.lead, 0.01);
    EXPECT_EQ(defaults->effects.guidance.stiffness, 500.0);
    EXPECT_EQ(defaults->effects.guidance.rotational_stiffness, 0.2);
    EXPECT_FALSE(defaults->effects.record);
}

TEST(SceneReader, RefusesAGuideBesideWhatItConflictsWith) {
    // Truth: the rules of KEYS.md. A share of 0 is no guide.
    const auto with = [](const std::string& share, const std::string& more) {
        return kParts + more + "[effects.guidance]\nway = [{ position = [0, 0, 30] }]\nshare = " + share + "\n";
    };
    const std::string passivity = "[effects.passivity_controller]\nmax_damping_Ns_per_m = 20\n";
    EXPECT_EQ(errorsOf(with("0.5", "")), "");
    EXPECT_NE(errorsOf(with("0.5", passivity)).find("effects.guidance.share: 0.5: must be 0 with effects.passivity"),
              std::string::npos);
    EXPECT_EQ(errorsOf(with("0", passivity)), "");
    EXPECT_NE(errorsOf(with("1.5", "")).find("effects.guidance.share: 1.5: must be from 0 to 1"), std::string::npos);
    EXPECT_NE(errorsOf(kParts + "[effects.guidance]\nshare = 1\n").find("effects.guidance.way: required"),
              std::string::npos);
    EXPECT_NE(errorsOf(kParts + "[effects.guidance]\nshare = 1\nway = []\n").find("effects.guidance.way"),
              std::string::npos);
    // Truth: the device's stable maximum, 4000 N/m of "arm": 3700 + 0.5 * 500 are within it, 3700 + 500 are not.
    const std::string arm =
        "[device]\npreset = \"arm\"\n[contact]\nstiffness_N_per_m = 3700\n"
        "rotational_stiffness_Nm_per_rad = 0\n";
    const std::string no_turn = "rotational_stiffness_Nm_per_rad = 0\n";
    EXPECT_EQ(errorsOf(with("0.5", arm) + no_turn), "");
    EXPECT_NE(errorsOf(with("1", arm) + no_turn).find("effects.guidance.stiffness_N_per_m"), std::string::npos);
}

TEST(SceneReader, ReadsSnapAndItsPlaces) {
    // Truth: closed form: millimetres to metres, each number another one; the default of KEYS.md.
    const auto scene =
        read(kParts + "[effects.snap]\nstiffness_N_per_m = 250\nrange_mm = 8\nat = [{ position = [1, 2, -20] }]\n");
    ASSERT_TRUE(scene) << toString(scene.errors().front());
    const scene::Snap& snap = scene->effects.snap;
    EXPECT_EQ(snap.stiffness, 250.0);
    EXPECT_DOUBLE_EQ(snap.range, 0.008);
    ASSERT_EQ(snap.X_WG.size(), 1u);
    EXPECT_LT((snap.X_WG[0].p - Vec3(0.001, 0.002, -0.02)).norm(), 1e-15);
    const auto defaults = read(kParts + "[effects.snap]\nstiffness_N_per_m = 0\n");
    ASSERT_TRUE(defaults);
    EXPECT_DOUBLE_EQ(defaults->effects.snap.range, 0.005);
    EXPECT_FALSE(defaults->effects.snap.any());
}

TEST(SceneReader, RefusesSnapBesideWhatItConflictsWith) {
    // Truth: the rules of KEYS.md. A stiffness of 0 is no snap.
    const auto with = [](const std::string& stiffness, const std::string& more, bool at = true) {
        return kParts + more + "[effects.snap]\nstiffness_N_per_m = " + stiffness + "\n" +
               (at ? "at = [{ position = [0, 0, 30] }]\n" : "");
    };
    const std::string passivity = "[effects.passivity_controller]\nmax_damping_Ns_per_m = 20\n";
    const std::string pick = "[effects.pick]\nreach_mm = 20\n";
    const auto has = [](const std::string& errors, const char* what) { return errors.find(what) != std::string::npos; };
    EXPECT_EQ(errorsOf(with("300", "")), "");
    EXPECT_TRUE(
        has(errorsOf(with("300", passivity)), "effects.snap.stiffness_N_per_m: 300: must be 0 with effects.pa"));
    EXPECT_EQ(errorsOf(with("0", passivity)), "");
    EXPECT_TRUE(has(errorsOf(with("300", "", false)), "effects.snap.stiffness_N_per_m: 300: needs poses `at`"));
    EXPECT_EQ(errorsOf(with("0", "", false)), "");
    EXPECT_TRUE(has(errorsOf(with("300", pick)), "effects.snap.at"));
    EXPECT_TRUE(has(errorsOf(kParts + "[effects.snap]\nrange_mm = 5\n"), "effects.snap.stiffness_N_per_m: required"));
    // Truth: the device's stable maximum, 4000 N/m of "arm": 3700 + 300 are within it, 3700 + 301 are not, nor with a
    // guide of 0.5 * 500 beside 51.
    const std::string arm =
        "[device]\npreset = \"arm\"\n[contact]\nstiffness_N_per_m = 3700\n"
        "rotational_stiffness_Nm_per_rad = 0\n";
    EXPECT_EQ(errorsOf(with("300", arm)), "");
    EXPECT_TRUE(has(errorsOf(with("301", arm)), "effects.snap.stiffness_N_per_m: 301: with contact.stiffness_N_per_m"));
    const std::string guide =
        "[effects.guidance]\nshare = 0.5\nrotational_stiffness_Nm_per_rad = 0\nway = [{ position = [0, 0, 30] }]\n";
    // Against turning 300/3700 of the coupling's 7.5 are 0.61: 8 N·m/rad are too little.
    const std::string turning =
        "[device]\npreset = \"arm\"\n[contact]\nstiffness_N_per_m = 3700\n"
        "rotational_stiffness_Nm_per_rad = ";
    EXPECT_EQ(errorsOf(with("300", turning + "7.3\n")), "");
    EXPECT_TRUE(has(errorsOf(with("300", turning + "7.5\n")), "with contact.rotational_stiffness_Nm_per_rad = 7.5"));
    // Two places 10 mm apart, each with a range of 5 mm, and a little less.
    const auto two = [&](const char* z) {
        return errorsOf(kParts +
                        "[effects.snap]\nstiffness_N_per_m = 300\nat = [{ position = [0, 0, 30] }, "
                        "{ position = [0, 0, " +
                        std::string(z) + "] }]\n");
    };
    EXPECT_EQ(two("40.001"), "");
    EXPECT_TRUE(has(two("39.9"), "effects.snap.at: [{...}, {...}]: has two places whose ranges meet")) << two("39.9");
    EXPECT_EQ(errorsOf(with("50", arm + guide)), "");
    EXPECT_TRUE(has(errorsOf(with("51", arm + guide)), "effects.guidance.stiffness_N_per_m: 500 (default): with"))
        << errorsOf(with("51", arm + guide));
}

TEST(SceneReader, ReadsInertiaAndRefusesItBesideWhatItConflictsWith) {
    // Truth: the rules of KEYS.md. A scale of 0 is no inertia.
    const auto with = [](const std::string& scale, const std::string& more, bool heavy = true) {
        std::string parts = kParts;
        if (heavy) parts.insert(parts.rfind("pose"), "density_kg_per_m3 = 7850\n");
        return parts + more + "[effects.inertia]\n" + scale;
    };
    const auto has = [](const std::string& errors, const char* what) { return errors.find(what) != std::string::npos; };
    const std::string god_object = "[contact]\nmethod = \"god_object\"\n",
                      penalty = "[contact]\nmethod = \"penalty\"\n";
    EXPECT_EQ(errorsOf(with("", god_object)), "");
    EXPECT_EQ(read(with("", god_object))->effects.inertia.scale, 1.0);
    EXPECT_EQ(read(with("scale = 2.5\n", god_object))->effects.inertia.scale, 2.5);
    EXPECT_TRUE(has(errorsOf(with("", penalty)), "effects.inertia.scale: 1 (default): must be 0 with contact.method"))
        << errorsOf(with("", penalty));
    EXPECT_EQ(errorsOf(with("scale = 0\n", penalty)), "");
    EXPECT_TRUE(has(errorsOf(with("", god_object, false)), "effects.inertia: needs density_kg_per_m3 of the held part"))
        << errorsOf(with("", god_object, false));
    EXPECT_TRUE(
        has(errorsOf(with("", "[contact]\nmethod = \"god_object\"\ngeometry = \"field\"\nbudget_nodes = 500\n")),
            "must be 0 with contact.budget_nodes"));
}

TEST(SceneReader, ReadsWhatKeepsPartsApartAndRefusesItBesideWhatItConflictsWith) {
    // Truth: the rules of KEYS.md, and the device's stable maximum, 4000 N/m of "arm".
    const auto with = [](const std::string& stiffness, const std::string& more) {
        return handScene("hand = \"left\"", "[[hand]]\nname = \"left\"\n" + more +
                                                "[effects.keep_apart]\nstiffness_N_per_m = " + stiffness + "\n");
    };
    const auto has = [](const std::string& errors, const char* what) { return errors.find(what) != std::string::npos; };
    const auto scene = read(with("250", ""));
    ASSERT_TRUE(scene) << errorsOf(with("250", ""));
    EXPECT_EQ(scene->effects.keep_apart.stiffness, 250.0);
    EXPECT_DOUBLE_EQ(scene->effects.keep_apart.range, 0.02);
    EXPECT_TRUE(has(errorsOf(kParts + "[effects.keep_apart]\nstiffness_N_per_m = 100\n"), "must be 0 with one hand"));
    EXPECT_EQ(errorsOf(kParts + "[effects.keep_apart]\nstiffness_N_per_m = 0\n"), "");
    EXPECT_TRUE(has(errorsOf(with("250", "[effects.passivity_controller]\nmax_damping_Ns_per_m = 20\n")),
                    "must be 0 with effects.passivity_controller"));
    const std::string arm =
        "[device]\npreset = \"arm\"\n[contact]\nstiffness_N_per_m = 3700\n"
        "rotational_stiffness_Nm_per_rad = 0\n";
    EXPECT_EQ(errorsOf(with("300", arm)), "");
    EXPECT_TRUE(
        has(errorsOf(with("301", arm)), "effects.keep_apart.stiffness_N_per_m: 301: with contact.stiffness_N_per_m"))
        << errorsOf(with("301", arm));
}

TEST(SceneReader, ReadsViscosity) {
    // Truth: the rules of KEYS.md.
    const auto scene = read(kParts + "[effects.viscosity]\ndamping_Ns_per_m = 3\n");
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->effects.viscosity.damping, 3.0);
    EXPECT_EQ(scene->effects.viscosity.rotational_damping, 0.0);
    EXPECT_FALSE(read(kParts)->effects.viscosity.any());
    EXPECT_NE(errorsOf(kParts + "[effects.viscosity]\n").find("effects.viscosity.damping_Ns_per_m: required"),
              std::string::npos);
}

TEST(SceneReader, BuildsTransientsOnlyIfTheyAreNamedAndComplete) {
    // Truth: closed form: 40 ms are 0.04 s; without the table there are none.
    EXPECT_EQ(read(kParts)->effects.transients.amplitude, 0.0);
    const std::string table = kParts + "[effects.transients]\nfrequency_hz = 120\ndecay_ms = 40\n";
    const auto scene = read(table + "amplitude_Ns_per_m = 6\n");
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->effects.transients.amplitude, 6.0);
    EXPECT_EQ(scene->effects.transients.frequency, 120.0);
    EXPECT_DOUBLE_EQ(scene->effects.transients.decay, 0.04);
    EXPECT_EQ(errorsOf(table), "s.toml:11:1: error: effects.transients.amplitude_Ns_per_m: required");
    EXPECT_EQ(errorsOf(table + "amplitude_Ns_per_m = 0\n"),
              "s.toml:14:22: error: effects.transients.amplitude_Ns_per_m: 0: must be > 0");
}

TEST(SceneReader, ReadsNavigationOnlyIfItIsNamed) {
    // Truth: closed form: as written, 40 mm are 0.04 m; the radius is the device's workspace where nothing says it.
    EXPECT_FALSE(read(kParts)->effects.navigation.any());
    const std::string all = kParts +
                            "[effects.clutch]\nbutton = 2\n"
                            "[effects.position_scale]\nbutton = 3\nscale = 0.2\n"
                            "[effects.drift]\nshare = 0.1\n";
    const auto scene = read(all);
    ASSERT_TRUE(scene) << errorsOf(all);
    const scene::Navigation& navigation = scene->effects.navigation;
    EXPECT_EQ(navigation.clutch.button, 2);
    EXPECT_TRUE(navigation.clutch.orientation);
    EXPECT_EQ(navigation.second_scale.button, 3);
    EXPECT_EQ(navigation.second_scale.scale, 0.2);
    EXPECT_EQ(navigation.drift.share, 0.1);
    EXPECT_EQ(navigation.drift.radius, 0.1);
    const auto devices = fakeDevices();
    EXPECT_EQ(read(all + "[device]\npreset = \"" + devices[0].name + "\"\n")->effects.navigation.drift.radius,
              devices[0].workspace_radius_m);
    EXPECT_DOUBLE_EQ(read(all + "radius_mm = 40\n")->effects.navigation.drift.radius, 0.04);
    EXPECT_FALSE(
        read(kParts + "[effects.clutch]\nbutton = 1\norientation = false\n")->effects.navigation.clutch.orientation);
    EXPECT_FALSE(read(kParts + "[effects.drift]\nshare = 0\n")->effects.navigation.any()) << "share 0 is none";
}

TEST(SceneReader, TellsWhatIsWrongWithNavigation) {
    // Truth: definition of the keys: place, value, requirement.
    EXPECT_EQ(errorsOf(kParts + "[effects.clutch]\n"), "s.toml:11:1: error: effects.clutch.button: required");
    EXPECT_EQ(errorsOf(kParts + "[effects.clutch]\nbutton = 25\n"),
              "s.toml:12:10: error: effects.clutch.button: 25: must be from 1 to 24");
    EXPECT_EQ(errorsOf(kParts + "[effects.clutch]\nbutton = 1\ntorque = true\n"),
              "s.toml:13:1: error: effects.clutch.torque: unknown key; known keys: button, orientation");
    EXPECT_EQ(errorsOf(kParts + "[effects.position_scale]\nbutton = 1\nscale = 0\n"),
              "s.toml:13:9: error: effects.position_scale.scale: 0: must be from 0.001 to 1000");
    EXPECT_EQ(errorsOf(kParts + "[effects.drift]\nshare = 0.6\n"),
              "s.toml:12:9: error: effects.drift.share: 0.6: must be from 0 to 0.5");
    EXPECT_EQ(errorsOf(kParts + "[effects.clutch]\nbutton = 2\n[effects.position_scale]\nbutton = 2\nscale = 1\n"),
              "s.toml:14:10: error: effects.position_scale.button: 2: is the clutch's");
    auto devices = fakeDevices();
    devices[0].buttons = 2;
    const std::string three = kParts + "[effects.clutch]\nbutton = 3\n[device]\npreset = \"" + devices[0].name + "\"\n";
    const auto refused = readSceneText(three, "s.toml", devices);
    ASSERT_FALSE(refused);
    EXPECT_EQ(toString(refused.errors().front()),
              "s.toml:12:10: error: effects.clutch.button: 3: " + devices[0].name + " has 2 buttons");
}

TEST(SceneReader, HasNavigationOfEachHand) {
    // Truth: definition: [effects] is that of all hands, a hand's own table stands in its place.
    const std::string two = kParts +
                            "[[part]]\nname = \"other\"\nheld = true\nhand = \"left\"\n"
                            "shape = { kind = \"sphere\", diameter = 10 }\npose = { position = [100, 0, 0] }\n"
                            "[effects.clutch]\nbutton = 2\n[[hand]]\nname = \"left\"\n";
    const auto same = read(two), own = read(two + "[hand.effects.drift]\nshare = 0.2\n");
    ASSERT_TRUE(same) << errorsOf(two);
    ASSERT_TRUE(own);
    EXPECT_EQ(same->other_hands[0].navigation.clutch.button, 2);
    EXPECT_EQ(own->other_hands[0].navigation.clutch.button, 0);
    EXPECT_EQ(own->other_hands[0].navigation.drift.share, 0.2);
    EXPECT_EQ(own->effects.navigation.clutch.button, 2);
}

TEST(SceneReader, HoldsTheStableMaximumAtTheLargestScale) {
    // Truth: closed form: the handle feels K s d + B s v at the scale s that is on: "max" is the device's over the
    // largest of them, and the damping likewise; a smaller second scale changes nothing.
    const auto devices = fakeDevices();
    const DeviceDescription& device = devices[0];
    const auto with = [&](const std::string& scale) {
        return read(kParts + "[device]\npreset = \"" + device.name + "\"\n[registration]\nscale = 2\n" +
                    (scale.empty() ? "" : "[effects.position_scale]\nbutton = 1\nscale = " + scale + "\n"));
    };
    EXPECT_DOUBLE_EQ(with("")->contact.stiffness, device.stable_stiffness_N_per_m / 2.0);
    EXPECT_EQ(with("0.1")->contact.stiffness, with("")->contact.stiffness);
    EXPECT_DOUBLE_EQ(with("8")->contact.stiffness, device.stable_stiffness_N_per_m / 8.0);
    EXPECT_DOUBLE_EQ(with("8")->contact.damping, device.recommended_damping_Ns_per_m / 8.0);
    const std::string stiff = kParts + "[device]\npreset = \"" + device.name +
                              "\"\n[effects.position_scale]\nbutton = 1\nscale = 8\n[contact]\nstiffness_N_per_m = " +
                              std::to_string(device.stable_stiffness_N_per_m / 2.0) + "\n";
    EXPECT_NE(errorsOf(stiff).find(" per effects.position_scale of 8: "), std::string::npos) << errorsOf(stiff);
}

TEST(SceneReader, ReadsTheWeightOfTheHeldPartOnlyIfItIsNamed) {
    // Truth: closed form: standard gravity (ISO 80000-3), down the world's z; density as written.
    EXPECT_TRUE(read(kParts)->effects.weight.gravity.isZero(0.0));
    EXPECT_EQ(read(kParts)->parts[1].density, 0.0);
    const std::string heavy = kParts + "density_kg_per_m3 = 1200\n";
    EXPECT_TRUE(read(heavy)->effects.weight.gravity.isZero(0.0));
    EXPECT_EQ(read(heavy)->parts[1].density, 1200.0);
    EXPECT_EQ(read(heavy + "[effects.weight]\n")->effects.weight.gravity, Vec3(0.0, 0.0, -9.80665));
    EXPECT_EQ(read(heavy + "[effects.weight]\ngravity_m_per_s2 = [0, 1.62, 0]\n")->effects.weight.gravity,
              Vec3(0.0, 1.62, 0.0));
    EXPECT_EQ(errorsOf(kParts + "[effects.weight]\n"),
              "s.toml:11:1: error: effects.weight: needs density_kg_per_m3 of the held part, peg");
    EXPECT_EQ(errorsOf(kParts + "density_kg_per_m3 = -1\n"),
              "s.toml:11:21: error: part.peg.density_kg_per_m3: -1: must be from 0 to 30000");
    EXPECT_EQ(errorsOf(heavy + "[effects.weight]\ngravity_m_per_s2 = [0, 0, 9806]\n"),
              "s.toml:13:20: error: effects.weight.gravity_m_per_s2: [0, 0, 9806]: must be no longer than 100");
    EXPECT_EQ(errorsOf(heavy + "[effects.weight]\ngravity = 9.8\n"),
              "s.toml:13:1: error: effects.weight.gravity: unknown key; did you mean \"gravity_m_per_s2\"?");
}

TEST(SceneReader, RefusesADensityOfWhatEnclosesNoVolume) {
    // Truth: definition: a sheet, a mesh of which one triangle is missing, an open one; closed it is none. Density
    // alone is enough, whether anything weighs or not.
    const std::string held =
        "[[part]]\nname = \"ball\"\nheld = true\nshape = { kind = \"sphere\", diameter = 9 }\npose "
        "= { position = [0, 0, 90] }\n[[part]]\nname = \"a\"\n";
    EXPECT_EQ(errorsOf(held + "shape = { kind = \"sheet\", width = 9, depth = 9 }\ndensity_kg_per_m3 = 1\n"),
              "s.toml:9:21: error: part.a.density_kg_per_m3: 1: needs a part that encloses a volume: it is a sheet");
    const test::TempFolder folder;
    const auto errorsWith = [&](const geometry::TriangleMesh& mesh) {
        test::writeOff(folder / "a.off", mesh);
        return errorsOf(held + "unit = \"m\"\nmesh = \"" + folder / "a.off" + "\"\ndensity_kg_per_m3 = 1\n");
    };
    geometry::TriangleMesh mesh = shape::tessellate(shape::Box{0.02, 0.03, 0.05}, 1e-5);
    EXPECT_EQ(errorsWith(mesh), "");
    mesh.triangles.pop_back();
    EXPECT_EQ(
        errorsWith(mesh),
        "s.toml:10:21: error: part.a.density_kg_per_m3: 1: needs a part that encloses a volume: its mesh has 1 hole");
    mesh.triangles.resize(2);
    EXPECT_EQ(
        errorsWith(mesh),
        "s.toml:10:21: error: part.a.density_kg_per_m3: 1: needs a part that encloses a volume: its mesh is an open "
        "sheet");
}

TEST(SceneReader, RefusesAWeightThatTheDeviceOrTheCouplingCannotCarry) {
    // Truth: closed form: a cylinder of 20 mm and 50 mm at 7850 kg/m³ weighs 1.209 N, 25 mm from the tip: 0.0302 Nm.
    const std::string parts =
        "[[part]]\nname = \"box\"\nshape = { kind = \"box\", width = 9, depth = 9, height = 9 }\n"
        "[[part]]\nname = \"peg\"\nheld = true\nshape = { kind = \"peg\", diameter = 20, length = "
        "50 }\npose = { position = [0, 0, 30] }\ndensity_kg_per_m3 = 7850\n[effects.weight]\n";
    EXPECT_EQ(errorsOf(parts), "");
    EXPECT_EQ(
        errorsOf(parts + "[device]\nmax_force_N = 1\n"),
        "s.toml:9:21: error: part.peg.density_kg_per_m3: 7850: the part weighs 1.21 N: more than the 1 N that the "
        "device may show");
    EXPECT_EQ(
        errorsOf(parts + "[contact]\nrotational_stiffness_Nm_per_rad = 0.02\n"),
        "s.toml:12:35: error: contact.rotational_stiffness_Nm_per_rad: 0.02: the held part's weight, up to 0.0302 "
        "Nm about its origin, would turn it by 1.5 rad against the hand: at least 0.0302, or an origin nearer to its "
        "centre of mass");
    const auto warnings = [&](const std::string& more) {
        const auto scene = readSceneOnDevice(parts + more, "s.toml", fakeDevices());
        EXPECT_TRUE(scene);
        return scene->warnings;
    };
    EXPECT_EQ(warnings("[contact]\nstiffness_N_per_m = 2000\n"), std::vector<std::string>{});
    EXPECT_EQ(
        warnings("[contact]\nstiffness_N_per_m = 500\n"),
        std::vector<std::string>{"effects.weight: the held part of 123 g weighs 1.21 N, up to 0.0302 Nm about its "
                                 "origin; in the air it hangs 2.42 mm from the hand, turned by up to 1.7 deg; a "
                                 "stiffer coupling holds it nearer"});
    EXPECT_EQ(warnings("[contact]\nstiffness_N_per_m = 2000\nrotational_stiffness_Nm_per_rad = 0\n").size(), 1u);
    EXPECT_EQ(warnings("[contact]\nmethod = \"penalty\"\nstiffness_N_per_m = 100\n"), std::vector<std::string>{});
}

TEST(SceneReader, RefusesAnOffsetPictureOfTheHeldPart) {
    // Truth: closed form: the offset stands in line 11, after the held part.
    EXPECT_EQ(errorsOf(kParts + "shown_offset = [0, 0, 2]\n"),
              "s.toml:11:16: error: part.peg.shown_offset: [0, 0, 2]: the held part cannot be drawn elsewhere: it "
              "would move the hand's aim");
}

TEST(SceneReader, TwoWayContactNeedsPointsOnEveryPart) {
    // Truth: closed form: the plate has about 13 000 mm2, at 0.05 mm more than 5e6 points; the peg has few enough.
    const std::string fine = kParts + "[contact]\ngeometry = \"field\"\nspacing_mm = 0.05\n";
    EXPECT_FALSE(read(fine)->contact.two_way);
    EXPECT_TRUE(read(kParts + "[contact]\ntwo_way = true\n")->contact.two_way);
    EXPECT_EQ(errorsOf(fine + "two_way = false\n"), "");
    EXPECT_NE(errorsOf(fine + "two_way = true\n").find("contact.spacing_mm: 0.05: part plate: points"),
              std::string::npos);
}

TEST(SceneReader, BoundsLengths) {
    // Truth: closed form: 10 m are 10000 mm; the peg has 2 pi 10 (10 + 50) mm2 = 3770 mm2, at 0.03 mm 4.2e6 points.
    EXPECT_EQ(errorsOf(kParts + "[registration]\nposition = [0, -10001, 0]\n"),
              "s.toml:12:12: error: registration.position: [0, -10001, 0]: must be within 10 m along every axis");
    EXPECT_EQ(errorsOf(kParts + "[registration]\nposition = [0, -10000, 0]\n"), "");
    EXPECT_EQ(errorsOf("[[part]]\nname = \"b\"\nheld = true\nshape = { kind = \"sphere\", diameter = 10001 }\n"),
              "s.toml:4:39: error: part.b.shape.diameter: 10001: must be at most 10 m");
    EXPECT_EQ(errorsOf(kParts + "[contact]\nspacing_mm = 0.03\ngeometry = \"field\"\n"),
              "s.toml:12:14: error: contact.spacing_mm: 0.03: part peg: points 0.03 mm apart on a part of 20 x 20 x "
              "50 mm are about 4.2e+06, more than 2e+06: check its unit, or choose a spacing of at least 0.0436 mm");
    EXPECT_EQ(errorsOf(kParts + "[contact]\nspacing_mm = 0.05\n"), "");
    EXPECT_EQ(errorsOf(kParts + "[contact]\ncell_mm = 0.000001\nspacing_mm = 100000\n"),
              "s.toml:12:11: error: contact.cell_mm: 1e-06: must be from 1e-05 to 10000\n"
              "s.toml:13:14: error: contact.spacing_mm: 100000: must be from 1e-05 to 10000");
}

TEST(SceneReader, KnowsEveryModeByItsName) {
    // Truth: closed form.
    for (const field::FieldMode mode : field::kFieldModes) {
        const auto scene = read(kParts + "[contact]\nmode = \"" + modeName(mode) + "\"\n");
        ASSERT_TRUE(scene);
        EXPECT_EQ(scene->contact.mode, mode);
    }
    EXPECT_EQ(errorsOf(kParts + "[contact]\nmode = \"cubik\"\n"),
              "s.toml:12:8: error: contact.mode: \"cubik\": must be \"layered\", \"surface_point\", \"linear\", "
              "\"trilinear\" or \"cubic\"");
}

TEST(SceneReader, CollectsEveryProblem) {
    // Truth: closed form: three mistakes on three lines.
    EXPECT_EQ(errorsOf("unit = 3\n[contact]\nspacing_mm = -1\nmod = \"linear\"\n"),
              "s.toml:1:1: error: part: required\n"
              "s.toml:1:8: error: unit: 3: must be a string, not an integer\n"
              "s.toml:3:14: error: contact.spacing_mm: -1: must be from 1e-05 to 10000\n"
              "s.toml:4:1: error: contact.mod: unknown key; did you mean \"mode\"?");
}

TEST(SceneReader, TestsFinitenessFirst) {
    // Truth: invariant: no comparison holds for NaN, so a range alone could let it pass.
    for (const std::string value : {"nan", "inf", "-inf"})
        EXPECT_EQ(errorsOf(kParts + "[contact]\ntolerance_um = " + value + "\n"),
                  "s.toml:12:16: error: contact.tolerance_um: " + value + ": must be a finite number");
    EXPECT_EQ(errorsOf(kParts + "[registration]\nposition = [0, nan, 0]\n"),
              "s.toml:12:12: error: registration.position: [0, nan, 0]: must be finite numbers");
}

TEST(SceneReader, ReportsWhatDoesNotFitTogetherWhereItIsWritten) {
    // Truth: closed form: a chamfer of 10 mm is half of the diameter; the kind decides which keys there are.
    const std::string start = "[[part]]\nname = \"p\"\nheld = true\n";
    EXPECT_EQ(
        errorsOf(start + "shape = { kind = \"peg\", diameter = 20, length = 50, chamfer = 10 }\n"),
        "s.toml:4:63: error: part.p.shape.chamfer: 10: peg: must be less than half the diameter and less than the "
        "length");
    EXPECT_EQ(errorsOf(start + "shape = { kind = \"sphere\", diameter = 20, length = 50 }\n"),
              "s.toml:4:43: error: part.p.shape.length: unknown key; known keys: kind, diameter");
    EXPECT_EQ(
        errorsOf(start + "shape = { kind = \"pyramid\", diameter = 20 }\n"),
        "s.toml:4:18: error: part.p.shape.kind: \"pyramid\": must be \"sphere\", \"box\", \"cylinder\", \"torus\", "
        "\"sheet\", \"peg\", \"square_peg\", \"keyed_peg\", \"bore_plate\", \"square_bore_plate\", "
        "\"keyed_bore_plate\", \"thread_bolt\" or \"thread_nut\"");
    EXPECT_EQ(errorsOf(start + "pose = { position = [1, 2] }\n"),
              "s.toml:1:1: error: part.p: needs a shape or a mesh\n"
              "s.toml:4:21: error: part.p.pose.position: [1, 2]: must be a list of three numbers");
}

TEST(SceneReader, FindsMeshesBesideTheFile) {
    // Truth: invariant: the path is relative to the file that names it, not to the working directory.
    const auto folder = std::filesystem::path(testing::TempDir()) / "passung_scene_reader";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "corner.off")
        << "OFF\n4 4 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    std::ofstream(folder / "s.toml") << "[[part]]\nname = \"b\"\nheld = true\nmesh = \"corner.off\"\nunit = \"cm\"\n";
    const auto scene = readScene((folder / "s.toml").string(), {});
    ASSERT_TRUE(scene) << toString(scene.errors().front());
    const auto& mesh = std::get<scene::MeshFile>(scene->parts[0].geometry);
    EXPECT_TRUE(std::filesystem::exists(mesh.path));
    EXPECT_EQ(mesh.metres_per_unit, 0.01);
    std::filesystem::remove(folder / "corner.off");
    const auto without = readScene((folder / "s.toml").string(), {});
    ASSERT_FALSE(without) << "what contact could feel of it is not known";
    EXPECT_EQ(without.errors().size(), 1u);
    std::filesystem::remove_all(folder);
}

TEST(SceneReader, ReadsAFileWithOnePart) {
    // Truth: closed form; the unit of the call counts where the file has none.
    const auto path = std::filesystem::path(testing::TempDir()) / "passung_part.toml";
    std::ofstream(path) << "[[part]]\nname = \"ball\"\nshape = { kind = \"sphere\", diameter = 2 }\n";
    const auto part = readPart(path.string(), 1.0);
    ASSERT_TRUE(part);
    EXPECT_EQ(std::get<shape::Sphere>(std::get<shape::Shape>(part->geometry)).diameter, 2.0);
    std::ofstream(path, std::ios::app) << "[[part]]\nname = \"b\"\nshape = { kind = \"sphere\", diameter = 2 }\n";
    const auto two = readPart(path.string());
    ASSERT_FALSE(two);
    EXPECT_EQ(toString(two.errors()[0]), path.string() + ":4:1: error: part: must be exactly one");
    std::filesystem::remove(path);
    EXPECT_FALSE(readPart(path.string()));
}

TEST(SceneReader, AutomaticAccuracyNeedsABudgetAStudyAndNothingElseChosen) {
    // Truth: invariant
    const auto contact = [](const std::string& keys) { return errorsOf(kParts + "[contact]\n" + keys); };
    EXPECT_NE(contact("accuracy_budget_us = 50\n").find("accuracy_budget_us: 50: needs accuracy = \"auto\""),
              std::string::npos);
    EXPECT_NE(contact("accuracy = \"auto\"\n").find("accuracy_budget_us: required"), std::string::npos);
    for (const char* key :
         {"tolerance_um = 20", "cell_mm = 1", "spacing_mm = 1", "mode = \"linear\"", "budget_nodes = 100"}) {
        const std::string found = contact("accuracy = \"auto\"\naccuracy_budget_us = 50\n" + std::string(key) + "\n");
        EXPECT_NE(found.find("is picked by accuracy = \"auto\""), std::string::npos) << key << ": " << found;
    }
    const std::string alone = contact("accuracy = \"auto\"\naccuracy_budget_us = 50\ntwo_way = true\n");
    EXPECT_NE(alone.find("only in a study"), std::string::npos);
    EXPECT_EQ(alone.find('\n'), std::string::npos) << alone;
    EXPECT_NE(errorsOf("[[part]]\nname = \"peg\"\nheld = true\nshape = { kind = \"sphere\", diameter = 10 }\n"
                       "[contact]\naccuracy = \"auto\"\naccuracy_budget_us = 50\n")
                  .find(":6:12: error: contact.accuracy: \"auto\": needs a part that the held one can touch"),
              std::string::npos);
    EXPECT_EQ(contact("accuracy = \"chosen\"\ntolerance_um = 30\n"), "");
}

}  // namespace
}  // namespace passung::protocol
