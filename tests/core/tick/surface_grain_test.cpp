#include <gtest/gtest.h>

#include <cstdio>

#include "tests/core/tick/grain.h"
#include "tests/support/length.h"
#include "tests/support/mesh_crossing.h"
#include "tests/support/mesh_separation.h"
#include "tests/support/off_file.h"
#include "tests/support/surface_cases.h"
#include "tests/support/temp_folder.h"

// The force of a god object on triangles along random smooth paths, against the pose of least energy that the same
// triangles allow (tests/support/mesh_separation.h). PASSUNG_LONG=1: 1000 paths of 1.2 s.

namespace passung::grain {
namespace {

using scene::ContactMethod;

constexpr double kSurfaceForce = 0.05;    // that a tick may differ by [N]
constexpr double kHeuristicShare = 0.02;  // of the force, beside it

/// `gap`: the reference keeps the program's gap too, else none.
Judged judgedOf(const test::SurfaceCase& made, const std::string& prefix, bool gap) {
    const std::string held = prefix + "_held.off", obstacle = prefix + "_obstacle.off";
    test::writeOff(held, made.held);
    test::writeOff(obstacle, made.obstacle);
    const auto truth = std::make_shared<test::MeshPairTruth>(made.held, made.obstacle);
    auto separation = std::make_unique<test::MeshSeparation>(made.held, made.obstacle);
    Judged judged;
    if (gap) judged.keep_gap = [kept = separation.get()](double now) { kept->keepGap(now); };
    judged.separation = std::move(separation);
    judged.scene = [held, obstacle](const Pose& start, ContactMethod method) {
        scene::SceneSpec spec;
        spec.parts.push_back({.name = "held", .geometry = scene::MeshFile{held, 1.0}, .X_WP = start, .held = true});
        spec.parts.push_back({.name = "obstacle", .geometry = scene::MeshFile{obstacle, 1.0}, .X_WP = Pose{}});
        spec.contact.method = method;
        spec.contact.geometry = scene::Geometry::Surface;
        spec.contact.stiffness = kStiffness;
        spec.contact.rotational_stiffness = kRotationalStiffness;
        test::liftLimits(spec);
        return spec;
    };
    judged.overlap = [truth](const Pose& X) { return truth->distance(X, 1e-9) > 0.0 ? 0.0 : 1.0; };
    judged.force = kSurfaceForce;
    return judged;
}

void print(const std::string& what, const Seen& seen) {
    std::printf(
        "%s: %ld ticks, %ld judged (reference: %ld snaps, %ld without an end; looks ended in %ld); force beside it "
        "%.4f N at most; %ld that differ with more energy, %ld with less; step beyond it %.4f N, %ld above 0.1 N; %d "
        "catches, longest %d ticks; worst %s\n",
        what.c_str(), seen.ticks, seen.judged, seen.snaps, seen.unknown, seen.lagging, seen.elsewhere, seen.off,
        seen.lower, seen.step, seen.steps, seen.catches, seen.longest, seen.worst.c_str());
    std::fflush(stdout);
}

struct Facets {
    const char* name;
    test::SurfaceCase (*make)(std::uint64_t seed);
    int paths, all_paths;
};
void PrintTo(const Facets& facets, std::ostream* out) { *out << facets.name; }

TEST(SurfaceGrain, APathAlongWhichItStoodStillIsFollowed) {
    // Truth: as below. A peg that comes back over the end of its bore: a plane of two edges that passed each other
    // within the gap leaned against its way, and it stood still for 40 ticks and more.
    const test::TempFolder folder;
    const auto made = test::dShaft(151);
    Judge judge(judgedOf(made, folder / "parts", true));
    const Seen seen =
        judge.follow([&](int k) { return made.hand(1e-3 * k); }, 1200, "path 51", ContactMethod::GodObject);
    print("past the end of its bore", seen);
    EXPECT_LE(seen.off, 1) << seen.worst;
    EXPECT_EQ(seen.catches, 0);
}

class FacetsOf : public testing::TestWithParam<Facets> {
protected:
    Seen follow(bool gap, ContactMethod method = ContactMethod::GodObject) {
        const test::TempFolder folder;
        const bool heuristic = method == ContactMethod::GodObjectHeuristic;
        const int paths = test::atFullLength() ? GetParam().all_paths : heuristic ? 1 : GetParam().paths;
        const std::string name =
            std::string(GetParam().name) + (heuristic ? ", heuristic" : "") + (gap ? ", the same gap" : ", no gap");
        Seen seen;
        for (int i = 0; i < paths; ++i) {
            const auto made = GetParam().make(100 + static_cast<std::uint64_t>(i));
            Judged judged = judgedOf(made, folder / "parts", gap);
            judged.share = heuristic ? kHeuristicShare : 0.0;
            Judge judge(std::move(judged));
            seen.add(
                judge.follow([&](int k) { return made.hand(1e-3 * k); }, 1200, "path " + std::to_string(i), method));
            if ((i + 1) % 50 == 0 || i + 1 == paths) print(name + ", " + std::to_string(i + 1) + " paths", seen);
        }
        return seen;
    }
};

TEST_P(FacetsOf, AreFollowedAsTheLeastEnergySays) {
    // Truth: dense geometry: conditions of vertices, faces and edges, written for this, and steps downhill under them,
    // as far from each other as the program keeps its parts; crossings triangle by triangle.
    const Seen seen = follow(true);
    EXPECT_EQ(seen.overlap, 0.0) << "triangles cross";
    EXPECT_LE(static_cast<double>(seen.off), 1e-3 * static_cast<double>(seen.judged)) << seen.worst;
    EXPECT_LE(seen.step, 0.1);
    EXPECT_EQ(seen.catches, 0);
    EXPECT_GT(static_cast<double>(seen.judged), 0.75 * static_cast<double>(seen.ticks));
}

TEST_P(FacetsOf, AreFollowedByTheHeuristicWithinItsShare) {
    // Truth: as above; the heuristic's mark: 0.05 N and 2 % of the force at 99 % of ticks.
    const Seen seen = follow(true, ContactMethod::GodObjectHeuristic);
    EXPECT_EQ(seen.overlap, 0.0) << "triangles cross";
    EXPECT_LE(static_cast<double>(seen.off), 1e-2 * static_cast<double>(seen.judged)) << seen.worst;
    EXPECT_LE(seen.step, 0.1);
    EXPECT_EQ(seen.catches, 0);
    EXPECT_LE(static_cast<double>(seen.lagging), std::max(1.0, 1e-3 * static_cast<double>(seen.ticks)));
    EXPECT_GT(static_cast<double>(seen.judged), 0.75 * static_cast<double>(seen.ticks));
}

TEST_P(FacetsOf, AreFollowedAsIfThereWereNoGapButBesideWedges) {
    // Truth: the same without a gap: what a gap of 1 um changes. Where faces wedge, it changes which pose is best.
    const Seen seen = follow(false);
    EXPECT_LE(static_cast<double>(seen.off), 0.03 * static_cast<double>(seen.judged)) << seen.worst;
    EXPECT_LE(seen.step, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Meshes, FacetsOf,
                         testing::Values(Facets{"gear", test::gearInGear, 1, 100},
                                         Facets{"dShaped", test::dShaft, 3, 450},
                                         Facets{"groove", test::dovetail, 3, 450}),
                         [](const auto& made) { return std::string(made.param.name); });

}  // namespace
}  // namespace passung::grain
