#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "analysis/truth/exact_overlap.h"
#include "core/base/random.h"
#include "tests/core/tick/wander.h"
#include "tests/support/length.h"
#include "tests/support/off_file.h"
#include "tests/support/scenes.h"
#include "tests/support/surface_cases.h"

// God objects under a budget of nodes against the same without one, along hands' paths that end in a second of rest.

namespace passung {
namespace {

using scene::ContactMethod;

constexpr std::array kGods{ContactMethod::GodObject, ContactMethod::GodObjectHeuristic};
constexpr std::array kBudgets{300, 1000, 100, 5000};

/// PASSUNG_LONG=1: all, else two.
std::span<const int> budgets() { return std::span(kBudgets).first(test::atFullLength() ? kBudgets.size() : 2); }

constexpr double kStiffness = 2000.0;  // [N/m]
constexpr double kMoves = 2.0;         // [s]; then the hand rests
constexpr double kRests = 1.0;         // [s]
constexpr double kFactor = 1.25;       // of the unlimited force
constexpr double kSlack = 0.05;        // [N]
constexpr double kAtRest = 0.01;       // of the unlimited force
constexpr double kOverlap = 2e-6;      // beyond the unlimited proxy's, or the tolerance [m]
// At 90 mm/s, eight looks (cuts and halvings of a step, god_object.h) of three ticks each [m].
constexpr double kMostLag = 2e-3;
constexpr std::size_t kEvery = 50;  // ticks of which one's overlap is measured

/// Parts, and where a hand leads the held one.
struct Case {
    std::string name;
    scene::SceneSpec spec;
    Vec3 middle, amplitude, tilt;  // of the way [m], [rad]
};

Case caseOf(std::string name, scene::PartSpec held, const scene::PartSpec& fixed, const Vec3& middle,
            const Vec3& amplitude, const Vec3& tilt) {
    Case c{std::move(name), {}, middle, amplitude, tilt};
    held.held = true;
    c.spec.parts = {std::move(held), fixed};
    c.spec.contact.geometry = scene::Geometry::Field;
    c.spec.contact.stiffness = kStiffness;
    c.spec.limits.max_force = 1e4;
    c.spec.limits.max_torque = 1e4;
    c.spec.limits.max_force_rate = 1e12;
    return c;
}

scene::PartSpec partOf(const std::string& name, const shape::Shape& shape, const Vec3& p) {
    scene::PartSpec part;
    part.name = name;
    part.geometry = shape;
    part.X_WP.p = p;
    return part;
}

scene::PartSpec partOf(const std::string& name, const geometry::TriangleMesh& mesh, const Vec3& p) {
    const std::string path = testing::TempDir() + "node_budget_" + name + ".off";
    test::writeOff(path, mesh);
    scene::PartSpec part;
    part.name = name;
    part.geometry = scene::MeshFile{path, 1.0};
    part.X_WP.p = p;
    return part;
}

/// A peg of 20 mm in a bore with 100 um of radial play, pressed aside and tilted.
Case pegInBore() {
    return caseOf("peg", partOf("peg", shape::Peg{.02, .03, 5e-4}, {0, 0, .002}),
                  partOf("bore", shape::BorePlate{.06, .06, .03, .0202, .025, 5e-4}, Vec3::Zero()), {0, 0, -.014},
                  {.001, .001, .004}, {.02, .02, .2});
}

/// A box pressed onto a plate, with its faces, edges and corners.
Case boxOnPlate() {
    return caseOf("box", partOf("box", shape::Box{.02, .03, .01}, {0, 0, .008}),
                  partOf("plate", shape::Box{.08, .08, .01}, {0, 0, -.005}), {.01, 0, .004}, {.015, .015, .0015},
                  {.1, .1, .4});
}

/// A toothed wheel in the inner corner of an L, both of triangles.
Case wheelInCorner() {
    const test::Profile2 line{{-.01, -.01}, {.03, -.01}, {.03, .01}, {.01, .01}, {.01, .03}, {-.01, .03}};
    return caseOf(
        "wheel",
        partOf("wheel", test::solidMesh(test::gearLine(.006, .001, 12, 0.0), {0, 0}, -.004, .004), {.022, .022, 0}),
        partOf("corner", test::solidMesh(line, {0, 0}, -.02, .02), Vec3::Zero()), {.0155, .0155, .001},
        {.002, .002, .004}, {.1, .1, .5});
}

/// From the held part's start to where it wanders within half a second, at 50 to 90 mm/s; at rest from kMoves on.
std::vector<Pose> pathOf(const Case& c) {
    Random random(5);
    std::vector<test::Wander> wander;
    wander.reserve(6);
    for (int i = 0; i < 6; ++i) wander.emplace_back(random, 1.5, 0.5);
    const Vec3 start = c.spec.parts[0].X_WP.p;
    const auto ticks = static_cast<std::size_t>((kMoves + kRests) / kTickSeconds);
    std::vector<Pose> path;
    path.reserve(ticks);
    for (std::size_t i = 0; i < ticks; ++i) {
        const double t = std::min(static_cast<double>(i) * kTickSeconds, kMoves);
        const double s = std::clamp(t / 0.5, 0.0, 1.0), in = s * s * (3.0 - 2.0 * s);
        Vec3 p = start + in * (c.middle - start), turn;
        for (int k = 0; k < 3; ++k) {
            p[k] += c.amplitude[k] * wander[static_cast<std::size_t>(k)].at(t);
            turn[k] = c.tilt[k] * wander[static_cast<std::size_t>(k) + 3].at(t);
        }
        path.push_back({rotationFromVector(turn), p});
    }
    return path;
}

struct Shown {
    Pose proxy;
    Vec3 spring;  // on the hand [N]
    double lag;   // recorded [m]
};

std::vector<Shown> follow(const Case& c, ContactMethod method, int budget) {
    scene::SceneSpec spec = c.spec;
    spec.contact.method = method;
    spec.contact.budget_nodes = budget;
    spec.record_hand_depth = false;
    test::Bench bench(spec);
    std::vector<Shown> shown;
    for (const Pose& hand : pathOf(c)) {
        const tick::TickOutput out = bench.step(hand);
        shown.push_back({out.X_WG, kStiffness * (out.X_WG.p - hand.p), out.frame.proxy_lag});
    }
    return shown;
}

double deepest(const Case& c, const std::vector<Shown>& shown) {
    static truth::OverlapBodies bodies;
    static scene::PartCache cache;
    const auto scene = scene::buildScene(c.spec, cache);
    const truth::SceneOverlap overlap(*scene, bodies);
    double most = 0.0;
    for (std::size_t i = 0; i < shown.size(); i += kEvery) most = std::max(most, overlap.at(shown[i].proxy).depth);
    return most;
}

void checkAgainstUnlimited(const Case& c) {
    for (const ContactMethod method : kGods) {
        const std::vector<Shown> unlimited = follow(c, method, 0);
        const double force = unlimited.back().spring.norm();
        ASSERT_GT(force, 0.5) << "the path does not end in contact";
        const double least_overlap = std::max(deepest(c, unlimited), c.spec.contact.tolerance);
        for (const int budget : budgets()) {
            const std::vector<Shown> shown = follow(c, method, budget);
            for (std::size_t i = 0; i < shown.size(); ++i) {
                ASSERT_LE(shown[i].spring.norm(),
                          kFactor * unlimited[i].spring.norm() + kStiffness * shown[i].lag + kSlack)
                    << c.name << " budget " << budget << " tick " << i;
                ASSERT_LE(shown[i].lag, kMostLag) << c.name << " budget " << budget << " tick " << i;
            }
            EXPECT_LE((shown.back().spring - unlimited.back().spring).norm(), kAtRest * force)
                << c.name << " budget " << budget;
            EXPECT_EQ(shown.back().lag, 0.0) << c.name << " budget " << budget;
            EXPECT_LE(deepest(c, shown), least_overlap + kOverlap) << c.name << " budget " << budget;
        }
    }
}

TEST(NodeBudget, NeverHoldsAPegInABoreByWhatNobodyLookedAt) {
    // Truth: invariant (the same god object without a budget; overlap by exact geometry, that shares nothing with it).
    checkAgainstUnlimited(pegInBore());
}

TEST(NodeBudget, NeverHoldsAPegInABoreByWhatNobodyLookedAtBothWays) {
    // Truth: as above.
    Case c = pegInBore();
    c.spec.contact.two_way = true;
    checkAgainstUnlimited(c);
}

TEST(NodeBudget, NeverHoldsABoxOnAPlateByWhatNobodyLookedAt) {
    // Truth: as above.
    checkAgainstUnlimited(boxOnPlate());
}

TEST(NodeBudget, NeverHoldsAMeshInAMeshByWhatNobodyLookedAt) {
    // Truth: as above.
    checkAgainstUnlimited(wheelInCorner());
}

TEST(NodeBudget, BoundsTheNodesOfATickAndComesToRestWhateverItIs) {
    // Truth: invariant. One obstacle, one way: a look visits no more nodes in a tick than the budget and the children
    // of one node, and a tick makes few looks. At rest every look ends after some ticks, and the way in the end.
    Case c = boxOnPlate();
    const std::vector<Shown> unlimited = follow(c, ContactMethod::GodObject, 0);
    for (const int budget : {1, 5, 20}) {
        scene::SceneSpec spec = c.spec;
        spec.contact.method = ContactMethod::GodObject;
        spec.contact.budget_nodes = budget;
        spec.record_hand_depth = false;
        test::Bench bench(spec);
        const std::vector<Pose> path = pathOf(c);
        std::uint32_t most = 0;
        tick::TickOutput out;
        int left = 60'000;
        for (std::size_t i = 0; i < path.size() + static_cast<std::size_t>(left); ++i) {
            out = bench.step(path[std::min(i, path.size() - 1)]);
            most = std::max(most, out.frame.nodes_visited);
            if (i >= path.size() && (out.frame.status & kSuspended) == 0 && out.frame.proxy_lag == 0.0) break;
        }
        EXPECT_LE(most, 4u * (static_cast<std::uint32_t>(budget) + shell::SphereTree::kChildren)) << budget;
        const Vec3 spring = kStiffness * (out.X_WG.p - path.back().p);
        EXPECT_LE((spring - unlimited.back().spring).norm(), kAtRest * unlimited.back().spring.norm()) << budget;
    }
}

}  // namespace
}  // namespace passung
