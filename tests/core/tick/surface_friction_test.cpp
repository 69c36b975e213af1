#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/scene/contact_geometry.h"
#include "tests/support/length.h"
#include "tests/support/mesh_crossing.h"
#include "tests/support/off_file.h"
#include "tests/support/scenes.h"
#include "tests/support/surface_cases.h"
#include "tests/support/temp_folder.h"

// Dry friction of god objects on triangles.

namespace passung {
namespace {

using geometry::TriangleMesh;

constexpr double kStiffness = 1000.0;         // [N/m]
constexpr double kRotationalStiffness = 5.0;  // [N m/rad]
constexpr double kPressed = 1e-3;             // [m]
constexpr double kAtRest = 0.4, kSliding = 0.3;

/// A part with one mesh among others.
class Rubbing {
public:
    explicit Rubbing(const TriangleMesh& held, const Pose& start = {},
                     scene::ContactMethod method = scene::ContactMethod::GodObject, double at_rest = kAtRest,
                     double sliding = kSliding) {
        add("held", held, start, at_rest, sliding);
        spec_.parts.front().held = true;
        spec_.contact.method = method;
        spec_.contact.geometry = scene::Geometry::Surface;
        spec_.contact.stiffness = kStiffness;
        spec_.contact.rotational_stiffness = kRotationalStiffness;
        test::liftLimits(spec_);
    }
    Rubbing& against(const TriangleMesh& mesh, const Pose& X = {}, double at_rest = kAtRest,
                     double sliding = kSliding) {
        add("obstacle" + std::to_string(spec_.parts.size()), mesh, X, at_rest, sliding);
        return *this;
    }
    const scene::SceneSpec& spec() const { return spec_; }

private:
    void add(const std::string& name, const TriangleMesh& mesh, const Pose& X, double at_rest, double sliding) {
        const std::string path = folder_ / (name + ".off");
        test::writeOff(path, mesh);
        spec_.parts.push_back({.name = name, .geometry = scene::MeshFile{path, 1.0}, .X_WP = X});
        spec_.parts.back().friction = at_rest;
        spec_.parts.back().sliding_friction = sliding;
    }
    test::TempFolder folder_;
    scene::SceneSpec spec_;
};

TriangleMesh table() { return test::boxMesh({-.05, -.05, -.02}, {.05, .05, 0}); }

/// Of the springs that draw a part to its hand [J].
double energyBetween(const Pose& X_WH, const Pose& X_WG) {
    return 0.5 * kStiffness * (X_WH.p - X_WG.p).squaredNorm() +
           0.5 * kRotationalStiffness * rotationVector(X_WH.q * X_WG.q.conjugate()).squaredNorm();
}

/// Presses down by kPressed within 200 ticks.
Pose pressed(test::Bench& bench, Pose X) {
    for (int i = 0; i < 200; ++i) {
        X.p.z() -= kPressed / 200;
        bench.step(X);
    }
    return X;
}

/// Force and torque on the hand while it goes on by `along` and turns by `turn` a tick.
Wrench dragged(test::Bench& bench, Pose X, int ticks, const Vec3& along, const Vec3& turn) {
    Wrench last;
    for (int i = 0; i < ticks; ++i) {
        X.p += along;
        X.q = (rotationFromVector(turn) * X.q).normalized();
        last = bench.step(X).frame.F_H_W;
    }
    return last;
}

/// Torque of a turned part on the table over the normal force [m].
double torsionOf(const TriangleMesh& held) {
    Rubbing scene(held, Pose{Quat::Identity(), {0, 0, 2e-6}});
    scene.against(table());
    test::Bench bench(scene.spec());
    const Pose X = pressed(bench, scene.spec().parts[0].X_WP);
    const Wrench out = dragged(bench, X, 600, Vec3::Zero(), {0, 0, 2e-5});
    return -out.torque.z() / out.force.z();
}

TEST(SurfaceFriction, BearsTorsionByWhereFacesLieOnEachOther) {
    // Truth: closed form: T/F = μ_d times the mean distance from the centre over the faces, evenly pressed: a disc 2/3
    // R; a ring 2/3 (R³ - r³)/(R² - r²); two feet of 2 x 2 mm, 20 mm apart, and a plate of 20 x 4 mm by a sum over a
    // grid.
    const double R = 0.01, r = 0.007;
    EXPECT_NEAR(torsionOf(test::solidMesh(test::circleLine(R, 96), {0, 0}, 0, .01)), kSliding * 2.0 / 3.0 * R,
                0.03 * kSliding * R);
    EXPECT_NEAR(torsionOf(test::tubeMesh(test::circleLine(r, 96), test::circleLine(R, 96), 0, .01)),
                kSliding * 2.0 / 3.0 * (R * R * R - r * r * r) / (R * R - r * r), 0.03 * kSliding * R);
    const auto meanOver = [](const Vec3& low, const Vec3& high) {
        double sum = 0.0;
        const int n = 200;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k)
                sum += std::hypot(low.x() + (i + .5) / n * (high.x() - low.x()),
                                  low.y() + (k + .5) / n * (high.y() - low.y()));
        return sum / (n * n);
    };
    const Vec3 low(-.01, -.002, 0), high(.01, .002, .005);
    EXPECT_NEAR(torsionOf(test::boxMesh(low, high)), kSliding * meanOver(low, high),
                0.05 * kSliding * meanOver(low, high));
    const Vec3 foot(.009, -.001, 0), end(.011, .001, .005);
    auto feet = test::boxMesh(foot, end);
    test::append(feet,
                 test::placed(test::boxMesh(foot, end), test::turned(std::numbers::pi, Vec3::UnitZ(), {0, 0, 0})));
    EXPECT_NEAR(torsionOf(feet), kSliding * meanOver(foot, end), 0.03 * kSliding * meanOver(foot, end));
}

TEST(SurfaceFriction, OfEachObstacleIsItsOwn) {
    // Truth: closed form: a bar in a groove of 90 degrees, pressed with F and drawn along it: each flank bears F/√2 and
    // rubs with its own coefficient, √(μ_held μ_obstacle), of which the bar feels the sum; a third obstacle, left
    // alone, stands between them in the list.
    const Quat on_edge(Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitX()));
    const auto wall = test::boxMesh({-.05, 0, -.02}, {.05, .02, 0});
    const double other = 0.1;
    Rubbing scene(test::placed(test::boxMesh({-.01, 0, 0}, {.01, .01, .01}), Pose{on_edge, {0, 0, 0}}),
                  Pose{Quat::Identity(), {0, 0, 2e-6}});
    scene.against(test::placed(wall, Pose{on_edge, {0, 0, 0}}))
        .against(table(), Pose{Quat::Identity(), {0, 0, -.1}}, 0.9, 0.9)
        .against(test::placed(test::boxMesh({-.05, -.02, -.02}, {.05, 0, .02}), Pose{on_edge, {0, 0, 0}}), {}, other,
                 other);
    test::Bench bench(scene.spec());
    const Pose X = pressed(bench, scene.spec().parts[0].X_WP);
    const Wrench out = dragged(bench, X, 3000, {1e-6, 0, 0}, Vec3::Zero());
    const double share = (kSliding + std::sqrt(kSliding * other)) / std::sqrt(2.0);
    std::printf("along the groove %.4f of the force, expected %.4f\n", -out.force.x() / out.force.z(), share);
    EXPECT_NEAR(-out.force.x() / out.force.z(), share, 0.01 * share);
}

TEST(SurfaceFriction, HoldsAtEdgesAndCorners) {
    // Truth: closed form: Coulomb, however small what touches is: a box on an edge, on a corner, a cube's corner under
    // a face.
    const Quat on_edge(Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitX()));
    const Quat on_corner = rotationBetween(Vec3(1, 1, 1), Vec3::UnitZ());
    const auto box = test::boxMesh({0, 0, 0}, {.02, .02, .02});
    for (const auto& [held, obstacle] : {std::pair{test::placed(box, Pose{on_edge, {0, 0, 0}}), table()},
                                         std::pair{test::placed(box, Pose{on_corner, {0, 0, 0}}), table()},
                                         std::pair{test::boxMesh({-.02, -.02, 0}, {.02, .02, .01}),
                                                   test::placed(test::boxMesh({-.01, -.01, -.01}, {.01, .01, .01}),
                                                                Pose{on_corner, {0, 0, -.01 * std::sqrt(3.0)}})}}) {
        Rubbing scene(held, Pose{Quat::Identity(), {0, 0, 2e-6}});
        scene.against(obstacle);
        test::Bench bench(scene.spec());
        const Pose X = pressed(bench, scene.spec().parts[0].X_WP);
        const Wrench out = dragged(bench, X, 1500, {1e-6, 0, 0}, Vec3::Zero());
        EXPECT_NEAR(out.force.head<2>().norm() / out.force.z(), kSliding, 0.02 * kSliding);
    }
}

/// What a part does that follows a random path.
struct Followed {
    int crossings = 0, held = 0, suspended = 0;
    double rubbed = 0.0, raised = 0.0;  // what its ways took of the springs' energy; and gave [J]
    double step = 0.0;                  // largest step of the force beyond the hand's [N]
};

Followed follow(const test::SurfaceCase& made, scene::ContactMethod method, double at_rest, double sliding) {
    Rubbing scene(made.held, made.hand(0), method, at_rest, sliding);
    scene.against(made.obstacle, {}, at_rest, sliding);
    test::Bench bench(scene.spec());
    test::MeshPairTruth truth(made.held, made.obstacle);
    Pose last = made.hand(0), X_WH_last = last;
    Followed seen;
    const int ticks = test::atFullLength() ? made.ticks : 1000;
    for (int i = 0; i < ticks; ++i) {
        const Pose X_WH = made.hand(1e-3 * i);
        const auto out = bench.step(X_WH);
        const Pose half{last.q.slerp(0.5, out.X_WG.q), 0.5 * (last.p + out.X_WG.p)};
        seen.crossings += truth.distance(out.X_WG, 1e-9) == 0.0;
        seen.crossings += truth.distance(half, 1e-9) == 0.0;
        const double work = energyBetween(X_WH, last) - energyBetween(X_WH, out.X_WG);
        (work > 0.0 ? seen.rubbed : seen.raised) += std::abs(work);
        seen.held += (X_WH.p - out.X_WG.p).norm() > 5e-5;
        seen.suspended += (out.frame.status & kSuspended) != 0;
        const Vec3 hand = X_WH.p - X_WH_last.p;
        seen.step = std::max(seen.step, kStiffness * ((out.X_WG.p - last.p - hand).norm() - hand.norm()));
        last = out.X_WG;
        X_WH_last = X_WH;
    }
    std::printf(
        "%s, %s, %.1f and %.1f: held in %d of %d ticks, %d suspended; %.3f mJ rubbed, %.3f back; step of the force "
        "beyond the hand's %.3f N; %d crossings\n",
        made.name.c_str(), scene::methodName(method), at_rest, sliding, seen.held, ticks, seen.suspended,
        1e3 * seen.rubbed, 1e3 * seen.raised, seen.step, seen.crossings);
    EXPECT_GT(seen.held, ticks / 10);
    return seen;
}

TEST(SurfaceFriction, LetsNothingThroughAndGivesNoEnergy) {
    // Truth: dense geometry: triangles of both parts, at each tick and half way between two; and energy: no way that
    // the proxy goes stretches its springs, for contacts and friction take and do not give, but for the gap that is
    // held: a part that wedges has it opened again by 0.3 um a tick. Steps: the mark of paths without friction.
    for (const auto& made : {test::blockOnPin(), test::blockOnFin(), test::needleInSlit(), test::dShaft(),
                             test::dovetail(), test::ballOnSheet()})
        for (const double sliding : {kSliding, kAtRest}) {
            const Followed seen = follow(made, scene::ContactMethod::GodObject, kAtRest, sliding);
            EXPECT_EQ(seen.crossings, 0) << made.name;
            EXPECT_LT(seen.raised, 0.1 * seen.rubbed) << made.name;
            EXPECT_LT(seen.step, 0.1) << made.name;
        }
    const Followed heuristic = follow(test::dShaft(), scene::ContactMethod::GodObjectHeuristic, kAtRest, kSliding);
    EXPECT_EQ(heuristic.crossings, 0);
}

}  // namespace
}  // namespace passung
