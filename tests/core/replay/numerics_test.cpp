#include "core/tick/numerics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "core/base/random.h"
#include "core/tick/scene_sequence.h"
#include "study/protocol/scene_reader.h"
#include "tests/support/scenes.h"

// Recordings of one number `numerics` give the same bits again. So the bits of these scenes belong to a number: whoever
// changes one raises kNumerics and writes the new number and hashes down here, in one commit.

namespace passung {
namespace {

/// The number to which the hashes below belong.
constexpr int kHashedNumerics = 12;

/// The mathematics library's own bits, which differ between its versions and between processors. Where they do, these
/// hashes say nothing.
constexpr std::uint64_t kLibraryHash = 0xfa1d5bc5fd68c720u;

struct Golden {
    const char* name;
    const char* contact;  // keys beside the parts
    std::uint64_t hash;
};

// Every method with the defaults that a file leaves open, and every effect.
const Golden kGolden[] = {
    {"penalty", "[contact]\nmethod = \"penalty\"\n", 0x7c4f3664d4630949u},
    {"penalty_area", "[contact]\nmethod = \"penalty\"\nvariant = \"area_weighted\"\ntwo_way = true\n",
     0xdcb07298d594bd3au},
    {"heuristic", "[contact]\nmethod = \"god_object_heuristic\"\ngeometry = \"field\"\n", 0xc752683fbe4175a5u},
    {"god_object", "[contact]\nmethod = \"god_object\"\ngeometry = \"field\"\n", 0x11abe7ab97d2c25cu},
    {"god_object_two_way",
     "[contact]\nmethod = \"god_object\"\ngeometry = \"field\"\ntwo_way = true\nbudget_nodes = 400\n",
     0xb39bca3630f0659eu},
    {"layered", "[contact]\nmethod = \"god_object\"\ngeometry = \"field\"\nmode = \"layered\"\ncell_mm = 0.5\n",
     0x62992c973bc2a808u},
    {"surface_friction", "[contact]\nmethod = \"god_object\"\n", 0x0450d0201eea9f0au},
    {"cubic", "[contact]\nmethod = \"penalty\"\nmode = \"cubic\"\nspacing_mm = 0.7\n", 0x7f04a43bc8ba6608u},
};

/// Of the scene with every effect.
constexpr std::uint64_t kEveryEffect = 0x723d851ed88ca67cu;

/// The same without friction, on closed forms.
constexpr std::uint64_t kClosedForm = 0x9a6ccf5c5185c6cfu;

/// On surfaces, without the low-pass that they do not have.
constexpr std::uint64_t kSurface = 0x98a93463a0ac5486u;

/// The same with weight.
constexpr std::uint64_t kWeight = 0x35c4ddf2c276e036u;

/// The same with navigation, whose buttons are held now and then.
constexpr std::uint64_t kNavigation = 0xbccd963631025a68u;

/// The same with viscosity and a guide.
constexpr std::uint64_t kGuidance = 0x5c5b71041bdfcb22u;

/// The same with a place that draws the part.
constexpr std::uint64_t kSnap = 0x9550a90efaf2d03cu;

/// The same with inertia.
constexpr std::uint64_t kInertia = 0xc1a61efe560cf1a1u;

constexpr const char* kParts = R"(
[[part]]
name = "plate"
shape = { kind = "bore_plate", width = 40, depth = 40, height = 15, bore_diameter = 10.1, bore_depth = 12, chamfer = 1 }
friction = 0.3
[[part]]
name = "peg"
held = true
friction = 0.3
shape = { kind = "peg", diameter = 10, length = 20, chamfer = 1 }
pose = { position = [0, 0, 2] }
)";

/// A path by plain arithmetic, of no library's sines: presses, slides along the plate, tilts in the bore, and loses a
/// sample now and then.
DeviceReading readingAt(int tick, Random& random) {
    const double t = 1e-3 * tick;
    const auto wave = [](double phase) {  // a parabola per half turn, -1 to 1
        const double part = phase - std::floor(phase);
        return part < 0.5 ? 16.0 * part * (0.5 - part) : -16.0 * (part - 0.5) * (1.0 - part);
    };
    DeviceReading reading;
    reading.X_BD = {rotationFromVector(0.03 * Vec3(wave(1.1 * t), wave(0.7 * t), wave(0.9 * t))),
                    Vec3(0.003 * wave(0.8 * t), 0.002 * wave(1.3 * t), 0.002 - 0.012 * t)};
    reading.fresh = random.below(50) != 0;
    if (random.below(200) == 0) reading.X_BD.p.y() = std::nan("");
    reading.periods = random.below(100) == 0 ? 3 : 1;
    reading.buttons = tick % 200 > 150 ? 2u : tick % 120 > 70 ? 4u : 0u;
    return reading;
}

std::uint64_t hashOf(const scene::SceneSpec& spec) {
    const test::Bench bench(spec);
    const tick::SceneTurn turn{&bench.whole()};
    tick::SceneSequence scenes(std::span(&turn, 1));
    Random random(11);
    for (int i = 0; i < 700; ++i) scenes.step(readingAt(i, random));
    return scenes.hash();
}

std::uint64_t libraryHash() {
    std::uint64_t hash = 0;
    for (int i = 1; i < 2000; ++i) {
        const double x = 0.0031 * i;
        for (const double y : {std::sin(x), std::cos(x), std::exp(-x), std::atan2(x, 2.0), std::acos(x / 7.0)}) {
            std::uint64_t bits = 0;
            std::memcpy(&bits, &y, sizeof bits);
            hash = (hash ^ bits) * 0x100000001b3u;
        }
    }
    return hash;
}

std::string hex(std::uint64_t value) {
    std::array<char, 20> text{};
    std::snprintf(text.data(), text.size(), "0x%016llx", static_cast<unsigned long long>(value));
    return text.data();
}

TEST(Numerics, EveryOutputBitOfFixedScenesIsThatOfItsNumber) {
    // Truth: regression (hashes of the commit that raised kNumerics to kHashedNumerics; replayer_test.cpp and the
    // truths of tests/core/tick say that the ticks are right).
    EXPECT_EQ(tick::kNumerics, kHashedNumerics)
        << "kNumerics was raised: write the new number, and the hashes that this test prints, into this file";
    if (libraryHash() != kLibraryHash)
        GTEST_SKIP() << "another mathematics library or processor than that of the hashes: " << hex(libraryHash());
    const std::string advice =
        ": an output bit of a tick has changed. Raise kNumerics in core/tick/numerics.h by one, so that nobody's "
        "recordings are said to differ, and write the new number and this hash into this file.";
    for (const Golden& golden : kGolden) {
        const auto spec = protocol::readSceneText(golden.contact + std::string(kParts), "numerics.toml", {});
        ASSERT_TRUE(spec) << toString(spec.errors().front());
        EXPECT_EQ(hex(hashOf(*spec)), hex(golden.hash)) << golden.name << advice;
    }
    auto spec = *protocol::readSceneText(std::string("[contact]\nmethod = \"god_object\"\n") + kParts, "n.toml", {});
    spec.effects.passivity_damping = 5;
    spec.effects.transients = {.amplitude = 20, .frequency = 150, .decay = 0.01};
    spec.limits.delay_ticks = 2;
    spec.contact.proxy_filter = 150;
    spec.contact.damping = 3;
    EXPECT_EQ(hex(hashOf(spec)), hex(kEveryEffect)) << "every effect" << advice;
    for (scene::PartSpec& part : spec.parts) part.friction = part.sliding_friction = 0.0;
    EXPECT_EQ(hex(hashOf(spec)), hex(kClosedForm)) << "closed form" << advice;
    spec.contact.geometry = scene::Geometry::Surface;
    spec.contact.proxy_filter = 0.0;
    EXPECT_EQ(hex(hashOf(spec)), hex(kSurface)) << "surface" << advice;
    for (scene::PartSpec& part : spec.parts) part.density = 7850.0;
    spec.effects.weight.gravity = Vec3(0.0, 0.0, -scene::kStandardGravity);
    EXPECT_EQ(hex(hashOf(spec)), hex(kWeight)) << "weight" << advice;
    spec.effects.navigation = {.clutch = {2, true}, .second_scale = {3, 0.4}, .drift = {0.2, 0.02}};
    EXPECT_EQ(hex(hashOf(spec)), hex(kNavigation)) << "navigation" << advice;
    spec.effects.viscosity = {2.0, 1e-3};
    spec.effects.guidance = {.share = 0.5, .X_WG = {Pose{}}, .rotational_stiffness = 2.0};
    EXPECT_EQ(hex(hashOf(spec)), hex(kGuidance)) << "viscosity and guidance" << advice;
    spec.effects.snap = {.stiffness = 300.0, .range = 0.02, .X_WG = {Pose{}}};
    EXPECT_EQ(hex(hashOf(spec)), hex(kSnap)) << "snap" << advice;
    spec.effects.inertia.scale = 1.0;
    EXPECT_EQ(hex(hashOf(spec)), hex(kInertia)) << "inertia" << advice;
}

}  // namespace
}  // namespace passung
