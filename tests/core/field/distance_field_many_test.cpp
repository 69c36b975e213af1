#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/scene/part.h"

namespace passung::field {
namespace {

struct Points {
    std::vector<float> x, y, z;

    void add(const Vec3& p) {
        x.push_back(static_cast<float>(p.x()));
        y.push_back(static_cast<float>(p.y()));
        z.push_back(static_cast<float>(p.z()));
    }
    Vec3 at(std::size_t i) const {
        return {static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i])};
    }
};

const Pose kPose{rotationFromVector({0.3, -0.5, 0.7}), Vec3(0.01, 0.02, -0.03)};

/// Points around the part, most of them near it, some off its grid and some that are no points.
Points someAround(const DistanceField& field) {
    Random random(7);
    Points points;
    const Pose X_SF = kPose.inverse();
    for (int i = 0; i < 20'011; ++i) {  // not a multiple of any block
        const double margin = i % 7 == 0 ? 0.5 : 0.002;
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = random.uniform(field.bounds().low[axis] - margin, field.bounds().high[axis] + margin);
        points.add(X_SF * p);
    }
    points.x[100] = std::numeric_limits<float>::quiet_NaN();
    points.y[200] = std::numeric_limits<float>::infinity();
    return points;
}

std::vector<DistanceField> someFields() {
    std::vector<DistanceField> fields;
    const auto add = [&](const shape::Shape& shape, const scene::PartNeeds& needs) {
        scene::PartSpec spec;
        spec.geometry = shape;
        auto part = scene::buildPart(spec, needs);
        EXPECT_TRUE(part);
        fields.push_back(*part->field);
    };
    add(shape::Sphere{0.03}, {.field = true, .cell = 0.7e-3});
    add(shape::BorePlate{0.06, 0.06, 0.03, 0.0202, 0.025, 0.001}, {.field = true, .tolerance = 20e-6});
    add(shape::Sheet{0.05, 0.03}, {.field = true, .tolerance = 50e-6});
    return fields;
}

TEST(SampleMany, IsTheSampleOfEachPointWithinSinglePrecision) {
    // Truth: invariant (sample() of each point; the bound stated in the header, and a float's own rounding).
    for (const DistanceField& field : someFields()) {
        const Points points = someAround(field);
        std::vector<float> phi(points.x.size());
        field.sampleMany(field.place(kPose), points.x, points.y, points.z, phi);
        const double span = 2.0 * std::sqrt(3.0) * DistanceField::kBrickCells * 0.06 / 32.0;  // of the largest brick
        for (std::size_t i = 0; i < phi.size(); ++i) {
            const double one = field.sample(kPose * points.at(i), FieldMode::Trilinear).phi;
            if (std::isnan(one)) {
                EXPECT_TRUE(std::isnan(phi[i]));
                continue;
            }
            if (std::isinf(one)) {
                EXPECT_EQ(static_cast<double>(phi[i]), one);
                continue;
            }
            ASSERT_NEAR(static_cast<double>(phi[i]), one, 0x1p-20 * span + 0x1p-24 * std::abs(one)) << i;
        }
    }
}

TEST(SampleMany, GivesTheSameBitsWithAllInstructionsAndInAnyGrouping) {
    // Truth: invariant.
    for (const DistanceField& field : someFields()) {
        const Points points = someAround(field);
        const std::size_t count = points.x.size();
        std::vector<float> baseline(count);
        field.sampleMany(field.place(kPose), points.x, points.y, points.z, baseline, Instructions::Baseline);
        for (const Instructions instructions : {Instructions::V3, Instructions::V4}) {
            if (instructions > bestInstructions()) continue;
            std::vector<float> phi(count);
            field.sampleMany(field.place(kPose), points.x, points.y, points.z, phi, instructions);
            EXPECT_EQ(std::memcmp(phi.data(), baseline.data(), count * sizeof(float)), 0)
                << static_cast<int>(instructions);
        }
        for (std::size_t i = 0; i < count; i += 97) {
            float phi = 0.0f;
            field.sampleMany(field.place(kPose), {&points.x[i], 1}, {&points.y[i], 1}, {&points.z[i], 1}, {&phi, 1});
            EXPECT_EQ(std::memcmp(&phi, &baseline[i], sizeof(float)), 0) << i;
        }
    }
}

TEST(ReadChange, HoldsOnEveryWayBesideTheSurface) {
    // Truth: invariant, by pairs of points: along faces, across rims, from bricks to the coarse cells and back.
    scene::PartSpec spec;
    spec.geometry = shape::BorePlate{0.06, 0.06, 0.03, 0.0202, 0.025, 0.001};
    const auto part = scene::buildPart(spec, {.field = true, .cell = 0.5e-3});
    ASSERT_TRUE(part);
    const DistanceField& field = *part->field;
    const ReadChange& change = field.change();
    ASSERT_GT(change.within, 0.5e-3);  // bricks reach two cells at least
    Random random(11);
    const auto vector = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
    Points from, to;
    for (int i = 0; i < 400'000; ++i) {
        const double angle = random.uniform(-3.2, 3.2), r = 0.0101 + 0.002 * random.normal();
        const Vec3 in_bore(r * std::cos(angle), r * std::sin(angle), random.uniform(-0.028, 0.002));
        const Vec3 anywhere(random.uniform(-0.035, 0.035), random.uniform(-0.035, 0.035),
                            random.uniform(-0.035, 0.005));
        const Vec3 p = i % 3 == 0 ? anywhere : in_bore;
        from.add(p);
        to.add(p + std::pow(10.0, random.uniform(-6.0, -3.0)) * vector().normalized());
    }
    std::vector<float> before(from.x.size()), after(from.x.size());
    const DistanceField::Placement still = field.place({});
    field.sampleMany(still, from.x, from.y, from.z, before);
    field.sampleMany(still, to.x, to.y, to.z, after);
    int told = 0;
    double nearest = 1.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const double way = (to.at(i) - from.at(i)).norm(), value = static_cast<double>(before[i]);
        const double least = change.leastAround(value, way), most = change.mostAround(value, way);
        if (least >= 0.0) {
            ++told;
            ASSERT_GE(static_cast<double>(after[i]), least) << from.at(i).transpose() << " to " << to.at(i).transpose();
            nearest = std::min(nearest, (static_cast<double>(after[i]) - least) / way);
        }
        if (value > 0.0 && std::isfinite(most)) {
            ASSERT_LE(static_cast<double>(after[i]), most);
        }
    }
    EXPECT_GT(told, 50'000);
    EXPECT_LT(nearest, 1.0) << "the bound is not idle: the steepest way found uses so much less than it allows";
}

TEST(ReadChange, IsUnknownInCellsOfSeveralSizesAndInHoles) {
    // Truth: the contract in the header.
    for (const DistanceField& field : someFields())
        if (field.finestCell() < field.cell() || field.sheetOffset() > 0.0) {
            EXPECT_EQ(field.change().within, 0.0);
        }
    EXPECT_EQ(ReadChange{}.leastAround(1.0, 0.0), 0.0);
}

TEST(LowerBounds, AreNeverAboveTheDistanceAndHardlyBelowTheOneOfEachPoint) {
    // Truth: closed form; lowerBound() of each point.
    std::vector<shape::Shape> shapes{shape::Sphere{0.03}, shape::BorePlate{0.06, 0.06, 0.03, 0.0202, 0.025, 0.001},
                                     shape::Sheet{0.05, 0.03}};
    std::size_t k = 0;
    for (const DistanceField& field : someFields()) {
        const shape::Shape& shape = shapes[k++];
        const Points points = someAround(field);
        const std::size_t count = points.x.size();
        std::vector<float> bound(count), other(count);
        field.lowerBounds(field.place(kPose), points.x, points.y, points.z, bound, Instructions::Baseline);
        double loosest = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 p = kPose * points.at(i);
            if (!p.allFinite()) continue;
            const double value = static_cast<double>(bound[i]);
            ASSERT_LE(value, shape::signedDistance(shape, p) + 1e-12) << shape::kindName(shape) << " " << i;
            ASSERT_LE(value, field.lowerBound(p) + 1e-12) << i;
            loosest = std::max(loosest, field.lowerBound(p) - value);
        }
        EXPECT_LT(loosest, 2e-6) << shape::kindName(shape);  // 2⁻¹⁸ of the largest distance, half a metre
        for (const Instructions instructions : {Instructions::V3, Instructions::V4}) {
            if (instructions > bestInstructions()) continue;
            field.lowerBounds(field.place(kPose), points.x, points.y, points.z, other, instructions);
            EXPECT_EQ(std::memcmp(other.data(), bound.data(), count * sizeof(float)), 0);
        }
    }
}

}  // namespace
}  // namespace passung::field
