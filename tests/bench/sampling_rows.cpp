#include "tests/bench/sampling_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "analysis/truth/exact_mesh.h"
#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "tests/bench/flat_array.h"
#include "tests/bench/ours.h"
#include "tests/bench/stopwatch.h"

namespace passung::bench {

namespace {

constexpr std::size_t kPoints = 131'072;
constexpr std::size_t kErrorPoints = 20'000;
constexpr double kCellsAlongLongest = 256.0;
constexpr double kBandCells = 4.0;
constexpr int kMarginCells = 6;
constexpr int kBuilds = 3;
constexpr double kFinerTolerance = 80e-6;
/// Fields are compared so far from the surface. Interpolation there takes nodes a cell's diagonal farther: kBandCells.
constexpr double kTestedCells = 2.0;

/// Bits of a coordinate, two zeros between each.
std::uint64_t spread(std::uint32_t v) {
    std::uint64_t bits = 0;
    for (unsigned i = 0; i < 20; ++i) bits |= static_cast<std::uint64_t>((v >> i) & 1u) << (3u * i);
    return bits;
}

std::uint64_t mortonCode(const Vec3& p, const geometry::Bounds& bounds) {
    const Vec3 u = (p - bounds.low) / bounds.size().maxCoeff() * 1'000'000.0;
    return spread(static_cast<std::uint32_t>(u.x())) | spread(static_cast<std::uint32_t>(u.y())) << 1 |
           spread(static_cast<std::uint32_t>(u.z())) << 2;
}

/// Points of the surface, evenly by area, along a Morton curve.
std::vector<Vec3> surfacePoints(const geometry::TriangleMesh& mesh, std::size_t count, Random& random) {
    std::vector<double> sum;
    double area = 0.0;
    for (const auto& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        area += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
        sum.push_back(area);
    }
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        const auto found = std::lower_bound(sum.begin(), sum.end(), area * random.uniform());
        const auto& t = mesh.triangles[static_cast<std::size_t>(found - sum.begin())];
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const Vec3& a = mesh.vertices[t[0]];
        points.push_back(a + u * (mesh.vertices[t[1]] - a) + v * (mesh.vertices[t[2]] - a));
    }
    const geometry::Bounds bounds = geometry::boundsOf(mesh);
    std::sort(points.begin(), points.end(),
              [&](const Vec3& p, const Vec3& q) { return mortonCode(p, bounds) < mortonCode(q, bounds); });
    return points;
}

/// The points of one run: given in a turned and shifted frame, so that the transform is part of the time.
struct Sampling {
    Pose X;
    std::vector<Vec3> points;
    std::vector<double> phi;
    int repetitions;

    template <class Run>
    Row measure(const std::string& method, const std::string& settings, bool ours, const Run& run) {
        Row row{.group = kSamplingGroup, .method = method, .settings = settings, .ours = ours};
        row.samples = points.size();
        run();
        std::vector<double> times;
        for (int i = 0; i < repetitions; ++i) {
            const Stopwatch watch;
            run();
            times.push_back(kUm * watch.seconds());
        }
        row.time_us = summarise(times);
        row.ns_per_point = 1e3 * *std::min_element(times.begin(), times.end()) / static_cast<double>(points.size());
        std::vector<double> errors;
        for (const double value : phi) errors.push_back(kUm * std::abs(value));
        row.distance_error_um = summarise(errors);
        return row;
    }
};

/// Of the field at points of the surface.
Times errorsOf(const std::vector<float>& phi) {
    std::vector<double> errors;
    for (const float value : phi) errors.push_back(kUm * std::abs(static_cast<double>(value)));
    return summarise(errors);
}

std::size_t countOtherBits(const std::vector<float>& values, const std::vector<float>& others) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        count += std::bit_cast<std::uint32_t>(values[i]) != std::bit_cast<std::uint32_t>(others[i]) ? 1 : 0;
    return count;
}

/// `field` at the nodes of one array around the part; a float holds metres, a short 1/32767 of the margin.
template <class Value>
FlatArray<Value> flatArray(const field::DistanceField& field, double cell) {
    FlatArray<Value> flat;
    flat.cell = cell;
    flat.origin = field.bounds().low - Vec3::Constant(kMarginCells * cell);
    const bool rounded = std::numeric_limits<Value>::is_integer;
    const double steps = 32767.0;
    if (rounded) flat.scale = static_cast<float>(2.0 * kMarginCells * cell / steps);
    for (int axis = 0; axis < 3; ++axis)
        flat.nodes[static_cast<std::size_t>(axis)] =
            static_cast<int>(field.bounds().size()[axis] / cell) + 2 * kMarginCells + 1;
    for (int z = 0; z < flat.nodes[2]; ++z)
        for (int y = 0; y < flat.nodes[1]; ++y)
            for (int x = 0; x < flat.nodes[0]; ++x) {
                const Vec3 node = flat.origin + cell * Vec3(x, y, z);
                const double phi = field.sample(node, field::FieldMode::Trilinear).phi / flat.scale;
                flat.values.push_back(static_cast<Value>(rounded ? std::clamp(std::round(phi), -steps, steps) : phi));
            }
    return flat;
}

/// The worst errors at points within two cells of the surface.
template <class Sample>
Times bandErrors(const truth::ExactMesh& exact, const std::vector<Vec3>& points, const Sample& sample) {
    std::vector<double> errors;
    for (const Vec3& p : points) errors.push_back(kUm * std::abs(sample(p) - exact.signedDistance(p)));
    return summarise(errors);
}

}  // namespace

Result<std::vector<Row>> samplingRows(const geometry::TriangleMesh& bunny, const Extent& extent) {
    std::vector<Row> rows;
    const auto wanted = [&](const char* group) { return extent.wanted(group, ""); };
    if (!wanted(kSamplingGroup) && !wanted(kBuildGroup)) return rows;
    const double cell = geometry::boundsOf(bunny).size().maxCoeff() / kCellsAlongLongest;
    PartStore store(bunny);
    auto built = store.withCell(cell);
    if (!built) return built.errors();
    const field::DistanceField& field = *built->part.field;
    const auto level_set = buildLevelSet(bunny, cell, kBandCells);

    Random random(20260301);
    if (wanted(kSamplingGroup)) {
        Sampling sampling{.X = {rotationFromVector({0.3, -0.5, 0.7}), Vec3(0.01, 0.02, -0.03)},
                          .points = surfacePoints(bunny, kPoints, random),
                          .phi = std::vector<double>(kPoints),
                          .repetitions = extent.few_settings ? 2 : 50};
        const Pose inverse = sampling.X.inverse();
        for (Vec3& p : sampling.points) p = inverse * p;
        const Mat3 turn = sampling.X.q.toRotationMatrix();
        const Vec3 shift = sampling.X.p;
        rows.push_back(sampling.measure("passung sample", "value and gradient, double, point by point", true, [&] {
            for (std::size_t i = 0; i < kPoints; ++i)
                sampling.phi[i] = field.sample(turn * sampling.points[i] + shift, field::FieldMode::Trilinear).phi;
        }));
        rows.back().memory_MB = 1e-6 * static_cast<double>(field.memoryBytes());
        std::vector<float> x, y, z, phi(kPoints);
        for (const Vec3& p : sampling.points) {
            x.push_back(static_cast<float>(p.x()));
            y.push_back(static_cast<float>(p.y()));
            z.push_back(static_cast<float>(p.z()));
        }
        std::vector<float> first_bits;
        for (const auto& [instructions, name] :
             {std::pair(field::Instructions::Baseline, "baseline"), std::pair(field::Instructions::V3, "AVX2"),
              std::pair(field::Instructions::V4, "AVX-512")}) {
            if (instructions > field::bestInstructions()) continue;
            rows.push_back(sampling.measure(
                "passung sampleMany", fmt::format("value, {} instructions", name), true,
                [&, variant = instructions] { field.sampleMany(field.place(sampling.X), x, y, z, phi, variant); }));
            if (first_bits.empty()) first_bits = phi;
            rows.back().other_bits = static_cast<double>(countOtherBits(phi, first_bits));
            rows.back().distance_error_um = errorsOf(phi);
            rows.back().memory_MB = 1e-6 * static_cast<double>(field.memoryBytes());
        }
        const auto addFlat = [&](const auto& flat, const char* settings) {
            rows.push_back(
                sampling.measure(kFlatArray, settings, false, [&] { flat.sample(sampling.X, x, y, z, phi); }));
            rows.back().distance_error_um = errorsOf(phi);
            rows.back().memory_MB = 1e-6 * static_cast<double>(flat.values.size() * sizeof(flat.values[0]));
        };
        addFlat(flatArray<std::int16_t>(field, cell), "16 bit, single precision, one loop");
        addFlat(flatArray<float>(field, cell), "float, single precision, one loop");
        rows.push_back(sampling.measure("OpenVDB", "BoxSampler, float grid, point by point", false,
                                        [&] { level_set->sample(sampling.X, sampling.points, sampling.phi); }));
        rows.back().memory_MB = 1e-6 * level_set->memoryBytes();
    }
    if (wanted(kBuildGroup)) {
        const truth::ExactMesh exact(bunny);
        std::vector<Vec3> points = surfacePoints(bunny, kErrorPoints, random);
        for (Vec3& p : points)
            p += kTestedCells * cell * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) /
                 std::sqrt(3.0);
        const auto add = [&](const std::string& method, const std::string& what, bool ours, double seconds,
                             double bytes, const Times& errors) {
            Row row{.group = kBuildGroup,
                    .method = method,
                    .settings = fmt::format("cell {:.3g} mm{}; processor time of all threads", 1e3 * cell, what),
                    .ours = ours};
            row.samples = points.size();
            row.distance_error_um = errors;
            row.memory_MB = 1e-6 * bytes;
            row.build_s = seconds;
            rows.push_back(row);
        };
        // Time and error count for the marks in one row only, which has both.
        const auto addField = [&](const std::string& what, bool counts, double seconds,
                                  const field::DistanceField& of) {
            add("passung field", what, counts, seconds, static_cast<double>(of.memoryBytes()),
                bandErrors(exact, points,
                           [&](const Vec3& p) { return of.sample(p, field::FieldMode::Trilinear).phi; }));
        };
        // By turns, so that a busy machine hits all; the fastest of each counts.
        std::vector<double> seconds(4, std::numeric_limits<double>::infinity());
        std::optional<field::DistanceField> even, finer, wide;
        const field::FieldAccuracy near{.reach = cell};
        const field::FieldAccuracy near_finer{
            .tolerance = kFinerTolerance, .depth = kTestedCells * cell, .reach = cell};
        for (int i = 0; i < (extent.few_settings ? 1 : kBuilds); ++i) {
            const auto timed = [&](std::size_t k, const auto& run) {
                const ProcessorTime watch;
                run();
                seconds[k] = std::min(seconds[k], watch.seconds());
            };
            const auto build = [&](const field::FieldAccuracy& accuracy) {
                auto of =
                    field::DistanceField::build(scene::exactSource(built->part), cell, kTestedCells * cell, accuracy);
                return of ? std::optional(std::move(*of)) : std::nullopt;
            };
            timed(0, [&] { buildLevelSet(bunny, cell, kBandCells); });
            timed(1, [&] { even = build(near); });
            timed(2, [&] { finer = build(near_finer); });
            timed(3, [&] { wide = build({.largest_cell = 2.0 * cell}); });
        }
        if (!even || !finer || !wide) return Error{.message = "a field of the bunny was refused"};
        addField(", 2 cells around the surface", false, seconds[1], *even);
        addField(fmt::format(", 2 cells around the surface, finer where it errs by more than {:g} um",
                             kUm * kFinerTolerance),
                 true, seconds[2], *finer);
        addField(", and larger ones as far as the part is long", false, seconds[3], *wide);
        add(kVdbBuild, ", 4 cells around the surface", false, seconds[0], level_set->memoryBytes(),
            bandErrors(exact, points, [&](const Vec3& p) {
                double phi = 0.0;
                level_set->sample(Pose{}, {&p, 1}, {&phi, 1});
                return phi;
            }));
    }
    return rows;
}

}  // namespace passung::bench
