// A wall in one hand against a part in another, of triangles. Truth: triangle against triangle (mesh_crossing.h), at
// every tick and at 20 poses between each and the next, as the wall sees the part, and as the part sees the wall.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/tick/step.h"
#include "core/tick/tick_state.h"
#include "tests/support/length.h"
#include "tests/support/mesh_crossing.h"
#include "tests/support/off_file.h"
#include "tests/support/scenes.h"
#include "tests/support/surface_cases.h"
#include "tests/support/temp_folder.h"

namespace passung {
namespace {

using geometry::TriangleMesh;

constexpr int kPlaces = 20;             // between two ticks
constexpr double kStiffness = 1000.0;   // [N/m]
constexpr double kTurnStiffness = 0.1;  // [N·m/rad]
constexpr double kSide = 0.012;         // of the part, about [m]

TriangleMesh box() { return test::boxMesh(.5 * Vec3(-kSide, -.010, -.008), .5 * Vec3(kSide, .010, .008)); }
TriangleMesh gear() { return test::solidMesh(test::gearLine(.4 * kSide, .0015, 9, 0), {0, 0}, -.003, .003); }
TriangleMesh ball() { return test::bumpyMesh(kSide, 10, .3); }
TriangleMesh plate() { return test::boxMesh({-.0015, -.02, -.02}, {.0015, .02, .02}); }
TriangleMesh sheet() {
    TriangleMesh mesh = test::sheetMesh(.04, 8, .0006);
    for (Vec3& v : mesh.vertices) v = Vec3(v.z(), v.x(), v.y());
    return mesh;
}

/// A hand on a smooth way of its own, no faster than a speed and a rate.
class Wander {
public:
    Wander(Random& random, const Vec3& size, double speed, double angle, double rate) {
        for (std::size_t i = 0; i < 6; ++i) {
            size_[i] = i < 3 ? size[static_cast<Eigen::Index>(i)] : angle;
            rate_[i] = (i < 3 ? speed : rate) / std::max(size_[i], 1e-6) * random.uniform(.4, 1.0) / std::sqrt(3.0);
            phase_[i] = random.uniform(0.0, 2.0 * std::numbers::pi);
        }
    }
    Pose at(double t) const {
        std::array<double, 6> v{};
        for (std::size_t i = 0; i < 6; ++i) v[i] = size_[i] * std::sin(rate_[i] * t + phase_[i]);
        return {rotationFromVector(Vec3(v[3], v[4], v[5])), Vec3(v[0], v[1], v[2])};
    }

private:
    std::array<double, 6> size_{}, rate_{}, phase_{};
};

struct Pair {
    const char* name;
    TriangleMesh (*held)();
    TriangleMesh (*wall)();
};

/// What was seen of some approaches.
struct Seen {
    int ticks = 0, approaches = 0, touches = 0, suspended = 0, longest = 0;
    int at_ticks = 0, for_wall = 0, for_part = 0;  // ticks, and ways between two of them, on which triangles cross
    int most_work = 0;                             // of a hand's turn
    double work = 0.0;                             // of a tick, mean
    std::vector<double> steps;                     // of a force from tick to tick, beyond the hands' own [N]
};

Pose between(const Pose& from, const Pose& to, double share) {
    return {from.q.slerp(share, to.q), from.p + share * (to.p - from.p)};
}

/// True if triangles cross somewhere on the straight way of the part seen from the wall, or of the wall from the part.
struct Crosses {
    bool for_wall = false, for_part = false;
};
Crosses crossesBetween(test::MeshPairTruth& truth, const Pose& from, const Pose& to, double reach) {
    const Pose back_from = from.inverse(), back_to = to.inverse();
    const double turn = rotationVector(to.q * from.q.conjugate()).norm();
    const double way = std::max((to.p - from.p).norm(), (back_to.p - back_from.p).norm()) + turn * reach;
    if (truth.distance(to, 1.01 * way + 1e-9) > way) return {};  // nothing on it is farther from its end
    Crosses seen;
    for (int k = 1; k <= kPlaces; ++k) {
        const double share = k / (kPlaces + 1.0);
        seen.for_wall = seen.for_wall || truth.distance(between(from, to, share), 1e-9) == 0.0;
        seen.for_part = seen.for_part || truth.distance(between(back_from, back_to, share).inverse(), 1e-9) == 0.0;
    }
    return seen;
}

double reachOf(const TriangleMesh& mesh) {
    double most = 0.0;
    for (const Vec3& v : mesh.vertices) most = std::max(most, v.norm());
    return most;
}

/// A wall that comes and goes, up to so fast, and a part in the other hand that wanders; both turn.
class Approaches {
public:
    Approaches(const Pair& pair, double speed, std::uint64_t seed)
        : held_(pair.held()),
          wall_(pair.wall()),
          bench_(specOf()),
          truth_(held_, wall_),
          random_(seed),
          rate_(speed / kAmplitude),
          hand_{Wander(random_, Vec3::Constant(.002), .3 * speed, 1.5, std::min(10.0, 40 * speed)),
                Wander(random_, {0, .016, .016}, .5 * speed, .3, std::min(10.0, 40 * speed))} {}

    Seen run(int approaches) {
        const double reach = std::max(reachOf(held_), reachOf(wall_)) + .04;  // of either, seen from the other
        std::array<Pose, 2> before{Pose{}, away()}, hands_before = before;
        std::array<Vec3, 2> force{Vec3::Zero(), Vec3::Zero()};
        std::vector<tick::TickOutput> out(2);
        std::vector<DeviceReading> readings(2);
        int swing = 0, run = 0;
        bool touched = false;
        while (seen_.approaches < approaches) {
            const double t = seen_.ticks++ * kTickSeconds;
            const std::array<Pose, 2> hands = handsAt(t);
            for (std::size_t h = 0; h < 2; ++h) readings[h] = DeviceReading{hands[h]};
            tick::step(bench_.whole(), bench_.wholeState(), readings, out);
            const std::array<Pose, 2> now{out[0].X_WG, out[1].X_WG};
            const Pose from = before[1].inverse() * before[0], to = now[1].inverse() * now[0];
            const Crosses between = crossesBetween(truth_, from, to, reach);
            seen_.at_ticks += truth_.distance(to, 1e-9) == 0.0;
            seen_.for_wall += between.for_wall;
            seen_.for_part += between.for_part;
            const bool touches = out[0].frame.contacts > 0 || out[1].frame.contacts > 0;
            const bool suspended = ((out[0].frame.status | out[1].frame.status) & kSuspended) != 0;
            seen_.touches += touches;
            seen_.suspended += suspended;
            run = suspended ? run + 1 : 0;
            seen_.longest = std::max(seen_.longest, run);
            double own = 0.0;
            for (std::size_t h = 0; h < 2; ++h) own += (hands[h].p - hands_before[h].p).norm();
            for (std::size_t h = 0; h < 2; ++h) {
                seen_.steps.push_back((out[h].F_D_B.force - force[h]).norm() - kStiffness * own);
                force[h] = out[h].F_D_B.force;
                seen_.most_work = std::max(seen_.most_work, static_cast<int>(out[h].frame.nodes_visited));
                seen_.work += out[h].frame.nodes_visited;
            }
            before = now;
            hands_before = hands;
            touched = touched || touches;
            if (const int swings = swingsAt(t); swings > swing) {
                seen_.approaches += touched ? 1 : 0;
                touched = false;
                swing = swings;
            }
        }
        seen_.work /= seen_.ticks;
        std::sort(seen_.steps.begin(), seen_.steps.end());
        return seen_;
    }

private:
    static constexpr double kAmplitude = .009, kHome = .5 * kSide + .0135 - kAmplitude;  // 6 mm beyond the part's face
    static constexpr double kRamp = .3;                                                  // [s]

    static Pose away() { return {Quat::Identity(), Vec3(-kHome - .01, 0, 0)}; }
    int swingsAt(double t) const {
        return static_cast<int>(rate_ * std::max(0.0, t - kRamp) / (2.0 * std::numbers::pi));
    }
    std::array<Pose, 2> handsAt(double t) const {
        const double into = std::min(1.0, t / kRamp);
        Pose X_wall = hand_[1].at(t);
        X_wall.p.x() = -kHome - kAmplitude * std::cos(rate_ * (t - kRamp));
        return {between({}, hand_[0].at(t), into), between(away(), X_wall, into)};
    }

    scene::SceneSpec specOf() const {
        auto spec = test::scene(shape::Sphere{1.0}, {}, shape::Sphere{1.0}, {}, scene::ContactMethod::GodObject);
        spec.parts.clear();
        const std::array<Pose, 2> X_WP{Pose{}, away()};
        const std::array<const TriangleMesh*, 2> meshes{&held_, &wall_};
        for (std::size_t h = 0; h < 2; ++h) {
            const std::string path = folder_ / (std::to_string(h) + ".off");
            test::writeOff(path, *meshes[h]);
            spec.parts.push_back({.name = h == 0 ? "part" : "wall",
                                  .geometry = scene::MeshFile{path, 1.0},
                                  .X_WP = X_WP[h],
                                  .held = true,
                                  .hand = h});
        }
        spec.contact.geometry = scene::Geometry::Surface;
        spec.contact.stiffness = kStiffness;
        spec.contact.rotational_stiffness = kTurnStiffness;
        spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate});
        return spec;
    }

    test::TempFolder folder_;
    TriangleMesh held_, wall_;
    test::Bench bench_;
    test::MeshPairTruth truth_;
    Random random_;
    double rate_;  // [rad/s]
    std::array<Wander, 2> hand_;
    Seen seen_;
};

class MovingWall : public testing::TestWithParam<std::tuple<Pair, double>> {};

TEST_P(MovingWall, IsCrossedNeitherAtTicksNorBetween) {
    // Truth: triangle against triangle, see above. PASSUNG_LONG=1: 10 000 approaches at each speed.
    const auto& [pair, speed] = GetParam();
    const char* asked = std::getenv("PASSUNG_APPROACHES");
    const int approaches = asked != nullptr ? std::atoi(asked) : test::atFullLength() ? 1667 : 5;
    const Seen seen = Approaches(pair, speed, 5).run(approaches);
    std::printf(
        "%s at %g m/s: %d approaches, %d ticks, %d touch, suspended %d (longest %d); crossings at ticks %d, between "
        "%d for the wall, %d for the part; work %.0f, at most %d; steps of force 99.9 %% %.3f N, at most %.3f N\n",
        pair.name, speed, seen.approaches, seen.ticks, seen.touches, seen.suspended, seen.longest, seen.at_ticks,
        seen.for_wall, seen.for_part, seen.work, seen.most_work,
        seen.steps[static_cast<std::size_t>(.999 * static_cast<double>(seen.steps.size()))], seen.steps.back());
    EXPECT_EQ(seen.at_ticks, 0);
    EXPECT_EQ(seen.for_wall, 0);
    EXPECT_EQ(seen.for_part, 0);
}

INSTANTIATE_TEST_SUITE_P(
    All, MovingWall,
    testing::Combine(testing::Values(Pair{"box on plate", box, plate}, Pair{"box on sheet", box, sheet},
                                     Pair{"gear on plate", gear, plate}, Pair{"gear on sheet", gear, sheet},
                                     Pair{"ball on plate", ball, plate}, Pair{"ball on sheet", ball, sheet}),
                     testing::Values(0.1, 0.5, 1.0, 2.0)),
    [](const auto& made) {
        std::string name = std::get<0>(made.param).name;
        std::replace(name.begin(), name.end(), ' ', '_');
        return name + "_" + std::to_string(static_cast<int>(std::round(1e3 * std::get<1>(made.param)))) + "_mm_per_s";
    });

}  // namespace
}  // namespace passung
