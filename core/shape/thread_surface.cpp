#include "core/shape/thread_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "core/geometry/triangle_builder.h"
#include "core/shape/circle_steps.h"

namespace passung::shape {

namespace {

using std::numbers::pi;
using Index = geometry::TriangleBuilder::Index;

constexpr double kSameAngle = 1e-9;    // [rad]
constexpr double kSameVertex = 1e-11;  // [m]

double inTurn(double phi) { return phi - 2.0 * pi * std::floor(phi / (2.0 * pi)); }

/// Angles where a line of the surface begins or ends: where corners of the profile and the chamfers' ends meet.
void addCorners(const ThreadSurface& surface, std::vector<double>& angles) {
    const ThreadForm& form = surface.form;
    const auto add = [&](double z, double r) {
        if (r < form.inner || r > form.outer) return;
        for (const double side : {-1.0, 1.0}) angles.push_back(inTurn((z + side * form.halfRidge(r)) / form.lead()));
    };
    for (const double end : {surface.low, surface.high})
        for (const double r : {form.inner, form.outer}) add(end, r);
    for (std::size_t i = 0; i < surface.cone_count; ++i) {
        const ThreadSurface::Cone& cone = surface.cones[i];
        for (const double end : {surface.low, surface.high}) add(end, cone.base + cone.slope * end);
        for (const double r : {form.inner, form.outer}) {
            const double z = (r - cone.base) / cone.slope;
            if (z >= surface.low && z <= surface.high) add(z, r);
        }
    }
}

/// Those in `corners`, and as many between them that none are farther apart than a whole turn's equal `segments`.
std::vector<double> anglesFor(std::vector<double> corners, int segments) {
    std::sort(corners.begin(), corners.end());
    std::vector<double> kept;
    for (const double corner : corners)
        if (kept.empty() || (corner - kept.back() > kSameAngle && kept[0] + 2.0 * pi - corner > kSameAngle))
            kept.push_back(corner);
    std::vector<double> angles;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const double room = (i + 1 < kept.size() ? kept[i + 1] : kept[0] + 2.0 * pi) - kept[i];
        const int pieces = std::max(1, static_cast<int>(std::ceil(room * segments / (2.0 * pi) - kSameAngle)));
        for (int k = 0; k < pieces; ++k) angles.push_back(kept[i] + room * k / pieces);
    }
    return angles;
}

/// A surface in slices between half planes, none of which has a corner within.
class SlicedThread {
public:
    SlicedThread(const ThreadSurface& surface, std::vector<double> angles)
        : surface_(surface), angles_(std::move(angles)), vertices_(angles_.size()) {}

    std::size_t count() const { return angles_.size(); }
    double angle(std::size_t i) const { return angles_[i]; }
    std::size_t next(std::size_t i) const { return (i + 1) % count(); }

    /// All triangles between its ends.
    void build(geometry::TriangleBuilder& builder) {
        for (std::size_t i = 0; i < count(); ++i) {
            const double from = angles_[i], to = next(i) == 0 ? angles_[0] + 2.0 * pi : angles_[next(i)];
            const double middle = 0.5 * (from + to);
            surface_.eachPiece(middle, surface_.low, surface_.high,
                               [&](const ThreadSurface::Knot& low, const ThreadSurface::Knot& high) {
                                   const Index a = vertexAt(i, low, from - middle, builder),
                                               b = vertexAt(next(i), low, to - middle, builder),
                                               c = vertexAt(next(i), high, to - middle, builder),
                                               d = vertexAt(i, high, from - middle, builder);
                                   add(a, b, c, builder);
                                   add(a, c, d, builder);
                               });
        }
    }

    /// Of an end of the surface.
    Index lowest(std::size_t i) const { return vertices_[i].begin()->second; }
    Index highest(std::size_t i) const { return vertices_[i].rbegin()->second; }

private:
    Index vertexAt(std::size_t i, const ThreadSurface::Knot& knot, double turned, geometry::TriangleBuilder& builder) {
        const double z = std::clamp(knot.z + turned * knot.z_by_phi, surface_.low, surface_.high);
        const double r = knot.r + turned * knot.r_by_phi;
        std::map<double, Index>& there = vertices_[i];
        const auto near = there.lower_bound(z - kSameVertex);
        if (near != there.end() && near->first <= z + kSameVertex) return near->second;
        const Index made = builder.vertex(r * std::cos(angles_[i]), r * std::sin(angles_[i]), z);
        there.emplace(z, made);
        return made;
    }

    void add(Index a, Index b, Index c, geometry::TriangleBuilder& builder) const {
        if (a == b || b == c || c == a) return;
        surface_.hole ? builder.triangle(a, c, b) : builder.triangle(a, b, c);
    }

    const ThreadSurface& surface_;
    std::vector<double> angles_;
    std::vector<std::map<double, Index>> vertices_;  // of each half plane, by height
};

/// Two triangles of a flank's piece lie off its saddle by no more than `twist` for each radian that it spans: with its
/// corners at r1, r2 a diagonal's middle lies at the share r2/(r1 + r2) of the angle, not at its half.
struct ThreadSteps {
    int segments;
    double error;
};

ThreadSteps stepsFor(const ThreadSurface& surface, double chord_error) {
    const ThreadForm& form = surface.form;
    double widest = std::max(form.outer, surface.around);
    for (std::size_t i = 0; i < surface.cone_count && surface.hole; ++i)
        widest = std::max({widest, surface.cones[i].base + std::max(surface.cones[i].slope * surface.low,
                                                                    surface.cones[i].slope * surface.high)});
    const double depth = form.outer - form.inner;
    const double twist = 0.5 * form.lead() * depth / (form.outer + form.inner);
    const double half = 0.5 * chord_error;
    const int for_twist = static_cast<int>(std::min<double>(kMostSegments, std::ceil(2.0 * pi * twist / half)));
    const int segments = std::max(segmentsFor(widest, half), (for_twist + 3) / 4 * 4);
    // A spiral's chord is nearer to the axis than a circle's by a share of (dr/dφ / r)².
    const double spiral = 2.0 * std::pow(form.lead() / (form.run * form.inner), 2);
    return {segments,
            (1.0 + spiral) * widest * (1.0 - std::cos(pi / segments) + kVertexRounding) + twist * 2.0 * pi / segments};
}

/// `out`: 1 of a nut, -1 of a bolt.
template <class Thread>
ThreadForm formOf(const Thread& thread, double out) {
    const double outer = 0.5 * thread.nominal_diameter + out * thread.clearance, half = 0.5 * thread.flank_angle;
    const double height = thread.flank_height > 0.0 ? thread.flank_height : 0.3125 * std::numbers::sqrt3 * thread.pitch;
    return {thread.pitch, outer, outer - height, std::tan(half),
            out * thread.clearance * (0.5 - std::sin(half)) / std::cos(half)};
}

}  // namespace

ThreadForm threadOf(const ThreadBolt& bolt) { return formOf(bolt, -1.0); }
ThreadForm threadOf(const ThreadNut& nut) { return formOf(nut, 1.0); }

double ThreadForm::mostBetweenEdges() const {
    const double secant = std::sqrt(1.0 + run * run), width = (outer - inner) * secant;
    return lead() * lead() * width * width / (8.0 * secant * run * inner * inner * inner);
}

double ThreadForm::radiusAt(double zeta) const {
    const double from_ridge = std::abs(zeta - pitch * std::round(zeta / pitch));
    return std::clamp(outer - (from_ridge - crest()) / run, inner, outer);
}

std::array<ThreadForm::Line, 4> ThreadForm::lines() const {
    const double low = root(), high = crest(), steep = 1.0 / run;
    return {Line{-low, -high, outer + steep * high, steep}, Line{-high, high, outer, 0.0},
            Line{high, low, outer + steep * high, -steep}, Line{low, pitch - low, inner, 0.0}};
}

ThreadSurface surfaceOf(const ThreadBolt& bolt) {
    ThreadSurface surface{threadOf(bolt), 0.0, bolt.length, false, bolt.chamfer};
    if (bolt.chamfer > 0.0) surface.cones[surface.cone_count++] = {surface.form.outer - bolt.chamfer, 1.0};
    return surface;
}

ThreadSurface surfaceOf(const ThreadNut& nut) {
    ThreadSurface surface{threadOf(nut), -nut.height, 0.0, true, nut.chamfer, 0.5 * nut.outer_diameter};
    if (!(nut.chamfer > 0.0)) return surface;
    const double mouth = surface.form.inner + nut.chamfer;
    surface.cones = {ThreadSurface::Cone{mouth, 1.0}, ThreadSurface::Cone{mouth - nut.height, -1.0}};
    surface.cone_count = 2;
    return surface;
}

geometry::TriangleMesh tessellateShape(const ThreadBolt& bolt, double chord_error) {
    const ThreadSurface surface = surfaceOf(bolt);
    std::vector<double> corners;
    addCorners(surface, corners);
    SlicedThread thread(surface, anglesFor(corners, stepsFor(surface, chord_error).segments));
    geometry::TriangleBuilder builder;
    thread.build(builder);
    const Index tip = builder.vertex(0.0, 0.0, surface.low), end = builder.vertex(0.0, 0.0, surface.high);
    for (std::size_t i = 0; i < thread.count(); ++i) {
        builder.triangle(tip, thread.lowest(thread.next(i)), thread.lowest(i));
        builder.triangle(end, thread.highest(i), thread.highest(thread.next(i)));
    }
    return builder.take();
}

geometry::TriangleMesh tessellateShape(const ThreadNut& nut, double chord_error) {
    const ThreadSurface surface = surfaceOf(nut);
    std::vector<double> corners;
    addCorners(surface, corners);
    SlicedThread thread(surface, anglesFor(corners, stepsFor(surface, chord_error).segments));
    geometry::TriangleBuilder builder;
    thread.build(builder);
    std::vector<Index> top, bottom;
    for (std::size_t i = 0; i < thread.count(); ++i) {
        const double phi = thread.angle(i), r = surface.around;
        top.push_back(builder.vertex(r * std::cos(phi), r * std::sin(phi), surface.high));
        bottom.push_back(builder.vertex(r * std::cos(phi), r * std::sin(phi), surface.low));
    }
    for (std::size_t i = 0; i < thread.count(); ++i) {
        const std::size_t k = thread.next(i);
        builder.quad(bottom[i], bottom[k], top[k], top[i]);
        builder.quad(top[i], top[k], thread.highest(k), thread.highest(i));
        builder.quad(bottom[k], bottom[i], thread.lowest(i), thread.lowest(k));
    }
    return builder.take();
}

double reachedError(const ThreadBolt& bolt, double asked) { return stepsFor(surfaceOf(bolt), asked).error; }
double reachedError(const ThreadNut& nut, double asked) { return stepsFor(surfaceOf(nut), asked).error; }

}  // namespace passung::shape
