#include "tests/bench/convergence_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/scene/part.h"

namespace passung::bench {

namespace {

constexpr double kRadius = 10e-3;   // of the ball
constexpr double kBoxEdge = 20e-3;  // of the cube
constexpr int kSamples = 20'000, kPoses = 400;
constexpr std::uint64_t kSeed = 20260401;
constexpr std::array kCells{1e-3, 0.5e-3, 0.25e-3};
constexpr std::array kSpacings{2e-3, 1e-3, 0.5e-3};

Vec3 anyDirection(Random& random) { return Vec3(random.normal(), random.normal(), random.normal()).normalized(); }

Result<scene::Part> build(const shape::Shape& shape, const scene::PartNeeds& needs) {
    scene::PartSpec spec;
    spec.name = "convergence";
    spec.geometry = shape;
    return scene::buildPart(spec, needs);
}

/// Errors of the field with cells of edge `cell` at points that `pick(cell, random)` chooses [µm].
template <class Pick>
Result<Times> fieldErrors(const shape::Shape& shape, double cell, const Pick& pick) {
    const auto part = build(shape, {.field = true, .cell = cell});
    if (!part) return part.errors();
    Random random(kSeed);
    std::vector<double> errors;
    for (int i = 0; i < kSamples; ++i) {
        const Vec3 p = pick(cell, random);
        const double phi = part->field->sample(p, field::FieldMode::Trilinear).phi;
        errors.push_back(kUm * std::abs(phi - shape::signedDistance(shape, p)));
    }
    return summarise(errors);
}

/// A point near the ball's surface.
Vec3 nearBall(double cell, Random& random) {
    return (kRadius + cell * random.uniform(-1.0, 1.0)) * anyDirection(random);
}

/// A point about as far from one of the cube's vertical edges as a cell is long, well away from the corners.
Vec3 nearEdge(double cell, Random& random) {
    const double half = 0.5 * kBoxEdge;
    return {half + cell * random.uniform(-1.0, 1.0), half + cell * random.uniform(-1.0, 1.0),
            half * random.uniform(-0.5, 0.5)};
}

/// How much less deep than the ball itself its points, turned at random about its centre at `centre`, are in the cube
/// [µm]; `depth`: the ball's.
Result<Times> depthErrors(const Vec3& centre, double depth, double spacing) {
    const shape::Shape cube = shape::Box{kBoxEdge, kBoxEdge, kBoxEdge};
    const auto ball = build(shape::Sphere{2.0 * kRadius}, {.shell = true, .tolerance = 5e-6, .spacing = spacing});
    if (!ball) return ball.errors();
    Random random(kSeed);
    std::vector<double> errors;
    for (int i = 0; i < kPoses; ++i) {
        const Quat turn = Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
        double least = std::numeric_limits<double>::infinity();
        for (const shell::SurfacePoint& point : ball->shell->points())
            least = std::min(least, shape::signedDistance(cube, turn * point.position + centre));
        errors.push_back(kUm * (depth + least));
    }
    return summarise(errors);
}

/// One row per method: the errors of the finest resolution and the order over all.
template <class Measure>
Result<Row> orderOver(const std::array<double, 3>& resolutions, const char* method, const char* what,
                      const Measure& measure) {
    Row row{.group = kConvergenceGroup, .method = method, .settings = {}, .ours = true};
    std::array<double, 3> means{};
    for (std::size_t i = 0; i < resolutions.size(); ++i) {
        const Result<Times> errors = measure(resolutions[i]);
        if (!errors) return errors.errors();
        means[i] = errors->mean;
        row.distance_error_um = *errors;
        row.settings += fmt::format("{}{} {:g} mm: {:.3g} um", i > 0 ? ", " : "mean error at ", what,
                                    1e3 * resolutions[i], errors->mean);
    }
    row.order = std::log2(means.front() / means.back()) / static_cast<double>(resolutions.size() - 1);
    return row;
}

}  // namespace

Result<std::vector<Row>> convergenceRows(const Extent& extent) {
    std::vector<Row> rows;
    Errors errors;
    const auto add = [&](const std::array<double, 3>& resolutions, const char* method, const char* what,
                         const auto& measure) {
        if (!extent.wanted(kConvergenceGroup, method)) return;
        const auto row = orderOver(resolutions, method, what, measure);
        if (row)
            rows.push_back(*row);
        else
            errors.insert(errors.end(), row.errors().begin(), row.errors().end());
    };
    const double half = 0.5 * kBoxEdge, depth = 0.5e-3;
    add(kCells, kCellOnSmooth, "cell",
        [](double cell) { return fieldErrors(shape::Sphere{2.0 * kRadius}, cell, nearBall); });
    add(kCells, kCellAtEdges, "cell", [](double cell) {
        return fieldErrors(shape::Box{kBoxEdge, kBoxEdge, kBoxEdge}, cell, nearEdge);
    });
    add(kSpacings, kSpacingOnSmooth, "spacing", [&](double spacing) {
        return depthErrors({0.0, 0.0, half + kRadius - depth}, depth, spacing);
    });
    // The ball comes along the bisector: its deepest point is as far from both faces, a - R/√2 from the edge.
    add(kSpacings, kSpacingAtEdges, "spacing", [&](double spacing) {
        const double a = half + kRadius / std::sqrt(2.0) - depth;
        return depthErrors({a, a, 0.0}, depth, spacing);
    });
    if (!errors.empty()) return errors;
    return rows;
}

}  // namespace passung::bench
