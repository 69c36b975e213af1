#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/query/part_query.h"
#include "tests/support/broken_mesh.h"
#include "tests/support/mesh_pairs.h"

namespace passung {
namespace {

constexpr double kTolerance = 20e-6;

scene::Part shapePart(const shape::Shape& shape) {
    const scene::PartSpec spec{.name = {}, .geometry = shape, .X_WP = {}};
    auto part = scene::buildPart(spec, {.field = true, .shell = true, .tolerance = 50e-6, .spacing = 1e-3});
    EXPECT_TRUE(part);
    return std::move(*part);
}

scene::Part filePart(const geometry::TriangleMesh& mesh, const std::string& name) {
    const auto path = std::filesystem::temp_directory_path() / ("passung_" + name + std::to_string(getpid()) + ".off");
    test::writeOff(path.string(), mesh);
    scene::PartSpec spec;
    spec.name = name;
    spec.geometry = scene::MeshFile{path.string(), 1.0};
    auto part = scene::buildPart(spec, {.field = true, .shell = true, .tolerance = 50e-6, .spacing = 1e-3});
    std::filesystem::remove(path);
    EXPECT_TRUE(part);
    return std::move(*part);
}

/// A spur gear with trapezoid teeth, its axis z.
geometry::TriangleMesh gear(int teeth, double radius, double height) {
    std::vector<Eigen::Vector2d> rim;
    for (int k = 0; k < 4 * teeth; ++k) {
        const double angle = 2.0 * M_PI * (k + (k % 2 == 0 ? 0.15 : -0.15)) / (4 * teeth);
        const double r = radius * (k % 4 == 1 || k % 4 == 2 ? 1.1 : 0.9);
        rim.emplace_back(r * std::cos(angle), r * std::sin(angle));
    }
    geometry::TriangleMesh mesh;
    const auto n = static_cast<std::uint32_t>(rim.size());
    for (const double z : {0.0, height})
        for (const auto& p : rim) mesh.vertices.emplace_back(p.x(), p.y(), z);
    mesh.vertices.emplace_back(0, 0, 0);
    mesh.vertices.emplace_back(0, 0, height);
    for (std::uint32_t k = 0; k < n; ++k) {
        const std::uint32_t next = (k + 1) % n;
        mesh.triangles.push_back({k, next, n + next});
        mesh.triangles.push_back({k, n + next, n + k});
        mesh.triangles.push_back({2 * n, next, k});
        mesh.triangles.push_back({2 * n + 1, n + k, n + next});
    }
    return mesh;
}

double processorMs() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// The deepest of many points of SHELL's triangles in FIELD, by nothing that the query uses: no truth is above it [m].
double deepestSample(const test::MeshPair& pair, const Pose& X_FS, double spacing) {
    double deepest = 0.0;
    for (const truth::Corners& t : pair.oracle.b().triangles()) {
        const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
        const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, 200);
        for (int i = 0; i <= n; ++i)
            for (int j = 0; i + j <= n; ++j) {
                const Vec3 p = X_FS * Vec3(t[0] + (t[1] - t[0]) * i / n + (t[2] - t[0]) * j / n);
                if (pair.oracle.a().nearest(p).distance > -deepest && pair.oracle.a().contains(p))
                    deepest = std::min(deepest, -pair.oracle.a().nearest(p).distance);
            }
    }
    return deepest;
}

struct Tally {
    explicit Tally(double tolerance_) : tolerance(tolerance_) {}
    double tolerance;
    std::vector<double> ms;
    int proven = 0, contradicted = 0, overlapping = 0;
    double worst_bound = 0.0, worst_error = 0.0;

    void require(const std::string& name) const {
        EXPECT_EQ(proven, overlapping) << name;
        EXPECT_EQ(contradicted, 0) << name;
        EXPECT_LE(worst_error, tolerance) << name;
    }
    void print(const std::string& name) {
        std::sort(ms.begin(), ms.end());
        std::printf(
            "  %-24s %4.0f um: %3d overlapping, %3d proven, bound to %7.1f um, error to %6.1f um, median %7.2f ms, "
            "most %7.2f "
            "ms\n",
            name.c_str(), 1e6 * tolerance, overlapping, proven, 1e6 * worst_bound, 1e6 * worst_error, ms[ms.size() / 2],
            ms.back());
    }
};

/// Asks for overlapping poses; `low` and `high` hold the truth.
void judge(query::PartQuery& query, const Pose& X_FS, double low, double high, Tally& tally) {
    const double begin = processorMs();
    const query::PartQueryResult r = query.at(X_FS);
    tally.ms.push_back(processorMs() - begin);
    ++tally.overlapping;
    tally.worst_bound = std::max(tally.worst_bound, r.error_bound);
    tally.worst_error = std::max({tally.worst_error, low - r.signed_distance, r.signed_distance - high});
    if (r.error_bound <= tally.tolerance)
        ++tally.proven;
    else
        std::printf("    not reached: %s: %.1f um, bound %.1f um, %d nodes, truth [%.1f, %.1f]\n",
                    test::toText(X_FS).c_str(), 1e6 * r.signed_distance, 1e6 * r.error_bound, r.nodes_visited,
                    1e6 * low, 1e6 * high);
    constexpr double kRounding = 1e-9;
    if (r.lower_bound > high + kRounding || r.upper_bound < low - kRounding) {
        ++tally.contradicted;
        std::printf("    contradicted: %s: [%.3f, %.3f], truth [%.3f, %.3f] um\n", test::toText(X_FS).c_str(),
                    1e6 * r.lower_bound, 1e6 * r.upper_bound, 1e6 * low, 1e6 * high);
    }
}

/// Overlapping poses: half of them near first contact, up to `depth` in, half of them anywhere.
class OverlapQuery : public testing::Test {
protected:
    void judgePair(const test::MeshPair& pair, double depth, int poses, std::uint64_t seed) {
        for (const double tolerance : {kTolerance, 2e-6}) {
            query::PartQueryRequest request;
            request.tolerance = tolerance;
            query::PartQuery query(pair.field, pair.shell, request);
            Random random(seed);
            Tally tally(tolerance);
            for (int i = 0; tally.overlapping < poses && i < 10 * poses; ++i) {
                const Pose X_FS =
                    i % 2 == 0 ? test::poseNearContact(pair, depth, random) : test::poseAnywhere(pair, random);
                const truth::Relation relation = *pair.oracle.relation(X_FS);
                if (relation == truth::Relation::Apart || relation == truth::Relation::AInsideB) continue;
                const truth::DeepestPoint deepest =
                    truth::deepestPoint(pair.oracle.a(), pair.oracle.b(), X_FS, 2e-6, 10'000);
                const double sampled = deepestSample(pair, X_FS, 2e-3);
                ASSERT_LE(-sampled, deepest.depth + deepest.uncertainty + 1e-9);
                judge(query, X_FS, -deepest.depth - deepest.uncertainty, std::min(-deepest.depth, sampled), tally);
            }
            tally.print(pair.name);
            EXPECT_EQ(tally.overlapping, poses) << pair.name;
            tally.require(pair.name);
        }
    }
};

TEST_F(OverlapQuery, ATorusInABlobIsProven) {
    // Truth: independent program (branch and bound of analysis/truth with ray parity; samples of the surface below it).
    const auto torus = shape::tessellate(shape::Torus{0.03, 0.008}, 50e-6);
    judgePair({"torus in blob", filePart(test::wavySphere(0.06, 60e-6), "blob"), filePart(torus, "torus")}, 3e-3, 20,
              1);
}

TEST_F(OverlapQuery, ABoxInABoxIsProven) {
    // Truth: as above. Twelve large triangles each.
    const auto box = [](double x, double y, double z) { return shape::tessellate(shape::Box{x, y, z}, 1.0); };
    judgePair({"box in box", filePart(box(0.04, 0.03, 0.02), "a"), filePart(box(0.02, 0.02, 0.02), "b")}, 3e-3, 40, 2);
}

TEST_F(OverlapQuery, TwoBlobsAreProven) {
    // Truth: as above.
    judgePair(
        {"blob in blob", filePart(test::wavySphere(0.05, 40e-6), "big"), filePart(test::bumpyBall(0.03), "small")},
        2e-3, 20, 3);
}

TEST_F(OverlapQuery, GearsAreProven) {
    // Truth: as above. Teeth with large flat flanks.
    judgePair({"gears", filePart(gear(17, 0.02, 0.01), "gear"), filePart(gear(12, 0.014, 0.01), "pinion")}, 1e-3, 40,
              4);
}

TEST_F(OverlapQuery, APegPressedAlongItsBoresWallIsProven) {
    // Truth: closed form of the shapes, whose chords the bound holds: axis beside axis, the wall is reached in to
    // offset less clearance.
    for (const double clearance : {100e-6, 10e-6}) {
        const shape::BorePlate plate{0.06, 0.06, 0.03, 0.02 + 2.0 * clearance, 0.025, 0.001};
        const test::MeshPair pair{"peg", shapePart(plate), shapePart(shape::Peg{0.02, 0.04, 0.001})};
        query::PartQueryRequest request;
        request.tolerance = kTolerance;
        query::PartQuery query(pair.field, pair.shell, request);
        Random random(5);
        Tally tally(kTolerance);
        for (int i = 0; i < 20; ++i) {
            const double angle = random.uniform(0.0, 2.0 * M_PI), in = random.uniform(0.5e-6, 60e-6);
            const Pose X_FS{Quat(Eigen::AngleAxisd(random.uniform(0.0, 6.0), Vec3::UnitZ())),
                            Vec3((clearance + in) * std::cos(angle), (clearance + in) * std::sin(angle), -0.02)};
            judge(query, X_FS, -in, -in, tally);
        }
        tally.print("pressed, " + std::to_string(std::lround(1e6 * clearance)) + " um");
        tally.require("pressed");
    }
}

}  // namespace
}  // namespace passung
