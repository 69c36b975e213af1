#include "tests/hard/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/truth/mesh_oracle.h"

namespace passung::hard {

const scene::PartSpec& heldPart(const scene::SceneSpec& spec) {
    return *std::find_if(spec.parts.begin(), spec.parts.end(), [](const auto& part) { return part.held; });
}

const scene::PartSpec& fixedPart(const scene::SceneSpec& spec) {
    return *std::find_if(spec.parts.begin(), spec.parts.end(), [](const auto& part) { return !part.held; });
}

DenseDistance denseDistance(const Run& run, double spacing) {
    std::vector<std::pair<DenseBody, Pose>> obstacles;
    DenseBody held;
    for (const scene::PartSpec& part : run.solids.parts) {
        DenseBody body = denseBody(std::get<shape::Shape>(part.geometry), spacing);
        if (part.held)
            held = std::move(body);
        else
            obstacles.emplace_back(std::move(body), part.X_WP);
    }
    return {std::move(held), std::move(obstacles)};
}

double deepestOverlap(const Run& run, double spacing) {
    constexpr int kBetween = 7;  // parts of the way between two ticks, looked at where the methods do not
    DenseDistance distance = denseDistance(run, spacing);
    double deepest = 0.0;
    for (std::size_t i = 0; i < run.ticks.size(); ++i) {
        const Pose& here = run.ticks[i].proxy;
        if (i > 0) {
            const Pose& from = run.ticks[i - 1].proxy;
            for (int k = 1; k < kBetween; ++k) {
                const double share = static_cast<double>(k) / kBetween;
                const Pose between{from.q.slerp(share, here.q), from.p + share * (here.p - from.p)};
                deepest = -distance.least(between, -deepest);
            }
        }
        deepest = -distance.least(here, -deepest);
    }
    return deepest;
}

double deepestShown(const Run& run) {
    DenseDistance distance = denseDistance(run);
    double deepest = 0.0;
    for (const Tick& tick : run.ticks) deepest = -distance.least(tick.proxy, -deepest);
    return deepest;
}

namespace {

/// Every length shorter by 2 × `by`, so that the surface lies `by` deeper on every side of a box, cylinder or ball.
shape::Shape shrunk(const shape::Shape& shape, double by) {
    if (const auto* box = std::get_if<shape::Box>(&shape))
        return shape::Box{box->width - 2 * by, box->depth - 2 * by, box->height - 2 * by};
    if (const auto* ball = std::get_if<shape::Sphere>(&shape)) return shape::Sphere{ball->diameter - 2 * by};
    const auto& cylinder = std::get<shape::Cylinder>(shape);
    return shape::Cylinder{cylinder.diameter - 2 * by, cylinder.length - 2 * by};
}

}  // namespace

double crossings(const Run& run) {
    const scene::PartSpec &held = heldPart(run.spec), &thin = fixedPart(run.spec);
    const shape::Shape tool = shrunk(std::get<shape::Shape>(held.geometry), run.spec.contact.tolerance);
    const double chord = std::holds_alternative<shape::Box>(tool) ? 1e-3 : 5e-6;
    const truth::MeshOracle oracle(shape::tessellate(std::get<shape::Shape>(thin.geometry), chord),
                                   shape::tessellate(tool, chord));
    double reach = 0.0;
    for (const Vec3& v : shape::tessellate(tool, chord).vertices) reach = std::max(reach, v.norm());
    constexpr double kStep = 0.5e-3;  // no point of the tool moves farther between two looks
    double found = 0.0;
    const Pose X_TW = thin.X_WP.inverse();
    const double near = reach + 0.5 * oracle.a().bounds().size().norm();
    Pose last = held.X_WP;
    for (const Tick& t : run.ticks) {
        const double way = (t.proxy.p - last.p).norm() + reach * rotationVector(t.proxy.q * last.q.conjugate()).norm();
        const int n = way > 0.0 ? static_cast<int>(std::ceil(way / kStep)) : 0;
        for (int i = 1; i <= n; ++i) {
            const double share = static_cast<double>(i) / n;
            const Pose X{last.q.slerp(share, t.proxy.q), last.p + share * (t.proxy.p - last.p)};
            if ((X_TW * X.p).norm() < near && *oracle.surfacesIntersect(X_TW * X)) found += 1.0;
        }
        last = t.proxy;
    }
    return found;
}

double insertedDepth(const Run& run) {
    const Pose X_PW = fixedPart(run.spec).X_WP.inverse();
    double depth = 0.0;
    for (const Tick& t : run.ticks) depth = std::max(depth, -(X_PW * t.proxy.p).z());
    return depth;
}

double rmsAbove(const std::vector<double>& signal, double hz) {
    const auto n = signal.size();
    double mean = 0.0;
    for (const double x : signal) mean += x / static_cast<double>(n);
    std::vector<double> windowed(n);
    double power = 0.0, gain = 0.0;
    const double turn = 2.0 * std::numbers::pi / static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double w = 0.5 - 0.5 * std::cos(turn * static_cast<double>(i));
        windowed[i] = w * (signal[i] - mean);
        power += windowed[i] * windowed[i];
        gain += w * w;
    }
    // Parseval: what the bins up to `hz` hold is taken from the whole.
    const auto last = static_cast<std::size_t>(hz * kTickSeconds * static_cast<double>(n));
    for (std::size_t k = 0; k <= last; ++k) {
        std::complex<double> sum;
        const std::complex<double> step = std::polar(1.0, -turn * static_cast<double>(k));
        std::complex<double> phase = 1.0;
        for (std::size_t i = 0; i < n; ++i, phase *= step) sum += windowed[i] * phase;
        power -= (k == 0 ? 1.0 : 2.0) * std::norm(sum) / static_cast<double>(n);
    }
    return std::sqrt(std::max(0.0, power) / gain);
}

Judgement overlapUm(const Run& run) { return {kUm * deepestOverlap(run)}; }

Judgement crossingCount(const Run& run) { return {crossings(run)}; }

Judgement insertedUm(const Run& run) {
    const shape::Shape& plate = std::get<shape::Shape>(fixedPart(run.solids).geometry);
    double depth = 0.0;
    for (const shape::Dimension& d : shape::namedDimensions(plate))
        if (std::string(d.key) == "bore_depth") depth = d.value;
    Judgement result{kUm * deepestOverlap(run, 0.1 * depth)};
    const double reached = insertedDepth(run);
    if (reached < 0.95 * depth) result.broken = fmt::format("inserted {:.3g} of {:.3g} mm", 1e3 * reached, 1e3 * depth);
    return result;
}

Judgement overlapPerPenalty(const Run& run) {
    scene::SceneSpec spec = run.spec;
    spec.contact.method = scene::ContactMethod::Penalty;
    const auto again = [&](std::int64_t tick, const tick::TickOutput*) {
        return run.readings[static_cast<std::size_t>(tick)];
    };
    auto penalty = runScene(spec, again, static_cast<std::int64_t>(run.readings.size()));
    if (!penalty) return {.broken = toString(penalty.errors().front())};
    penalty->solids = run.solids;
    const double ours = deepestOverlap(run), theirs = deepestOverlap(*penalty);
    Judgement result{ours / theirs};
    if (!(theirs > 0.1e-3)) result.broken = fmt::format("the penalty overlaps by {:.3g} um only", kUm * theirs);
    return result;
}

}  // namespace passung::hard
