#include "core/scene/part_mass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/base/random.h"
#include "core/scene/scene.h"
#include "tests/support/off_file.h"
#include "tests/support/temp_folder.h"

namespace passung::scene {
namespace {

constexpr double kDensity = 1200.0;

/// Every kind of shape that encloses a volume.
std::vector<shape::Shape> solids() {
    return {shape::Sphere{0.02},
            shape::Box{0.02, 0.03, 0.05},
            shape::Cylinder{0.02, 0.05},
            shape::Torus{0.04, 0.015},
            shape::Peg{0.02, 0.05, 0.0},
            shape::Peg{0.02, 0.05, 0.004},
            shape::Peg{0.02, 0.05, 0.01},
            shape::SquarePeg{0.02, 0.03, 0.05, 0.003},
            shape::KeyedPeg{0.02, 0.05, 0.006, 0.003, 0.001},
            shape::BorePlate{0.06, 0.05, 0.03, 0.02, 0.02, 0.003},
            shape::BorePlate{0.06, 0.05, 0.03, 0.02, 0.05, 0.0},
            shape::SquareBorePlate{0.06, 0.05, 0.03, 0.02, 0.01, 0.02, 0.002},
            shape::KeyedBorePlate{0.06, 0.05, 0.03, 0.02, 0.006, 0.003, 0.02, 0.001},
            shape::ThreadBolt{0.012, 0.00175, 0.01, 0.0005},
            shape::ThreadNut{0.012, 0.00175, 0.02, 0.01, 0.0005}};
}

TEST(PartMass, OfEveryShapeIsThatOfItsTriangles) {
    // Truth: independent program (the divergence theorem on triangles within 1 µm of the shape). Their mass is off by
    // less than their area times 1 µm, which is 0.1 % of what these weigh.
    for (const shape::Shape& shape : solids()) {
        const auto mass = massOf(shape, kDensity);
        ASSERT_TRUE(mass) << shape::kindName(shape);
        const auto triangles = geometry::massOf(shape::tessellate(shape, 1e-6), kDensity);
        EXPECT_NEAR(mass->mass / triangles.mass, 1.0, 1e-3) << shape::kindName(shape);
        EXPECT_LT((mass->centre - triangles.centre).norm(), 1e-5) << shape::kindName(shape);
        EXPECT_LT((mass->inertia - triangles.inertia).norm(), 1e-3 * triangles.inertia.norm())
            << shape::kindName(shape);
    }
}

TEST(PartMass, OfEveryShapeIsWhatRandomPointsInItSay) {
    // Truth: independent program (Monte Carlo by the closed form of the distance, 100 000 points in the bounds): four
    // deviations.
    Random random(3);
    for (const shape::Shape& shape : solids()) {
        const geometry::Bounds bounds = geometry::boundsOf(shape::tessellate(shape, 1e-4));
        constexpr int kPoints = 100'000;
        double inside = 0.0;
        Vec3 first = Vec3::Zero();
        for (int i = 0; i < kPoints; ++i) {
            const Vec3 p =
                bounds.low + bounds.size().cwiseProduct(Vec3(random.uniform(), random.uniform(), random.uniform()));
            if (!(shape::signedDistance(shape, p) < 0.0)) continue;
            inside += 1.0;
            first += p;
        }
        const auto mass = massOf(shape, kDensity);
        EXPECT_NEAR(kDensity * bounds.size().prod() * inside / kPoints / mass->mass, 1.0, 0.012)
            << shape::kindName(shape);
        EXPECT_LT((first / inside - mass->centre).norm(), 0.003 * bounds.size().norm()) << shape::kindName(shape);
    }
}

TEST(PartMass, IsExactWhereAShapeHasAClosedForm) {
    // Truth: closed form: a cone of radius = height = c weighs π c³/3, and lies 3/4 of it from its tip.
    const double c = 0.01, pi = 3.14159265358979323846;
    const auto cone = massOf(shape::Peg{2 * c, 2 * c, c}, 1.0);
    EXPECT_NEAR(cone->mass, pi * c * c * c * (1.0 + 1.0 / 3.0), 1e-12 * cone->mass);
    EXPECT_NEAR(cone->centre.z(), (1.0 * 1.5 * c + 1.0 / 3.0 * 0.75 * c) / (4.0 / 3.0), 1e-15);
    const auto plate = massOf(shape::BorePlate{0.06, 0.05, 0.03, 0.02, 0.05, 0.0}, 1.0);
    EXPECT_NEAR(plate->mass, 0.03 * (0.06 * 0.05 - pi * 0.0001), 1e-12 * plate->mass);
}

TEST(PartMass, IsThereOnlyWhereAVolumeIsEnclosed) {
    // Truth: definition. A box that lacks one of twelve triangles has a hole, which contact closes.
    EXPECT_FALSE(massOf(shape::Sheet{0.02, 0.02}, kDensity));
    const test::TempFolder folder;
    const auto weighed = [&](const char* name, const geometry::TriangleMesh& mesh) {
        const std::string path = folder / name;
        test::writeOff(path, mesh);
        const auto part = buildPart({.name = "part", .geometry = MeshFile{path, 1.0}, .X_WP = {}}, {});
        EXPECT_TRUE(part);
        return massOf(*part, kDensity);
    };
    geometry::TriangleMesh box = shape::tessellate(shape::Box{0.02, 0.03, 0.05}, 1e-5);
    const auto whole = weighed("whole.off", box);
    ASSERT_TRUE(whole);
    EXPECT_NEAR(whole->mass, kDensity * 0.02 * 0.03 * 0.05, 1e-12 * whole->mass);
    box.triangles.pop_back();
    EXPECT_FALSE(weighed("holed.off", box));
    box.triangles.resize(2);
    EXPECT_FALSE(weighed("sheet.off", box));
}

/// A cube of 1 kg whose origin is in a corner, above a plate.
SceneSpec heavyCorner(const std::string& path) {
    geometry::TriangleMesh mesh = shape::tessellate(shape::Box{0.1, 0.1, 0.1}, 1e-5);
    for (Vec3& vertex : mesh.vertices) vertex += Vec3::Constant(0.05);
    test::writeOff(path, mesh);
    SceneSpec spec;
    spec.parts.push_back({.name = "cube", .geometry = MeshFile{path, 1.0}, .X_WP = {}, .held = true, .density = 1e3});
    spec.parts.push_back(
        {.name = "plate", .geometry = shape::Box{0.1, 0.1, 0.01}, .X_WP = {Quat::Identity(), -Vec3::UnitZ()}});
    spec.contact.method = ContactMethod::GodObject;
    spec.contact.rotational_stiffness = 10.0;
    spec.effects.weight.gravity = Vec3(0, 0, -10.0);
    return spec;
}

TEST(HeldWeight, IsWhatTheCouplingIsStretchedAndTwistedBy) {
    // Truth: closed form: 10 N, √3/2 · 0.1 m from the origin; 10 mm at 1000 N/m, 0.866 Nm / 10 Nm.
    const test::TempFolder folder;
    SceneSpec spec = heavyCorner(folder / "cube.off");
    PartCache cache;
    const auto scene = buildScene(spec, cache);
    ASSERT_TRUE(scene) << toString(scene.errors().front());
    const auto weight = weigh(spec, *massOf(*scene->parts[0], 1e3));
    ASSERT_TRUE(weight);
    EXPECT_NEAR(weight->force, 10.0, 1e-9);
    EXPECT_NEAR(weight->torque, std::sqrt(0.75), 1e-9);
    EXPECT_NEAR(weight->sag, 0.01, 1e-12);
    EXPECT_NEAR(weight->turn, 0.1 * std::sqrt(0.75), 1e-9);
    EXPECT_EQ(
        describe(*weight),
        "of 1 kg weighs 10 N, up to 0.866 Nm about its origin; in the air it hangs 10 mm from the hand, turned by "
        "up to 5 deg");
    spec.contact.method = ContactMethod::Penalty;
    EXPECT_FALSE(weigh(spec, weight->body)->has_proxy);
    spec.effects.weight = {};
    EXPECT_FALSE(weigh(spec, weight->body));
}

TEST(HeldWeight, ThatTurnsThePartTooFarOrOfNoVolumeIsAnErrorOfTheScene) {
    // Truth: definition. 0.866 Nm at 0.8 Nm/rad is more than a radian, without weight it is nothing; a sheet and a mesh
    // with a hole weigh nothing, whoever holds them.
    const test::TempFolder folder;
    SceneSpec spec = heavyCorner(folder / "cube.off");
    const auto errorOf = [](const SceneSpec& scene) {
        PartCache cache;
        const auto built = buildScene(scene, cache);
        return built ? std::string() : toString(built.errors().front());
    };
    EXPECT_EQ(errorOf(spec), "");
    spec.contact.rotational_stiffness = 0.8;
    EXPECT_NE(errorOf(spec).find("part cube: density: the weight would turn the part by 1.1 rad"), std::string::npos);
    spec.effects.weight = {};
    EXPECT_EQ(errorOf(spec), "");
    spec.parts[1].geometry = shape::Sheet{0.1, 0.1};
    EXPECT_EQ(errorOf(spec), "");
    spec.parts[1].density = 1.0;
    EXPECT_NE(errorOf(spec).find("part plate: density: a sheet encloses no volume"), std::string::npos);
    spec.parts[1].density = -1.0;
    EXPECT_NE(errorOf(spec).find("must be ≥ 0"), std::string::npos);
}

}  // namespace
}  // namespace passung::scene
