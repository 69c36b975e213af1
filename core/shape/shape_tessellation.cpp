#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/geometry/triangle_builder.h"
#include "core/shape/circle_steps.h"
#include "core/shape/profile.h"
#include "core/shape/shape.h"
#include "core/shape/thread_surface.h"

namespace passung::shape {

namespace {

using std::numbers::pi;
using Index = geometry::TriangleBuilder::Index;
using PointRing = geometry::TriangleBuilder::Ring;

/// Largest distance between the sphere of radius 1 and a triangle with corners on it: at its circumcentre, or nearer.
double sphereError(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = (b - a).cross(c - a).normalized();
    return 1.0 - std::abs(normal.dot(a));
}

/// Vertex (i, j) of an octant in `rows` rows: row i lies at the polar angle i/rows of a right angle, j/i along it.
/// Edges then differ in length by at most 1.6, without the slivers that meridians make at the poles.
Vec3 octantPoint(int i, int j, int rows) {
    const double theta = 0.5 * pi * i / rows;
    const double phi = i > 0 ? 0.5 * pi * j / i : 0.0;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

double octantError(int rows) {
    double error = 0.0;
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j <= i; ++j) {
            const Vec3 a = octantPoint(i, j, rows), b = octantPoint(i + 1, j, rows),
                       c = octantPoint(i + 1, j + 1, rows);
            error = std::max(error, sphereError(a, b, c));
            if (j < i) error = std::max(error, sphereError(a, c, octantPoint(i, j + 1, rows)));
        }
    }
    return error;
}

int rowsFor(double radius, double chord_error) {
    int rows = segmentsFor(radius, chord_error) / 4;
    const double allowed = chord_error / radius;
    for (double error = octantError(rows); error > allowed && rows < kMostSegments / 4; error = octantError(rows))
        rows = std::min(kMostSegments / 4, std::max(rows + 1, static_cast<int>(rows * std::sqrt(error / allowed))));
    return rows;
}

/// Rows of octants from the north pole over the equator to the south pole. PointRing i has 4i vertices.
geometry::TriangleMesh tessellateShape(const Sphere& sphere, double chord_error) {
    const double radius = 0.5 * sphere.diameter;
    const int rows = rowsFor(radius, chord_error);
    geometry::TriangleBuilder builder;
    const auto makeRing = [&](int i, double hemisphere) {
        if (i == 0) return PointRing{builder.vertex(0.0, 0.0, hemisphere * radius)};
        if (i == rows) return builder.ring(radius, 0.0, 4 * i);
        const double theta = 0.5 * pi * i / rows;
        return builder.ring(radius * std::sin(theta), hemisphere * radius * std::cos(theta), 4 * i);
    };
    // `small` has 4i vertices, `large` 4(i+1); `small` lies nearer to the pole.
    const auto joinRings = [&](const PointRing& small, const PointRing& large, int i, bool north) {
        for (int q = 0; q < 4; ++q) {
            const auto inner = [&](int j) {
                return small[static_cast<std::size_t>(i == 0 ? 0 : (q * i + j) % (4 * i))];
            };
            const auto outer = [&](int j) {
                return large[static_cast<std::size_t>((q * (i + 1) + j) % (4 * (i + 1)))];
            };
            for (int j = 0; j <= i; ++j) {
                const Index a = inner(j), b = outer(j), c = outer(j + 1);
                north ? builder.triangle(a, b, c) : builder.triangle(a, c, b);
                if (j == i) continue;
                const Index d = inner(j + 1);
                north ? builder.triangle(a, c, d) : builder.triangle(a, d, c);
            }
        }
    };
    PointRing previous = makeRing(0, 1.0);
    for (int m = 1; m <= 2 * rows; ++m) {
        const bool north = m <= rows;
        const PointRing next = makeRing(north ? m : 2 * rows - m, north ? 1.0 : -1.0);
        north ? joinRings(previous, next, m - 1, true) : joinRings(next, previous, 2 * rows - m, false);
        previous = next;
    }
    return builder.take();
}

geometry::TriangleMesh tessellateShape(const Box& box, double) {
    geometry::TriangleBuilder builder;
    const PointRing low = builder.rectangle(0.5 * box.width, 0.5 * box.depth, -0.5 * box.height);
    const PointRing high = builder.rectangle(0.5 * box.width, 0.5 * box.depth, 0.5 * box.height);
    builder.band(low, high);
    builder.quad(high[0], high[1], high[2], high[3]);
    builder.quad(low[3], low[2], low[1], low[0]);
    return builder.take();
}

geometry::TriangleMesh tessellateShape(const Sheet& sheet, double) {
    geometry::TriangleBuilder builder;
    const PointRing corners = builder.rectangle(0.5 * sheet.width, 0.5 * sheet.depth, 0.0);
    builder.quad(corners[0], corners[1], corners[2], corners[3]);
    return builder.take();
}

geometry::TriangleMesh tessellateShape(const Cylinder& cylinder, double chord_error) {
    const double radius = 0.5 * cylinder.diameter, half = 0.5 * cylinder.length;
    const int segments = segmentsFor(radius, chord_error);
    geometry::TriangleBuilder builder;
    const PointRing low = builder.ring(radius, -half, segments);
    const PointRing high = builder.ring(radius, half, segments);
    builder.disc(low, -half, false);
    builder.band(low, high);
    builder.disc(high, half, true);
    return builder.take();
}

/// Rings around the axis, one for each vertex of the tube's circle. In the half plane of a ring's vertices a triangle
/// lies within the tube's sagitta; between two such half planes its points come nearer to the axis by the ring's
/// sagitta at the most. Each gets half of the chord error.
struct TorusSteps {
    int around, along_tube;
    double error;
};

TorusSteps stepsFor(const Torus& torus, double chord_error) {
    const double tube = 0.5 * torus.tube_diameter, widest = 0.5 * torus.diameter + tube;
    const double half = 0.5 * chord_error;
    return {segmentsFor(widest, half), segmentsFor(tube, half), sagittaFor(widest, half) + sagittaFor(tube, half)};
}

geometry::TriangleMesh tessellateShape(const Torus& torus, double chord_error) {
    const double radius = 0.5 * torus.diameter, tube = 0.5 * torus.tube_diameter;
    const TorusSteps steps = stepsFor(torus, chord_error);
    geometry::TriangleBuilder builder;
    std::vector<PointRing> rings;
    for (int k = 0; k < steps.along_tube; ++k) {
        const auto [c, s] = geometry::TriangleBuilder::direction(k, steps.along_tube);
        rings.push_back(builder.ring(radius + tube * c, tube * s, steps.around));
    }
    for (std::size_t k = 0; k < rings.size(); ++k) builder.band(rings[k], rings[(k + 1) % rings.size()]);
    return builder.take();
}

geometry::TriangleMesh tessellateShape(const Peg& peg, double chord_error) {
    const double radius = 0.5 * peg.diameter;
    const int segments = segmentsFor(radius, chord_error);
    geometry::TriangleBuilder builder;
    const PointRing edge = builder.ring(radius, peg.chamfer, segments);
    const PointRing end = builder.ring(radius, peg.length, segments);
    if (peg.chamfer > 0.0) {
        const PointRing tip = builder.ring(radius - peg.chamfer, 0.0, segments);
        builder.disc(tip, 0.0, false);
        builder.band(tip, edge);
    } else {
        builder.disc(edge, 0.0, false);
    }
    builder.band(edge, end);
    builder.disc(end, peg.length, true);
    return builder.take();
}

geometry::TriangleMesh tessellateShape(const BorePlate& plate, double chord_error) {
    const double bore = 0.5 * plate.bore_diameter, mouth = bore + plate.chamfer;
    const bool through = plate.bore_depth >= plate.height;
    const double floor_z = through ? -plate.height : -plate.bore_depth;
    const int segments = segmentsFor(mouth, chord_error);
    geometry::TriangleBuilder builder;
    const PointRing top = builder.rectangle(0.5 * plate.width, 0.5 * plate.depth, 0.0);
    const PointRing bottom = builder.rectangle(0.5 * plate.width, 0.5 * plate.depth, -plate.height);
    const PointRing neck = builder.ring(bore, -plate.chamfer, segments);
    const PointRing end = builder.ring(bore, floor_z, segments);
    builder.band(bottom, top);
    builder.band(neck, end);  // the wall faces the axis
    if (plate.chamfer > 0.0) {
        const PointRing rim = builder.ring(mouth, 0.0, segments);
        builder.faceWithHole(top, rim, true);
        builder.band(rim, neck);
    } else {
        builder.faceWithHole(top, neck, true);
    }
    if (through) {
        builder.faceWithHole(bottom, end, false);
    } else {
        builder.disc(end, floor_z, true);
        builder.quad(bottom[3], bottom[2], bottom[1], bottom[0]);
    }
    return builder.take();
}

template <class AnyPeg>
geometry::TriangleMesh tessellatePeg(const AnyPeg& peg, double chord_error) {
    const auto profile = profileOf(peg);
    const ProfileSteps steps = profile.stepsFor(-peg.chamfer, 0.0, chord_error);
    geometry::TriangleBuilder builder;
    PointRing last;
    for (const double t : steps.levels) {
        const PointRing next = builder.ring(profile.grown(t).outline(steps).points, peg.chamfer + t);
        last.empty() ? builder.disc(next, 0.0, false) : builder.band(last, next);
        last = next;
    }
    const PointRing end = builder.ring(profile.outline(steps).points, peg.length);
    builder.band(last, end);
    builder.disc(end, peg.length, true);
    return builder.take();
}

template <class Plate>
geometry::TriangleMesh tessellatePocketPlate(const Plate& plate, double chord_error) {
    const auto profile = profileOf(plate);
    const ProfileSteps steps = profile.stepsFor(0.0, plate.chamfer, chord_error);
    const bool through = plate.bore_depth >= plate.height;
    const double floor_z = through ? -plate.height : -plate.bore_depth;
    geometry::TriangleBuilder builder;
    const PointRing top = builder.rectangle(0.5 * plate.width, 0.5 * plate.depth, 0.0);
    const PointRing bottom = builder.rectangle(0.5 * plate.width, 0.5 * plate.depth, -plate.height);
    builder.band(bottom, top);
    const Outline outline = profile.outline(steps);
    PointRing last = builder.ring(outline.points, floor_z);
    if (through) {
        builder.faceWithHole(bottom, last, outline.on_axis, false);
    } else {
        builder.disc(last, floor_z, true);
        builder.quad(bottom[3], bottom[2], bottom[1], bottom[0]);
    }
    for (const double t : steps.levels) {
        const PointRing next = builder.ring(profile.grown(t).outline(steps).points, t - plate.chamfer);
        builder.band(next, last);  // the wall faces the axis
        last = next;
    }
    builder.faceWithHole(top, last, outline.on_axis, true);
    return builder.take();
}

geometry::TriangleMesh tessellateShape(const SquarePeg& peg, double error) { return tessellatePeg(peg, error); }
geometry::TriangleMesh tessellateShape(const KeyedPeg& peg, double error) { return tessellatePeg(peg, error); }
geometry::TriangleMesh tessellateShape(const SquareBorePlate& plate, double error) {
    return tessellatePocketPlate(plate, error);
}
geometry::TriangleMesh tessellateShape(const KeyedBorePlate& plate, double error) {
    return tessellatePocketPlate(plate, error);
}

double reachedError(const Sphere& sphere, double asked) {
    const double radius = 0.5 * sphere.diameter;
    return radius * (octantError(rowsFor(radius, asked)) + kVertexRounding);
}
double reachedError(const Box&, double) { return 0.0; }
double reachedError(const Sheet&, double) { return 0.0; }
double reachedError(const Cylinder& cylinder, double asked) { return sagittaFor(0.5 * cylinder.diameter, asked); }
double reachedError(const Torus& torus, double asked) { return stepsFor(torus, asked).error; }
double reachedError(const SquarePeg&, double) { return 0.0; }
double reachedError(const KeyedPeg& peg, double asked) {
    return profileOf(peg).stepsFor(-peg.chamfer, 0.0, asked).error;
}
double reachedError(const SquareBorePlate&, double) { return 0.0; }
double reachedError(const KeyedBorePlate& plate, double asked) {
    return profileOf(plate).stepsFor(0.0, plate.chamfer, asked).error;
}
double reachedError(const Peg& peg, double asked) { return sagittaFor(0.5 * peg.diameter, asked); }
double reachedError(const BorePlate& plate, double asked) {
    return sagittaFor(0.5 * plate.bore_diameter + plate.chamfer, asked);  // of the widest circle
}

}  // namespace

geometry::TriangleMesh tessellate(const Shape& shape, double chord_error) {
    return std::visit([&](const auto& s) { return tessellateShape(s, chord_error); }, shape);
}

double chordError(const Shape& shape, double asked) {
    return std::visit([&](const auto& s) { return reachedError(s, asked); }, shape);
}

}  // namespace passung::shape
