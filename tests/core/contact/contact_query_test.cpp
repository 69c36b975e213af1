#include "core/contact/contact_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/scene/part.h"
#include "core/tick/penalty.h"

namespace passung {
namespace {

scene::Part build(const shape::Shape& shape, double spacing = 1e-3) {
    scene::PartSpec spec;
    spec.geometry = shape;
    auto part = scene::buildPart(spec, {.field = true, .shell = true, .cell = 0.7e-3, .spacing = spacing});
    EXPECT_TRUE(part);
    return std::move(*part);
}

Pose somewhere(double reach, Random& random) {
    return {rotationFromVector(Vec3(random.normal(), random.normal(), random.normal())),
            Vec3(random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach))};
}

/// A peg of 20 mm about to enter, in or anywhere near a bore with 0.2 mm of radial clearance.
Pose pegInPlate(int i, Random& random) {
    if (i % 4 != 0) return somewhere(0.04, random);
    return {rotationFromVector(1e-3 * Vec3(random.normal(), random.normal(), 0)),
            Vec3(random.uniform(-2e-4, 2e-4), random.uniform(-2e-4, 2e-4), -0.01)};
}

const shape::Shape kPlate = shape::BorePlate{0.05, 0.05, 0.02, 0.0204, 0.02, 0.001};
const shape::Shape kPeg = shape::Peg{0.02, 0.04, 0.001};

struct BruteForce {
    double phi = 1e300;
    std::size_t inside = 0;
};

/// Every point of the shell through the same field, without the tree.
BruteForce bruteForce(const scene::Part& field, const Pose& X_WF, const scene::Part& shell, const Pose& X_WS) {
    BruteForce result;
    for (const auto& point : shell.shell->points()) {
        const Vec3 p = X_WF.inverse() * (X_WS * point.position);
        const double phi = field.field->sample(p, field::FieldMode::Trilinear).phi;
        result.phi = std::min(result.phi, phi);
        result.inside += phi < 0.0 ? 1 : 0;
    }
    return result;
}

TEST(ContactQuery, FindsExactlyWhatTestingEveryPointFinds) {
    // Truth: invariant. The tree prunes only what is proven to be out of reach.
    const scene::Part plate = build(kPlate), peg = build(kPeg);
    contact::QueryWorkspace workspace(peg.shell->nodes().size());
    contact::ContactManifold manifold(peg.shell->points().size());
    Random random(1);
    int touching = 0;
    for (int i = 0; i < 500; ++i) {
        const Pose X_WF = somewhere(0.2, random);
        const Pose X_WS = X_WF * pegInPlate(i, random);
        manifold.clear();
        contact::QueryRequest request;
        request.search_below = 1.0;
        const auto answer = contact::queryContacts(*plate.field, X_WF, *peg.shell, X_WS, request, workspace, manifold);
        const BruteForce truth = bruteForce(plate, X_WF, peg, X_WS);
        ASSERT_NEAR(answer.phi, truth.phi, 1e-12);
        ASSERT_EQ(manifold.size(), truth.inside);
        ASSERT_EQ(answer.quality, 1.0);
        touching += truth.inside > 0 ? 1 : 0;
        if (truth.inside > 0) continue;
        ASSERT_LT(answer.points_tested, static_cast<int>(peg.shell->points().size()));
    }
    EXPECT_GT(touching, 100);
    EXPECT_LT(touching, 450);
}

TEST(ContactQuery, ManifoldHoldsEveryPointThatIsTrulyNearOnceAndNoneThatIsFar) {
    // Truth: closed form of the plate. φ is read with an error of at most e(p), so what is truly below the limit by
    // more than e must be there, and what is truly above it by more than e must not.
    const scene::Part plate = build(kPlate), peg = build(kPeg);
    const auto points = peg.shell->points();
    const double limit = 0.3e-3;
    contact::QueryWorkspace workspace(peg.shell->nodes().size());
    contact::ContactManifold manifold(points.size());
    const auto keyOf = [](const Vec3& p) {  // points lie tenths of a millimetre apart, poses round to far below a nm
        return std::array{std::llround(p.x() * 1e9), std::llround(p.y() * 1e9), std::llround(p.z() * 1e9)};
    };
    Random random(2);
    int certain = 0, excluded = 0;
    for (int i = 0; i < 200; ++i) {
        const Pose X_FS = pegInPlate(i, random);
        manifold.clear();
        contact::queryContacts(*plate.field, Pose{}, *peg.shell, X_FS, {.collect_below = limit, .search_below = limit},
                               workspace, manifold);
        std::map<std::array<long long, 3>, int> times;
        for (const auto& contact : manifold) ++times[keyOf(contact.position)];
        for (const auto& point : points) {
            const Vec3 p = X_FS * point.position;
            const double truth = shape::signedDistance(kPlate, p);
            const double error = plate.field->errorBound(p, field::FieldMode::Trilinear);
            const auto found = times.find(keyOf(p));
            const int count = found == times.end() ? 0 : found->second;
            ASSERT_LE(count, 1) << "pose " << i << ", point " << point.position.transpose();
            if (truth < limit - error) {
                ASSERT_EQ(count, 1) << "pose " << i << ", point " << point.position.transpose() << " φ " << truth;
                ++certain;
            } else if (truth > limit + error) {
                ASSERT_EQ(count, 0) << "pose " << i << ", point " << point.position.transpose() << " φ " << truth;
                ++excluded;
            }
        }
        ASSERT_LE(times.size(), points.size());
    }
    EXPECT_GT(certain, 10000);
    EXPECT_GT(excluded, 10000);
}

TEST(ContactQuery, InEveryModeMissesNothingThatIsDeeperThanTheModesError) {
    // Truth: closed form. Pruning asks for true distances, whatever the mode reads; contacts are off by the mode's
    // bound at most, layered ones too, which take the peg's own normals.
    const scene::Part plate = build(kPlate), peg = build(kPeg);
    contact::QueryWorkspace workspace(peg.shell->nodes().size());
    contact::ContactManifold manifold(peg.shell->points().size());
    const field::DistanceField& field = *plate.field;
    Random random(6);
    for (const field::FieldMode mode : field::kFieldModes) {
        std::size_t deep = 0;
        for (int i = 0; i < 60; ++i) {
            const Pose X_FS = pegInPlate(i, random);
            manifold.clear();
            const contact::QueryRequest request{.search_below = 1.0, .mode = mode, .prove = true};
            const auto answer = contact::queryContacts(field, Pose{}, *peg.shell, X_FS, request, workspace, manifold);
            double least = 1e300;
            std::size_t must = 0;
            for (const auto& point : peg.shell->points()) {
                const Vec3 p = X_FS * point.position;
                const double truth = signedDistance(kPlate, p);
                least = std::min(least, truth);
                if (truth < -field.errorBound(p, mode)) ++must;
            }
            deep += must;
            ASSERT_TRUE(answer.found);
            ASSERT_LE(std::min(answer.lower_bound, answer.phi), least) << modeName(mode);
            ASSERT_LE(least, answer.phi + field.errorBound(answer.closest_F, mode)) << modeName(mode);
            ASSERT_GE(manifold.size(), must) << modeName(mode);
            for (const contact::ContactPoint& contact : manifold)
                ASSERT_NEAR(contact.phi, signedDistance(kPlate, contact.position),
                            field.errorBound(contact.position, mode) + 1e-12)
                    << modeName(mode);
        }
        EXPECT_GT(deep, 1000u);
    }
}

TEST(ContactQuery, LayeredContactsTakeTheNormalOfThePointThatAsks) {
    // Truth: closed form: a flat tip in a flat face reads every depth within half a cell; with any other normal the
    // way from the voxel's centre would be lost, another half of it.
    const scene::Part block = build(shape::Box{0.05, 0.05, 0.02}), peg = build(shape::Peg{0.02, 0.04, 0.0});
    contact::QueryWorkspace workspace(peg.shell->nodes().size());
    contact::ContactManifold manifold(peg.shell->points().size());
    for (const double depth : {0.1e-3, 0.5e-3, 0.9e-3}) {
        manifold.clear();
        const Pose X_FS{Quat::Identity(), Vec3(0.0, 0.0, 0.01 - depth)};
        const contact::QueryRequest request{.mode = field::FieldMode::Layered};
        contact::queryContacts(*block.field, Pose{}, *peg.shell, X_FS, request, workspace, manifold);
        std::size_t of_the_tip = 0;
        for (const contact::ContactPoint& contact : manifold) {
            if (contact.normal.z() > -0.99) continue;
            ++of_the_tip;
            ASSERT_NEAR(contact.phi, -depth, 0.5 * block.field->cell() + 1e-7);
            ASSERT_NEAR(contact.gradient.z(), 1.0, 1e-9);
        }
        EXPECT_GT(of_the_tip, 100u);
    }
}

TEST(ContactQuery, ABudgetKeepsTheWeightOfAPlatePressedFlatAndSaysWhatItDidNotProve) {
    // Truth: closed form. A plate of 20 mm lies 1 mm deep on a table: F = κ A h, and its sides cancel. The lower face
    // is flat and equally deep, so a node that stands in with its point and the area below gives what its points would
    // give; 1 % is for nodes that join points of the lower face and samples of its rim. From 72 nodes on, eight roots
    // and their children, no node that stands in joins faces that face apart.
    const scene::Part table = build(shape::Box{0.06, 0.06, 0.02});
    const scene::Part plate = build(shape::Box{0.02, 0.02, 0.008}, 0.5e-3);
    const double h = 1e-3, kappa = 1e9;
    const Pose X_WS{Quat::Identity(), Vec3(0.003, -0.002, 0.01 + 0.004 - h)};
    scene::ContactSpec contact;
    contact.variant = scene::PenaltyVariant::AreaWeighted;
    contact.area_stiffness = kappa;
    contact::QueryWorkspace workspace(plate.shell->nodes().size());
    contact::ContactManifold manifold(plate.shell->nodes().size() + plate.shell->points().size());
    const double truth = kappa * 0.02 * 0.02 * h;
    double last_quality = 1.1;
    for (const int budget : {0, 110, 100, 90, 80}) {
        manifold.clear();
        const auto answer = contact::queryContacts(*table.field, Pose{}, *plate.shell, X_WS,
                                                   {.search_below = 1.0, .max_nodes = budget}, workspace, manifold);
        const Wrench wrench = tick::penaltyWrench(contact, manifold, X_WS.p);
        EXPECT_EQ(answer.budget_reached, budget > 0) << budget;
        if (budget > 0) {
            EXPECT_LE(answer.nodes_visited, budget);
        }
        EXPECT_NEAR(wrench.force.z(), truth, 0.01 * truth) << budget;
        EXPECT_NEAR(answer.phi, -h, 1e-7) << budget << ": the field is exact on a plane up to its stored numbers";
        EXPECT_LE(answer.quality, last_quality) << budget;
        last_quality = answer.quality;
        if (budget == 0) {
            EXPECT_LT(wrench.force.head<2>().norm(), 0.01 * truth);
            EXPECT_EQ(answer.quality, 1.0);
        }
    }
    EXPECT_LT(last_quality, 1.0);
}

TEST(ContactQuery, ALeastQualityWinsOverTheBudget) {
    // Truth: invariant. What is asked for is reached, with no more nodes than a higher quality takes, and all of it is
    // a query without a budget.
    const scene::Part table = build(shape::Box{0.06, 0.06, 0.02});
    const scene::Part ring = build(shape::Torus{0.02, 0.006}, 0.5e-3);
    contact::QueryWorkspace workspace(ring.shell->nodes().size());
    contact::ContactManifold manifold(ring.shell->nodes().size() + ring.shell->points().size());
    Random random(8);
    int left_out = 0;
    for (int run = 0; run < 40; ++run) {
        const Pose X_WS{rotationFromVector(0.4 * Vec3(random.normal(), random.normal(), random.normal())),
                        Vec3(0.01 * random.normal(), 0.01 * random.normal(), 0.011)};
        const auto ask = [&](int budget, double quality) {
            manifold.clear();
            return contact::queryContacts(*table.field, Pose{}, *ring.shell, X_WS,
                                          {.search_below = 1.0, .max_nodes = budget, .quality = quality}, workspace,
                                          manifold);
        };
        const auto all = ask(0, 0.0), alone = ask(60, 0.0);
        int nodes = alone.nodes_visited;
        for (const double quality : {0.2, 0.5, 0.8, 0.95, 1.0}) {
            const auto answer = ask(60, quality);
            EXPECT_GE(answer.quality, quality - 1e-12);
            EXPECT_GE(answer.nodes_visited, nodes);
            nodes = answer.nodes_visited;
            left_out += answer.budget_reached && quality > alone.quality ? 1 : 0;
        }
        const auto whole = ask(60, 1.0);
        EXPECT_FALSE(whole.budget_reached);
        EXPECT_EQ(whole.phi, all.phi);
        EXPECT_EQ(whole.contacts, all.contacts);
        EXPECT_EQ(whole.quality, 1.0);
    }
    EXPECT_GT(left_out, 20) << "floors between what the budget reaches and all";
}

/// The least φ of `obstacle` over a ball, by its closed form on a net of directions that is made finer around the best.
double deepestOfBall(const shape::Shape& obstacle, const Vec3& centre, double radius) {
    double least = 1e300;
    Vec3 best = Vec3::UnitZ();
    const auto look = [&](const Vec3& direction) {
        const double phi = shape::signedDistance(obstacle, centre + radius * direction.normalized());
        if (!(phi < least)) return;
        least = phi;
        best = direction.normalized();
    };
    Random random(5);
    const auto turned = [&](double width) {
        return Vec3(width * random.normal(), width * random.normal(), width * random.normal());
    };
    for (int i = 0; i < 20'000; ++i) look(turned(1.0));
    for (double width = 0.02; width > 1e-6; width *= 0.8)
        for (int i = 0; i < 200; ++i) look(best + turned(width));
    return least;
}

TEST(ContactQuery, RefiningFindsTheDeepestPointBetweenSamplesOnRidgesToo) {
    // Truth: closed forms of both. A ball in the edge of a box is deepest where two faces are equally near, on a ridge.
    // The field keeps its tolerance there, the ball's triangles lie up to the chord error inside; 5 µm more is a
    // hundredth of how far samples lie apart. Without refining some pose is off by more than 50 µm.
    const shape::Shape box = shape::Box{0.03, 0.03, 0.03};
    scene::PartSpec spec;
    spec.geometry = box;
    const double tolerance = 10e-6, deepest = 1.5e-3;
    const auto obstacle = scene::buildPart(spec, {.field = true, .tolerance = tolerance, .depth = deepest});
    ASSERT_TRUE(obstacle);
    const field::DistanceField& field = *obstacle->field;
    const scene::Part ball = build(shape::Sphere{0.016}, 0.5e-3);
    contact::QueryWorkspace workspace(ball.shell->nodes().size());
    contact::ContactManifold manifold(ball.shell->points().size());
    Random random(6);
    double worst_without = 0.0;
    int pressed = 0;
    for (int i = 0; i < 80; ++i) {
        Pose X = somewhere(0.0, random);
        X.p = Vec3(0.015 + random.uniform(0.003, 0.0065), 0.015 + random.uniform(0.0, 0.004),
                   random.uniform(-0.005, 0.005));
        const double truth = deepestOfBall(box, X.p, 0.008);
        if (!(truth < -0.1e-3 && truth > -deepest)) continue;
        manifold.clear();
        const auto plain =
            contact::queryContacts(field, Pose{}, *ball.shell, X, {.gradients = false}, workspace, manifold);
        manifold.clear();
        const auto refined = contact::queryContacts(field, Pose{}, *ball.shell, X, {.gradients = false, .refine = true},
                                                    workspace, manifold);
        worst_without = std::max(worst_without, plain.phi - truth);
        EXPECT_LE(refined.phi, plain.phi);
        EXPECT_NEAR(refined.phi, truth, tolerance + ball.chord_error + 5e-6) << i;
        EXPECT_EQ(refined.phi, field.sample(refined.closest_F, field::FieldMode::Trilinear).phi);
        EXPECT_NEAR((X.inverse() * refined.closest_W).norm(), 0.008, ball.chord_error + 1e-7) << "on the ball";
        ++pressed;
    }
    EXPECT_GT(pressed, 20);
    EXPECT_GT(worst_without, 50e-6);
}

TEST(ContactQuery, GroupsWeighWhatTheirPointsWeighWhetherTheContactIsSmallOrLarge) {
    // Truth: closed form of the cap that a ball of radius R leaves in a plane, V = π h² (3 R - h) / 3, F = κ V; as near
    // as the sum over all points comes, which is 1 % here. Invariant: of a large contact fewer points are read.
    const scene::Part table = build(shape::Box{0.08, 0.08, 0.02});
    const double R = 0.015, kappa = 1e9;
    const scene::Part ball = build(shape::Sphere{2.0 * R}, 0.4e-3);
    scene::ContactSpec contact;
    contact.variant = scene::PenaltyVariant::AreaWeighted;
    contact.area_stiffness = kappa;
    contact::QueryWorkspace workspace(ball.shell->nodes().size());
    contact::ContactManifold manifold(ball.shell->points().size());
    Random random(7);
    for (const double h : {0.3e-3, 1e-3, 2e-3, 4e-3}) {
        for (int i = 0; i < 10; ++i) {
            Pose X = somewhere(0.0, random);
            X.p = Vec3(random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), 0.01 + R - h);
            manifold.clear();
            const auto points =
                contact::queryContacts(*table.field, Pose{}, *ball.shell, X, {.gradients = false}, workspace, manifold);
            const std::size_t many = manifold.size();
            ASSERT_EQ(points.contacts, static_cast<int>(many));
            const Wrench pointwise = tick::penaltyWrench(contact, manifold, X.p);
            manifold.clear();
            const auto groups =
                contact::queryContacts(*table.field, Pose{}, *ball.shell, X, {.load = true}, workspace, manifold);
            ASSERT_EQ(manifold.size(), 0u);
            const Wrench wrench = tick::weightedWrench(contact, groups.load);
            const double truth = kappa * std::numbers::pi * h * h * (3.0 * R - h) / 3.0;
            EXPECT_NEAR(wrench.force.z(), truth, 0.01 * truth) << h;
            EXPECT_LT(wrench.force.head<2>().norm(), 0.01 * truth) << h;
            EXPECT_LT(wrench.torque.norm(), 0.01 * truth * R) << h;
            // A group that is taken whole counts all its points, of which some may just be outside.
            EXPECT_NEAR(groups.contacts, points.contacts, 0.05 * points.contacts + 4.0) << h;
            EXPECT_NEAR(groups.phi, points.phi, 0.1e-3) << h;
            if (h > 3e-3) {
                EXPECT_LT(groups.points_tested, points.points_tested * 3 / 4);
            }
            if (h < 0.5e-3) {
                EXPECT_LT((wrench.force - pointwise.force).norm(), 1e-6 * truth)
                    << "a small contact is looked at point by point";
            }
        }
    }
}

}  // namespace
}  // namespace passung
