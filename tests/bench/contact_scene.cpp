#include "tests/bench/contact_scene.h"

#include <cmath>
#include <numbers>

#include "analysis/truth/mesh_oracle.h"
#include "analysis/truth/surface_tree.h"
#include "core/base/random.h"
#include "core/geometry/parallel.h"
#include "core/import/mesh_import.h"
#include "tests/bench/loop_subdivision.h"

namespace passung::bench {

namespace {

constexpr double kBunnySize = 0.15;
constexpr double kRingRadius = 20e-3, kTubeRadius = 6e-3;
constexpr std::uint32_t kRingSegments = 100, kTubeSegments = 60;
constexpr double kTarget = 1e-3;      // depth, and distance
constexpr double kMet = 5e-6;         // so near to the target is near enough: what is reached is what counts
constexpr double kSearch = 10e-6;     // resolution of the depth while searching
constexpr double kResolution = 2e-6;  // and of the result
constexpr double kStride = 0.5e-3;    // of the first pass inward
// Of the wrench: half of it changes the force by at most 0.011 % (20 poses of 4 N to 104 N).
constexpr double kDenseEdge = 0.2e-3;
constexpr int kBisections = 40;

struct Truth {
    truth::MeshOracle oracle;  // A: bunny, B: tool
    truth::SurfaceTree bunny_surface, tool_surface;
    explicit Truth(const ContactScene& scene)
        : oracle(scene.bunny, scene.tool), bunny_surface(oracle.a()), tool_surface(oracle.b()) {}
};

/// The tool comes down a line; all poses share the turn.
struct Line {
    Quat q;
    Vec3 direction;  // from the bunny's middle outward
    Pose at(double s) const { return {q, s * direction}; }
};

Line randomLine(Random& random) {
    const auto normals = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
    const Vec3 v = normals();
    return {Quat(random.normal(), v.x(), v.y(), v.z()).normalized(), normals().normalized()};
}

double separation(const Truth& truth, const Pose& pose) { return *truth.oracle.separation(pose); }

/// Positive while the tool is less deep than wanted [m].
double depthLeft(const Truth& truth, const Pose& pose) {
    return kTarget + truth.tool_surface.smallestDistance({truth.oracle.a()}, pose, kSearch).value;
}

/// Where `left` changes its sign between `outer` (≥ 0) and `inner` (< 0).
template <class Left>
double bisect(double outer, double inner, const Left& left) {
    double middle = outer;
    for (int i = 0; i < kBisections; ++i) {
        middle = 0.5 * (outer + inner);
        const double l = left(middle);
        if (std::abs(l) < kMet) break;
        (l >= 0.0 ? outer : inner) = middle;
    }
    return middle;
}

/// Where the tool, coming from far outside, is `kTarget` from the bunny: by sure steps, as long as the distance left.
double approach(const Truth& truth, const Line& line) {
    double s = truth.oracle.a().bounds().size().norm() + kRingRadius + kTubeRadius;
    for (int i = 0; i < 10'000 && s > 0.0; ++i) {
        const double left = separation(truth, line.at(s)) - kTarget;
        if (left < kMet) return s;
        s -= left;
    }
    return 0.0;
}

TruePose apartAt(const Truth& truth, const Pose& pose) {
    const double d = separation(truth, pose);
    return {.X_FS = pose, .shell_in_field = d, .field_in_shell = d, .uncertainty = 0.0, .one_way = {}, .two_way = {}};
}

TruePose pressedAt(const Truth& truth, const Pose& pose) {
    const truth::ExactMesh &bunny = truth.oracle.a(), &tool = truth.oracle.b();
    const Pose back = pose.inverse();
    const truth::SmallestDistance deep = truth.tool_surface.smallestDistance({bunny}, pose, kResolution);
    const truth::SmallestDistance other = truth.bunny_surface.smallestDistance({tool}, back, kResolution);
    TruePose result{.X_FS = pose,
                    .shell_in_field = deep.value,
                    .field_in_shell = other.value,
                    .uncertainty = std::max(deep.uncertainty, other.uncertainty),
                    .one_way = truth.tool_surface.penaltyWrench({bunny}, pose, kAreaStiffness, kDenseEdge),
                    .two_way = {}};
    // On the bunny about its origin, which lies at back.p in the tool's frame; there moved to the tool's origin, then
    // turned and reversed.
    const Wrench on_bunny = truth.bunny_surface.penaltyWrench({tool}, back, kAreaStiffness, kDenseEdge);
    const Vec3 force = -(pose.q * on_bunny.force);
    const Vec3 torque = -(pose.q * (on_bunny.torque + back.p.cross(on_bunny.force)));
    result.two_way = {0.5 * (result.one_way.force + force), 0.5 * (result.one_way.torque + torque)};
    return result;
}

}  // namespace

namespace {

/// Whole part and fraction rounded one after the other, then their sum: the coordinates that the stored poses and their
/// truth were made for.
double inSinglePrecision(double value) {
    const double whole = std::floor(std::abs(value));
    const float rounded = static_cast<float>(whole) + static_cast<float>(std::abs(value) - whole);
    return std::copysign(static_cast<double>(rounded), value);
}

}  // namespace

Result<geometry::TriangleMesh> loadBunny(const std::string& file) {
    auto imported = importer::importMesh(file, 1.0);
    if (!imported) return imported.errors();
    for (Vec3& v : imported->mesh.vertices)
        for (double& coordinate : v) coordinate = inSinglePrecision(coordinate);
    geometry::TriangleMesh mesh = subdivideLoop(subdivideLoop(imported->mesh));
    const geometry::Bounds bounds = geometry::boundsOf(mesh);
    const double scale = kBunnySize / bounds.size().maxCoeff();
    for (Vec3& v : mesh.vertices) v = scale * (v - 0.5 * (bounds.low + bounds.high));
    return mesh;
}

geometry::TriangleMesh torusTool() {
    geometry::TriangleMesh mesh;
    const auto index = [](std::uint32_t i, std::uint32_t j) {
        return (i % kRingSegments) * kTubeSegments + j % kTubeSegments;
    };
    for (std::uint32_t i = 0; i < kRingSegments; ++i) {
        const double u = 2.0 * std::numbers::pi * i / kRingSegments;
        for (std::uint32_t j = 0; j < kTubeSegments; ++j) {
            const double v = 2.0 * std::numbers::pi * j / kTubeSegments;
            const double rho = kRingRadius + kTubeRadius * std::cos(v);
            mesh.vertices.emplace_back(rho * std::cos(u), rho * std::sin(u), kTubeRadius * std::sin(v));
            mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    }
    return mesh;
}

ContactScene makeContactScene(geometry::TriangleMesh bunny, std::size_t count, std::uint64_t seed) {
    ContactScene scene{.bunny = std::move(bunny), .tool = torusTool(), .pressed = {}, .apart = {}};
    const Truth truth(scene);
    scene.pressed.resize(count);
    scene.apart.resize(count);
    geometry::parallelFor(count, [&](std::size_t i) {
        Random random(seed * 1'000'003 + i);
        for (;;) {  // a line that misses the bunny's body, or passes it, is not used
            const Line line = randomLine(random);
            const double apart = approach(truth, line);
            if (!(apart > 0.0)) continue;
            double inner = apart;
            double left = kTarget;
            while (inner > 0.0 && left >= 0.0) {
                inner -= kStride;
                left = depthLeft(truth, line.at(inner));
            }
            if (left >= 0.0) continue;
            const double deep = bisect(inner + kStride, inner, [&](double s) { return depthLeft(truth, line.at(s)); });
            scene.apart[i] = apartAt(truth, line.at(apart));
            scene.pressed[i] = pressedAt(truth, line.at(deep));
            return;
        }
    });
    return scene;
}

TruePose truthAt(const ContactScene& scene, const Pose& X_FS) {
    const Truth truth(scene);
    return separation(truth, X_FS) > 0.0 ? apartAt(truth, X_FS) : pressedAt(truth, X_FS);
}

}  // namespace passung::bench
