#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "devices/scripted/trajectory.h"
#include "tests/core/tick/grain.h"
#include "tests/support/length.h"

// The force of god objects on closed forms along random smooth paths, against the pose of least energy
// (analysis/truth/least_energy.h). PASSUNG_LONG=1: 1000 paths of 1.2 s, some 25 minutes of processor time.

namespace passung::grain {
namespace {

using scene::ContactMethod;

bool all() { return test::atFullLength(); }

scripted::Trajectory pathOf(const std::string& name) {
    auto path = scripted::Trajectory::read(PASSUNG_SOURCE_DIR "/tests/data/closed_form/" + name + ".csv");
    if (!path) ADD_FAILURE() << toString(path.errors().front());
    return std::move(*path);
}

void print(const std::string& what, const Seen& seen) {
    std::printf(
        "%s: %ld ticks, %ld judged (reference: %ld snaps, %ld without an end; looks ended in %ld); force beside it "
        "%.4f N in the bore, %.4f N elsewhere; %ld that differ with more energy (by %.1e K mm2 at most), %ld "
        "with less; step beyond it %.4f N; %d catches; overlap %.3f um; worst %s\n",
        what.c_str(), seen.ticks, seen.judged, seen.snaps, seen.unknown, seen.lagging, seen.bore, seen.elsewhere,
        seen.off, 1e6 * seen.energy, seen.lower, seen.step, seen.catches, 1e6 * seen.overlap, seen.worst.c_str());
    std::fflush(stdout);
}

Seen follow(Judge& judge, const Pair& pair, const Kind& kind, std::uint64_t seed, int ticks,
            ContactMethod method = ContactMethod::GodObject) {
    const Hand hand(pair, kind, seed);
    return judge.follow([&](int i) { return hand.at(1e-3 * i); }, ticks, kind.name + ", seed " + std::to_string(seed),
                        method);
}

class PathsOver : public testing::TestWithParam<Pair> {
protected:
    bool round() const { return GetParam().name.find("peg in") == 0; }

    /// One path of each kind, at full length 1000 of all pairs.
    Seen followAll(Judge& judge, const Kind& kind, ContactMethod method) const {
        const Pair& pair = GetParam();
        const int paths = all() ? (pair.kinds.size() == 5 ? 34 : 80) : 1;
        const auto first = static_cast<std::uint64_t>(100 + 1000 * (&kind - pair.kinds.data()));
        Seen seen;
        for (int i = 0; i < paths; ++i)
            seen.add(follow(judge, pair, kind, first + static_cast<std::uint64_t>(i), all() || !round() ? 1200 : 600,
                            method));
        print(pair.name + ", " + kind.name, seen);
        return seen;
    }
};

TEST_P(PathsOver, AreFollowedAsTheLeastEnergySays) {
    // Truth: closed form: separations of convex pieces, and steps downhill under them, which share nothing with the
    // core but the shapes' dimensions; overlap: dense points against exact distances. Text T2, T3, T5, T8.
    Judge judge(judgedOf(GetParam()));
    for (const Kind& kind : GetParam().kinds) {
        const Seen seen = followAll(judge, kind, ContactMethod::GodObject);
        EXPECT_LE(seen.bore, kForce) << seen.worst;
        EXPECT_LE(seen.step_bore, kForce);
        EXPECT_LE(seen.most_looks_bore, 8.0);
        // Beside an edge a tick may rest in another minimum of its own, before it snaps in the next one.
        EXPECT_LE(static_cast<double>(seen.off), 1e-3 * static_cast<double>(seen.judged)) << seen.worst;
        EXPECT_LE(seen.step, 0.1);
        EXPECT_EQ(seen.catches, 0);
        EXPECT_LE(seen.overlap, 1e-7);
        EXPECT_LE(static_cast<double>(seen.lagging), std::max(1.0, static_cast<double>(seen.ticks) / 2000.0));
        EXPECT_GT(static_cast<double>(seen.judged), 0.75 * static_cast<double>(seen.ticks));
    }
}

TEST_P(PathsOver, AreFollowedByTheHeuristicWithinItsShare) {
    // Truth: as above; the heuristic's mark: 0.05 N and 2 % of the force at 99 % of ticks.
    Judged judged = judgedOf(GetParam());
    judged.force = 0.05;
    judged.share = 0.02;
    Judge judge(std::move(judged));
    for (const Kind& kind : GetParam().kinds) {
        const Seen seen = followAll(judge, kind, ContactMethod::GodObjectHeuristic);
        EXPECT_LE(static_cast<double>(seen.off), 1e-2 * static_cast<double>(seen.judged)) << seen.worst;
        EXPECT_LE(seen.step, 0.1);
        EXPECT_EQ(seen.catches, 0);
        EXPECT_LE(seen.overlap, 1e-7);
        EXPECT_LE(static_cast<double>(seen.lagging), std::max(1.0, 1e-3 * static_cast<double>(seen.ticks)));
        EXPECT_GT(static_cast<double>(seen.judged), 0.75 * static_cast<double>(seen.ticks));
    }
}

INSTANTIATE_TEST_SUITE_P(Parametric, PathsOver, testing::ValuesIn(pairs()), [](const auto& made) {
    std::string name = made.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
});

/// A kind's path along which a defect was found.
struct Found {
    const char* what;
    std::size_t pair, kind;
    std::uint64_t seed;
};

TEST(ClosedFormGrain, PathsAlongWhichItWasWrongAreFollowed) {
    // Truth: as above; beside each its defect.
    const Found all_found[] = {
        {"a place that held a tick before, where nothing holds any more", 0, 4, 4001},
        {"a vertex on an edge was held by both faces", 3, 4, 4005},
        {"corners of what lies flat were found one after the other, in vain", 3, 4, 4001},
        {"the same where one edge is round", 0, 4, 4001},
        {"an obstacle's vertex under an edge", 5, 0, 14},
        {"a ridge where two edges pass each other", 0, 4, 4014},
    };
    const auto known = pairs();
    for (const Found& found : all_found) {
        SCOPED_TRACE(found.what);
        const Pair& pair = known[found.pair];
        Judge judge(judgedOf(pair));
        const Seen seen = follow(judge, pair, pair.kinds[found.kind], found.seed, 1200);
        print(found.what, seen);
        EXPECT_EQ(seen.off, 0) << seen.worst;
        EXPECT_EQ(seen.lagging, 0);
        EXPECT_LE(seen.step, 0.01);
    }
}

TEST(ClosedFormGrain, ATiltedPegSlidesInThreeClearancesWithoutACatch) {
    // Truth: text T1: 6 N sideways, 2.9 degrees, up to 31 mm/s; 0.07, 0.05, 0.015 N along the axis; steps of 0.05 N of
    // the spring, of 0.10 N with the damper of the scene's device (5 N s/m).
    const auto path = pathOf("tilted_peg");
    const auto known = pairs();
    const std::array axial{0.07, 0.05, 0.015};
    for (const double damping : {0.0, 5.0})
        for (std::size_t i = 0; i < 3; ++i) {
            auto spec = sceneOf(known[i], path.at(0), ContactMethod::GodObject);
            spec.contact.damping = damping;
            test::Bench bench(spec);
            double most = 0.0, step = 0.0;
            int caught = 0;
            Vec3 before = Vec3::Zero();
            for (std::int64_t tick = 0; tick <= path.lastTick(); ++tick) {
                const auto out = bench.step(path.at(tick));
                if (tick > 1200) {
                    most = std::max(most, std::abs(out.F_D_B.force.z()));
                    step = std::max(step, (out.F_D_B.force - before).norm());
                    caught += std::abs(out.X_WG.p.z() - path.at(tick).p.z()) > 4e-5 ? 1 : 0;
                }
                before = out.F_D_B.force;
            }
            std::printf("%s, damper %.0f N s/m: |Fz| %.4f N, step %.4f N a tick\n", known[i].name.c_str(), damping,
                        most, step);
            EXPECT_LE(step, damping > 0.0 ? 0.10 : 0.05);
            if (damping > 0.0) continue;
            EXPECT_LE(most, axial[i]);
            EXPECT_EQ(caught, 0);
        }
}

TEST(ClosedFormGrain, ATipOnTheMouthsEdgeIsHeldAcrossBothEdgesAlone) {
    // Truth: text T6, T7: the force at tick 1544, and nothing along the common tangents of edges that cross.
    const auto path = pathOf("edge_crossing");
    const auto known = pairs();
    test::Bench bench(sceneOf(known[0], path.at(0), ContactMethod::GodObject));
    for (std::int64_t tick = 0; tick <= path.lastTick(); ++tick) {
        const auto out = bench.step(path.at(tick));
        if (tick == 1544) {
            EXPECT_NEAR((out.F_D_B.force - Vec3(0.252, 0.089, 2.209)).norm(), 0.0, 1e-3);
        }
    }
    Judge judge(judgedOf(known[0]));
    const Seen seen = judge.follow([&](int i) { return path.at(i); }, static_cast<int>(path.lastTick()),
                                   "edge crossing", ContactMethod::GodObject);
    print("edge crossing", seen);
    EXPECT_EQ(seen.off, 0) << seen.worst;
    EXPECT_EQ(seen.catches, 0);
}

}  // namespace
}  // namespace passung::grain
