#include "core/closed_form/circle_samples.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace passung::closed_form {
namespace {

Vec3 randomVector(Random& random, double size) {
    return size * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
}

Curve randomCircle(Random& random) {
    Curve circle;
    circle.kind = Curve::Kind::Circle;
    circle.centre = randomVector(random, 0.02);
    const Vec3 n = randomVector(random, 1.0).normalized();
    circle.e1 = 0.01 * n.cross(randomVector(random, 1.0)).normalized();
    circle.e2 = n.cross(circle.e1);
    circle.end = std::acos(-1.0);
    return circle;
}

/// Three faces, among them each kind that is told at once.
std::vector<Face> randomFaces(Random& random) {
    const auto axis = [&] { return randomVector(random, 1.0).normalized(); };
    const bool hollow = random.uniform() < 0.5;
    return {plane(randomVector(random, 0.02), axis()),
            cylinder(randomVector(random, 0.02), axis(), 0.01 * random.uniform(), hollow),
            cone(randomVector(random, 0.02), axis(), 0.01 * random.uniform(), random.uniform(), hollow)};
}

std::vector<const Face*> addresses(const std::vector<Face>& faces) {
    std::vector<const Face*> list;
    for (const Face& face : faces) list.push_back(&face);
    return list;
}

TEST(CircleSamples, HaveTheBitsOfOneFaceAndPlaceAtATimeWithAllInstructions) {
    // Truth: the functions of a face themselves, one sample after the other. Instructions that this machine lacks are
    // left out.
    Random random(8);
    int faces_seen[3] = {0, 0, 0};
    for (int round = 0; round < 2000; ++round) {
        const Curve circle = randomCircle(random);
        const std::vector<Face> faces = randomFaces(random);
        const auto list = addresses(faces);
        for (const auto instructions :
             {field::Instructions::Baseline, field::Instructions::V3, field::Instructions::V4}) {
            if (instructions > field::bestInstructions()) continue;
            CircleSamples all;
            ASSERT_TRUE(all.take(circle, list, instructions));
            for (std::size_t i = 0; i <= CircleSamples::kPieces; ++i) {
                const double t = CircleSamples::parameter(i);
                const Vec3 p = circle.centre + std::cos(t) * circle.e1 + std::sin(t) * circle.e2;
                const Vec3 way = std::cos(t) * circle.e2 - std::sin(t) * circle.e1;
                std::size_t highest = 0;
                for (std::size_t k = 1; k < faces.size(); ++k)
                    if (valueOf(faces[k], p) > valueOf(faces[highest], p)) highest = k;
                ++faces_seen[highest];
                EXPECT_EQ(all.point(i), p);
                EXPECT_EQ(all.way(i), way);
                EXPECT_EQ(all.face[i], static_cast<std::int64_t>(highest));
                EXPECT_EQ(std::bit_cast<std::uint64_t>(all.value[i]),
                          std::bit_cast<std::uint64_t>(valueOf(faces[highest], p)));
                EXPECT_EQ(std::bit_cast<std::uint64_t>(all.slope[i]),
                          std::bit_cast<std::uint64_t>(gradientOf(faces[highest], p).dot(way)));
            }
        }
        if (testing::Test::HasFailure()) FAIL() << "round " << round;
    }
    for (const int seen : faces_seen) EXPECT_GT(seen, 1000);
}

TEST(CircleSamples, AreNotToldOfOtherFacesAndOnAnAxis) {
    // Truth: the contract.
    Random random(8);
    const Curve circle = randomCircle(random);
    CircleSamples all;
    const Face ball = sphere(Vec3::Zero(), 0.01);
    EXPECT_FALSE(all.take(circle, std::vector<const Face*>{&ball}));
    Curve level = circle;
    level.centre = Vec3(0.01, 0, 0);
    level.e1 = Vec3(0.01, 0, 0);
    level.e2 = Vec3(0, 0.01, 0);
    const Face about_z = cylinder(Vec3::Zero(), Vec3::UnitZ(), 0.01);
    EXPECT_FALSE(all.take(level, std::vector<const Face*>{&about_z})) << "its first sample is on the axis";
    EXPECT_TRUE(all.take(circle, std::vector<const Face*>{&about_z}));
}

}  // namespace
}  // namespace passung::closed_form
