#include "core/shape/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/support/brute_force_mesh.h"
#include "tests/support/length.h"

namespace passung::shape {
namespace {

using std::numbers::pi;

const std::vector<Shape>& allShapes() {
    static const std::vector<Shape> shapes{
        Sphere{0.02},
        Box{0.03, 0.02, 0.01},
        Cylinder{0.02, 0.03},
        Sheet{0.04, 0.03},
        Peg{0.02, 0.05, 0.0},
        Peg{0.02, 0.05, 0.002},
        BorePlate{0.06, 0.05, 0.03, 0.0202, 0.02, 0.0},
        BorePlate{0.06, 0.05, 0.03, 0.0202, 0.02, 0.0015},
        BorePlate{0.06, 0.05, 0.03, 0.0202, 0.03, 0.0},
        BorePlate{0.06, 0.05, 0.03, 0.0202, 0.03, 0.0015},
        BorePlate{0.05, 0.021, 0.004, 0.02, 0.0039, 0.0004},
        Torus{0.04, 0.012},
        SquarePeg{0.02, 0.015, 0.05, 0.0},
        SquarePeg{0.02, 0.015, 0.05, 0.002},
        KeyedPeg{0.02, 0.05, 0.006, 0.0025, 0.0},
        KeyedPeg{0.02, 0.05, 0.006, 0.0025, 0.001},
        KeyedPeg{0.02, 0.03, 0.018, 0.0005, 0.0024},
        SquareBorePlate{0.06, 0.05, 0.03, 0.0202, 0.0152, 0.02, 0.0},
        SquareBorePlate{0.06, 0.05, 0.03, 0.0202, 0.0152, 0.02, 0.0015},
        SquareBorePlate{0.06, 0.05, 0.03, 0.0202, 0.0152, 0.03, 0.0015},
        KeyedBorePlate{0.06, 0.05, 0.03, 0.0202, 0.0061, 0.0026, 0.02, 0.0},
        KeyedBorePlate{0.06, 0.05, 0.03, 0.0202, 0.0061, 0.0026, 0.02, 0.0015},
        KeyedBorePlate{0.06, 0.05, 0.03, 0.0202, 0.0061, 0.0026, 0.03, 0.0015},
        ThreadBolt{0.008, 0.00125, 0.004, 0.0},
        ThreadBolt{0.008, 0.00125, 0.005, 0.0004},
        ThreadBolt{0.02, 0.005, 0.012, 0.004},
        ThreadBolt{0.008, 0.00125, 0.004, 0.0, 0.0001},
        ThreadNut{0.008, 0.00125, 0.013, 0.003, 0.0},
        ThreadNut{0.008, 0.00125, 0.013, 0.0033, 0.0003},
        ThreadNut{0.02, 0.005, 0.03, 0.011, 0.0035},
        ThreadNut{0.008, 0.00125, 0.013, 0.0033, 0.0003, 0.0002},
        ThreadBolt{0.01, 0.002, 0.006, 0.0, 0.0, pi / 6, 0.001},
        ThreadBolt{0.01, 0.002, 0.006, 0.0004, 0.0001, pi / 9, 0.0008},
        ThreadNut{0.01, 0.002, 0.016, 0.005, 0.0003, 0.0001, pi / 6, 0.001},
    };
    return shapes;
}

std::string described(const Shape& shape) {
    std::ostringstream text;
    text << kindName(shape) << " [mm]";
    for (const double d : dimensions(shape)) text << ' ' << 1e3 * d;
    return text.str();
}

/// Half uniform in the bounds and around them, half close to the surface.
std::vector<Vec3> pointsAround(const Shape& shape, int count, Random& random) {
    const geometry::TriangleMesh mesh = tessellate(shape, 1e-5);
    const geometry::Bounds bounds = geometry::boundsOf(mesh);
    const double margin = 0.3 * bounds.size().norm();
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        Vec3 p;
        if (i % 2 == 0) {
            for (int k = 0; k < 3; ++k) p[k] = random.uniform(bounds.low[k] - margin, bounds.high[k] + margin);
        } else {
            const auto& t = mesh.triangles[random.below(mesh.triangles.size())];
            double u = random.uniform(), v = random.uniform();
            if (u + v > 1.0) {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
            const double reach = std::pow(10.0, random.uniform(-6.0, -2.0));
            p = a + u * (b - a) + v * (c - a) + reach * Vec3(random.normal(), random.normal(), random.normal());
        }
        points.push_back(p);
    }
    return points;
}

/// In a disc with a key, both grown by `by`.
bool inKeyed(double diameter, double key_width, double key_height, double by, double x, double y) {
    const double radius = diameter / 2 + by;
    const bool in_key = x >= 0.0 && x < radius + key_height && std::abs(y) < key_width / 2 + by;
    return std::hypot(x, y) < radius || in_key;
}

/// ISO 68-1: crest of a bolt P/8 wide, root P/4, flanks 60° apart, 5/8 of the sharp triangle's height deep; a ridge's
/// middle goes up by P a turn. Other flanks: ridge and groove as wide at 3/5 of the height, but for the clearance c,
/// which makes a bolt's ridge narrower, a nut's groove wider, by c/2 across its flanks beside what c along the radius
/// does.
double heightOf(double pitch, double height) { return height > 0.0 ? height : 5.0 / 8 * std::sqrt(3.0) / 2 * pitch; }
template <class Thread>
double threadRadius(const Thread& thread, double diameter, const Vec3& p) {
    const double pitch = thread.pitch, lean = thread.flank_angle / 2, height = heightOf(pitch, thread.flank_height);
    const double turns = p.z() / pitch - std::atan2(p.y(), p.x()) / (2 * pi);
    const double off = std::abs(turns - std::round(turns)) * pitch;  // from the ridge's middle
    const double wider = (thread.clearance / 2 - thread.clearance * std::sin(lean)) / std::cos(lean);
    const double crest =
        pitch / 4 - 0.6 * height * std::tan(lean) + (diameter > thread.nominal_diameter ? wider : -wider);
    return diameter / 2 - std::clamp((off - crest) / std::tan(lean), 0.0, height);
}

/// Of the whole profile, which its clearance moves.
double widthOf(const ThreadBolt& b) { return b.nominal_diameter - 2 * b.clearance; }
double widthOf(const ThreadNut& n) { return n.nominal_diameter + 2 * n.clearance; }

bool inBlock(double width, double depth, double height, const Vec3& p) {
    return std::abs(p.x()) < width / 2 && std::abs(p.y()) < depth / 2 && p.z() < 0.0 && p.z() > -height;
}

/// Membership, straight from what the shapes are said to be.
bool isInside(const Shape& shape, const Vec3& p) {
    const double x = p.x(), y = p.y(), z = p.z(), r = std::hypot(x, y);
    if (const auto* s = std::get_if<Sphere>(&shape)) return x * x + y * y + z * z < s->diameter * s->diameter / 4;
    if (const auto* b = std::get_if<Box>(&shape))
        return std::abs(x) < b->width / 2 && std::abs(y) < b->depth / 2 && std::abs(z) < b->height / 2;
    if (const auto* c = std::get_if<Cylinder>(&shape)) return r < c->diameter / 2 && std::abs(z) < c->length / 2;
    if (const auto* g = std::get_if<Peg>(&shape)) {
        const double allowed = z < g->chamfer ? g->diameter / 2 - (g->chamfer - z) : g->diameter / 2;
        return z > 0.0 && z < g->length && r < allowed;
    }
    if (const auto* t = std::get_if<Torus>(&shape)) return std::hypot(r - t->diameter / 2, z) < t->tube_diameter / 2;
    if (const auto* g = std::get_if<SquarePeg>(&shape)) {
        const double cut = z < g->chamfer ? g->chamfer - z : 0.0;
        return z > 0.0 && z < g->length && std::abs(x) < g->width / 2 - cut && std::abs(y) < g->depth / 2 - cut;
    }
    if (const auto* g = std::get_if<KeyedPeg>(&shape)) {
        const double cut = z < g->chamfer ? g->chamfer - z : 0.0;
        return z > 0.0 && z < g->length && inKeyed(g->diameter, g->key_width, g->key_height, -cut, x, y);
    }
    if (const auto* b = std::get_if<SquareBorePlate>(&shape)) {
        const double widened = z > -b->chamfer ? b->chamfer + z : 0.0;
        const bool in_pocket = z >= -b->bore_depth && std::abs(x) <= b->pocket_width / 2 + widened &&
                               std::abs(y) <= b->pocket_depth / 2 + widened;
        return inBlock(b->width, b->depth, b->height, p) && !in_pocket;
    }
    if (const auto* b = std::get_if<KeyedBorePlate>(&shape)) {
        const double widened = z > -b->chamfer ? b->chamfer + z : 0.0;
        const bool in_pocket =
            z >= -b->bore_depth && inKeyed(b->bore_diameter, b->key_width, b->key_height, widened, x, y);
        return inBlock(b->width, b->depth, b->height, p) && !in_pocket;
    }
    if (const auto* b = std::get_if<ThreadBolt>(&shape))
        return z > 0.0 && z < b->length && r < threadRadius(*b, widthOf(*b), p) &&
               r < widthOf(*b) / 2 - b->chamfer + (b->chamfer > 0.0 ? z : 0.0);
    if (const auto* n = std::get_if<ThreadNut>(&shape)) {
        const double from_mouth = std::min(-z, n->height + z);
        const double crest = widthOf(*n) / 2 - heightOf(n->pitch, n->flank_height);
        const bool in_hole = r <= threadRadius(*n, widthOf(*n), p) || r <= crest + n->chamfer - from_mouth;
        return from_mouth > 0.0 && r < n->outer_diameter / 2 && !in_hole;
    }
    if (const auto* b = std::get_if<BorePlate>(&shape)) {
        const double widened = z > -b->chamfer ? b->chamfer + z : 0.0;
        const bool in_bore = z >= -b->bore_depth && r <= b->bore_diameter / 2 + widened;
        return inBlock(b->width, b->depth, b->height, p) && !in_bore;
    }
    return false;
}

double frustum(double r1, double r2, double h) { return pi * h / 3 * (r1 * r1 + r1 * r2 + r2 * r2); }

struct Section {
    double area, border;
};

Section rectangleSection(double width, double depth) { return {width * depth, 2 * (width + depth)}; }

/// A disc with a key: beside the angle ±α where they meet a sector, within it a triangle and the rest of the key.
Section keyedSection(double diameter, double key_width, double key_height) {
    const double r = diameter / 2, a = key_width / 2, alpha = std::asin(a / r), x = r * std::cos(alpha);
    const double out = r + key_height - x;
    return {(pi - alpha) * r * r + a * x + 2 * a * out, 2 * (pi - alpha) * r + 2 * out + 2 * a};
}

/// Cross-section grown by t of the shapes that are drawn along z.
Section sectionOf(const Shape& shape, double t) {
    if (const auto* g = std::get_if<SquarePeg>(&shape)) return rectangleSection(g->width + 2 * t, g->depth + 2 * t);
    if (const auto* g = std::get_if<KeyedPeg>(&shape))
        return keyedSection(g->diameter + 2 * t, g->key_width + 2 * t, g->key_height);
    if (const auto* b = std::get_if<SquareBorePlate>(&shape))
        return rectangleSection(b->pocket_width + 2 * t, b->pocket_depth + 2 * t);
    const auto& b = std::get<KeyedBorePlate>(shape);
    return keyedSection(b.bore_diameter + 2 * t, b.key_width + 2 * t, b.key_height);
}

/// Volume and area of a chamfer's slope: the section's integral, and √2 times that of its border, because every part of
/// the border moves by one per height. Simpson's rule; its error, with the fourth derivative, is far below the test's.
Section slopeOf(const Shape& shape, double low, double high) {
    constexpr int kIntervals = 200;
    const double h = (high - low) / kIntervals;
    Section sum{0.0, 0.0};
    for (int k = 0; k <= kIntervals; ++k) {
        const double weight = (k == 0 || k == kIntervals ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) * h / 3;
        const Section section = sectionOf(shape, low + k * h);
        sum.area += weight * section.area;
        sum.border += weight * section.border * std::sqrt(2.0);
    }
    return sum;
}

template <class AnyPeg>
double pegVolume(const AnyPeg& g) {
    return sectionOf(g, 0).area * (g.length - g.chamfer) + slopeOf(g, -g.chamfer, 0).area;
}

template <class AnyPeg>
double pegArea(const AnyPeg& g) {
    return sectionOf(g, 0).area + sectionOf(g, -g.chamfer).area + sectionOf(g, 0).border * (g.length - g.chamfer) +
           slopeOf(g, -g.chamfer, 0).border;
}

template <class Plate>
double plateVolume(const Plate& b) {
    return b.width * b.depth * b.height - sectionOf(b, 0).area * (b.bore_depth - b.chamfer) -
           slopeOf(b, 0, b.chamfer).area;
}

template <class Plate>
double plateArea(const Plate& b) {
    const double floor = b.bore_depth >= b.height ? -sectionOf(b, 0).area : sectionOf(b, 0).area;
    return 2 * (b.width * b.depth + b.width * b.height + b.depth * b.height) - sectionOf(b, b.chamfer).area +
           slopeOf(b, 0, b.chamfer).border + sectionOf(b, 0).border * (b.bore_depth - b.chamfer) + floor;
}

/// Of what is swept by r(φ, z) about the axis: volume, area of the swept face, areas of the two ends; by the midpoint
/// rule on a fine lattice, the radius being piecewise linear.
struct Swept {
    double volume = 0.0, face = 0.0, ends = 0.0;
};

template <class Radius>
Swept sweep(double low, double high, const Radius& radius) {
    constexpr int kAround = 720, kAlong = 2000;
    Swept sum;
    const double dphi = 2 * pi / kAround, dz = (high - low) / kAlong;
    for (int i = 0; i < kAround; ++i) {
        const double phi = (i + 0.5) * dphi, e = 1e-3 * dphi, h = 1e-3 * dz;
        sum.ends += 0.5 * dphi * (std::pow(radius(phi, low), 2) + std::pow(radius(phi, high), 2));
        for (int k = 0; k < kAlong; ++k) {
            const double z = low + (k + 0.5) * dz, r = radius(phi, z);
            const double by_z = (radius(phi, z + h) - radius(phi, z - h)) / (2 * h);
            const double by_phi = (radius(phi + e, z) - radius(phi - e, z)) / (2 * e);
            sum.volume += 0.5 * r * r * dphi * dz;
            sum.face += std::sqrt(r * r * (1 + by_z * by_z) + by_phi * by_phi) * dphi * dz;
        }
    }
    return sum;
}

Swept sweptBy(const ThreadBolt& b) {
    return sweep(0.0, b.length, [&](double phi, double z) {
        const double r = threadRadius(b, widthOf(b), {std::cos(phi), std::sin(phi), z});
        return std::min(r, widthOf(b) / 2 - b.chamfer + (b.chamfer > 0.0 ? z : 0.0) + (b.chamfer > 0.0 ? 0.0 : 1.0));
    });
}

Swept sweptBy(const ThreadNut& n) {
    return sweep(-n.height, 0.0, [&](double phi, double z) {
        const double r = threadRadius(n, widthOf(n), {std::cos(phi), std::sin(phi), z});
        const double crest = widthOf(n) / 2 - heightOf(n.pitch, n.flank_height);
        return std::max(r, crest + n.chamfer - std::min(-z, n.height + z));
    });
}

double exactVolume(const Shape& shape) {
    if (const auto* b = std::get_if<ThreadBolt>(&shape)) return sweptBy(*b).volume;
    if (const auto* n = std::get_if<ThreadNut>(&shape))
        return pi / 4 * n->outer_diameter * n->outer_diameter * n->height - sweptBy(*n).volume;
    if (const auto* t = std::get_if<Torus>(&shape))
        return pi * pi / 4 * t->diameter * t->tube_diameter * t->tube_diameter;
    if (const auto* g = std::get_if<SquarePeg>(&shape)) return pegVolume(*g);
    if (const auto* g = std::get_if<KeyedPeg>(&shape)) return pegVolume(*g);
    if (const auto* b = std::get_if<SquareBorePlate>(&shape)) return plateVolume(*b);
    if (const auto* b = std::get_if<KeyedBorePlate>(&shape)) return plateVolume(*b);
    if (const auto* s = std::get_if<Sphere>(&shape)) return pi / 6 * std::pow(s->diameter, 3);
    if (const auto* b = std::get_if<Box>(&shape)) return b->width * b->depth * b->height;
    if (const auto* c = std::get_if<Cylinder>(&shape)) return pi / 4 * c->diameter * c->diameter * c->length;
    if (const auto* g = std::get_if<Peg>(&shape)) {
        const double r = g->diameter / 2, c = g->chamfer;
        return pi * r * r * (g->length - c) + frustum(r - c, r, c);
    }
    if (const auto* b = std::get_if<BorePlate>(&shape)) {
        const double r = b->bore_diameter / 2, c = b->chamfer;
        return b->width * b->depth * b->height - pi * r * r * (b->bore_depth - c) - frustum(r, r + c, c);
    }
    return 0.0;
}

double exactArea(const Shape& shape) {
    if (const auto* b = std::get_if<ThreadBolt>(&shape)) return sweptBy(*b).face + sweptBy(*b).ends;
    if (const auto* n = std::get_if<ThreadNut>(&shape)) {
        const Swept hole = sweptBy(*n);
        const double d = n->outer_diameter;
        return hole.face + pi / 2 * d * d - hole.ends + pi * d * n->height;
    }
    if (const auto* t = std::get_if<Torus>(&shape)) return pi * pi * t->diameter * t->tube_diameter;
    if (const auto* g = std::get_if<SquarePeg>(&shape)) return pegArea(*g);
    if (const auto* g = std::get_if<KeyedPeg>(&shape)) return pegArea(*g);
    if (const auto* b = std::get_if<SquareBorePlate>(&shape)) return plateArea(*b);
    if (const auto* b = std::get_if<KeyedBorePlate>(&shape)) return plateArea(*b);
    if (const auto* s = std::get_if<Sphere>(&shape)) return pi * s->diameter * s->diameter;
    if (const auto* b = std::get_if<Box>(&shape))
        return 2 * (b->width * b->depth + b->width * b->height + b->depth * b->height);
    if (const auto* c = std::get_if<Cylinder>(&shape)) return pi * c->diameter * (c->length + c->diameter / 2);
    if (const auto* s = std::get_if<Sheet>(&shape)) return s->width * s->depth;
    if (const auto* g = std::get_if<Peg>(&shape)) {
        const double r = g->diameter / 2, c = g->chamfer, tip = r - c;
        return pi * (tip * tip + (tip + r) * c * std::sqrt(2.0) + 2 * r * (g->length - c) + r * r);
    }
    const auto& b = std::get<BorePlate>(shape);
    const double r = b.bore_diameter / 2, c = b.chamfer, mouth = r + c;
    const double floor = b.bore_depth >= b.height ? -r * r : r * r;
    return 2 * (b.width * b.depth + b.width * b.height + b.depth * b.height) +
           pi * (-mouth * mouth + (mouth + r) * c * std::sqrt(2.0) + 2 * r * (b.bore_depth - c) + floor);
}

TEST(Shape, DistanceIsThatToItsTrianglesWithinTheChordError) {
    // Truth: closed form against a plain search over all triangles. The triangles lie within the chord error of the
    // surface and the surface within the chord error of the triangles, so distances differ by no more.
    const double chord_error = 4e-6;
    Random random(1);
    for (const Shape& shape : allShapes()) {
        const geometry::TriangleMesh mesh = tessellate(shape, chord_error);
        for (const Vec3& p : pointsAround(shape, 600, random))
            ASSERT_NEAR(std::abs(signedDistance(shape, p)), test::distanceToMesh(mesh, p), chord_error + 1e-12)
                << described(shape) << " at " << p.transpose();
    }
}

TEST(Shape, DistanceToChamfersIsThatToAFineMesh) {
    // Truth: closed form against a plain search over all triangles, 40 times finer than above: a chamfer's curved edge
    // between bore and keyway is followed to a tenth of a micrometre.
    const double chord_error = 1e-7;
    Random random(7);
    for (const Shape& shape : {Shape(KeyedPeg{0.02, 0.05, 0.006, 0.0025, 0.002}),
                               Shape(KeyedBorePlate{0.06, 0.05, 0.03, 0.02, 0.016, 0.001, 0.02, 0.002})}) {
        const geometry::TriangleMesh mesh = tessellate(shape, chord_error);
        const double sign = std::holds_alternative<KeyedPeg>(shape) ? 1.0 : -1.0;
        for (int i = 0; i < 200; ++i) {
            // About the chamfer, where x > 0.
            const Vec3 p(random.uniform(0.0, 0.014), random.uniform(-0.012, 0.012),
                         sign * random.uniform(-0.002, 0.004));
            ASSERT_NEAR(std::abs(signedDistance(shape, p)), test::distanceToMesh(mesh, p), chord_error + 1e-12)
                << described(shape) << " at " << p.transpose();
        }
    }
}

TEST(Shape, DistanceIsMirroredWhereTheShapeIs) {
    // Truth: invariant. All shapes but threads are mirror images of themselves in the plane y = 0, those without a key
    // in x = 0 too.
    Random random(8);
    for (const Shape& shape : allShapes()) {
        if (std::holds_alternative<ThreadBolt>(shape) || std::holds_alternative<ThreadNut>(shape)) continue;
        const bool keyed = std::holds_alternative<KeyedPeg>(shape) || std::holds_alternative<KeyedBorePlate>(shape);
        for (const Vec3& p : pointsAround(shape, 500, random)) {
            const double distance = signedDistance(shape, p);
            ASSERT_EQ(signedDistance(shape, Vec3(p.x(), -p.y(), p.z())), distance) << described(shape);
            if (!keyed) {
                ASSERT_EQ(signedDistance(shape, Vec3(-p.x(), p.y(), p.z())), distance) << described(shape);
            }
        }
    }
}

TEST(Shape, DistanceIsExactWhereFacesAreFlat) {
    // Truth: closed form. Distances counted by hand: box corner, in the bore, under the plate, beside the peg's
    // chamfer.
    const Shape box = Box{0.02, 0.04, 0.06};
    EXPECT_NEAR(signedDistance(box, Vec3(0.013, 0.024, 0.03)), 0.005, 1e-15);
    EXPECT_NEAR(signedDistance(box, Vec3(0.007, 0.0, 0.0)), -0.003, 1e-15);
    const Shape plate = BorePlate{0.06, 0.06, 0.03, 0.02, 0.02, 0.001};
    EXPECT_NEAR(signedDistance(plate, Vec3(0.0, 0.0, -0.015)), 0.005, 1e-15);   // floor
    EXPECT_NEAR(signedDistance(plate, Vec3(0.008, 0.0, -0.01)), 0.002, 1e-15);  // wall
    EXPECT_NEAR(signedDistance(plate, Vec3(0.0, 0.0, -0.025)), -0.005, 1e-15);  // between floor and underside
    EXPECT_NEAR(signedDistance(plate, Vec3(0.0, 0.0, 0.0)), std::hypot(0.01, 0.001), 1e-15);  // cone's end
    EXPECT_NEAR(signedDistance(plate, Vec3(0.0, 0.02, 0.004)), 0.004, 1e-15);                 // above the top face
    const Shape peg = Peg{0.02, 0.05, 0.002};
    EXPECT_NEAR(signedDistance(peg, Vec3(0.01, 0.0, 0.0)), 0.002 / std::sqrt(2.0), 1e-15);
    EXPECT_NEAR(signedDistance(peg, Vec3(0.0, 0.0, -0.003)), 0.003, 1e-15);
    EXPECT_NEAR(signedDistance(peg, Vec3(0.0, 0.0, 0.049)), -0.001, 1e-15);
}

TEST(Shape, KeysAndPocketsAreWhereTheirFramesSay) {
    // Truth: closed form. Distances counted by hand. Key on +x, its top 2 mm beyond the circle; square peg's corner
    // chamfer, whose three planes' common point (9, 6.5, 0) mm is nearest below it.
    const Shape keyed = KeyedPeg{0.02, 0.05, 0.006, 0.002, 0.001};
    EXPECT_NEAR(signedDistance(keyed, Vec3(0.013, 0.0, 0.02)), 0.001, 1e-15);                  // before the key's top
    EXPECT_NEAR(signedDistance(keyed, Vec3(-0.013, 0.0, 0.02)), 0.003, 1e-15);                 // behind the body
    EXPECT_NEAR(signedDistance(keyed, Vec3(0.0115, 0.0, 0.02)), -0.0005, 1e-15);               // in the key
    EXPECT_NEAR(signedDistance(keyed, Vec3(0.011, 0.005, 0.02)), 0.002, 1e-15);                // beside the key
    EXPECT_NEAR(signedDistance(keyed, Vec3(0.012, 0.0, 0.0)), 0.001 / std::sqrt(2.0), 1e-15);  // before its chamfer
    EXPECT_NEAR(signedDistance(keyed, Vec3(0.0, 0.0, -0.004)), 0.004, 1e-15);
    const Shape square = SquarePeg{0.02, 0.015, 0.05, 0.001};
    EXPECT_NEAR(signedDistance(square, Vec3(0.011, 0.0, 0.02)), 0.001, 1e-15);
    EXPECT_NEAR(signedDistance(square, Vec3(0.0, 0.009, 0.02)), 0.0015, 1e-15);
    EXPECT_NEAR(signedDistance(square, Vec3(0.009, 0.0065, -0.002)), 0.002, 1e-15);
    EXPECT_NEAR(signedDistance(square, Vec3(0.0, 0.0, 0.049)), -0.001, 1e-15);
    const Shape pocket = SquareBorePlate{0.06, 0.05, 0.03, 0.02, 0.016, 0.02, 0.001};
    EXPECT_NEAR(signedDistance(pocket, Vec3(0.0, 0.0, -0.013)), 0.007, 1e-15);    // floor
    EXPECT_NEAR(signedDistance(pocket, Vec3(0.0, 0.005, -0.012)), 0.003, 1e-15);  // wall along y
    EXPECT_NEAR(signedDistance(pocket, Vec3(0.008, 0.0, -0.012)), 0.002, 1e-15);  // wall along x
    EXPECT_NEAR(signedDistance(pocket, Vec3(0.0, 0.02, 0.004)), 0.004, 1e-15);
    EXPECT_NEAR(signedDistance(pocket, Vec3(0.0, 0.0, -0.025)), -0.005, 1e-15);
    const Shape keyway = KeyedBorePlate{0.06, 0.05, 0.03, 0.02, 0.006, 0.002, 0.03, 0.0};
    EXPECT_NEAR(signedDistance(keyway, Vec3(0.013, 0.0, -0.015)), -0.001, 1e-15);  // beyond the keyway's bottom
    EXPECT_NEAR(signedDistance(keyway, Vec3(0.011, 0.001, -0.015)), 0.001, 1e-15);
    EXPECT_NEAR(signedDistance(keyway, Vec3(-0.013, 0.0, -0.015)), -0.003, 1e-15);
    EXPECT_NEAR(signedDistance(keyway, Vec3(-0.008, 0.0, -0.015)), 0.002, 1e-15);
    const Shape torus = Torus{0.04, 0.012};
    EXPECT_NEAR(signedDistance(torus, Vec3(0.0, 0.0, 0.0)), 0.014, 1e-15);
    EXPECT_NEAR(signedDistance(torus, Vec3(0.0, 0.02, 0.0)), -0.006, 1e-15);
    EXPECT_NEAR(signedDistance(torus, Vec3(0.0, -0.02, 0.01)), 0.004, 1e-15);
}

TEST(Shape, DistanceChangesNoFasterThanThePoint) {
    // Truth: invariant. A distance is 1-Lipschitz; a jump anywhere, the sign's included, breaks it.
    Random random(2);
    for (const Shape& shape : allShapes()) {
        const std::vector<Vec3> points = pointsAround(shape, 20000, random);
        for (const Vec3& p : points) {
            const double reach = std::pow(10.0, random.uniform(-7.0, -2.0));
            const Vec3 q = p + reach * Vec3(random.normal(), random.normal(), random.normal());
            ASSERT_LE(std::abs(signedDistance(shape, p) - signedDistance(shape, q)),
                      (p - q).norm() * (1 + 1e-9) + 1e-15)
                << described(shape) << " at " << p.transpose();
        }
    }
}

TEST(Shape, IsNegativeExactlyInside) {
    // Truth: closed form. The inequalities that define each solid.
    Random random(3);
    for (const Shape& shape : allShapes()) {
        int inside = 0;
        for (const Vec3& p : pointsAround(shape, 20000, random)) {
            const double distance = signedDistance(shape, p);
            if (std::abs(distance) < 1e-15) continue;
            ASSERT_EQ(distance < 0.0, isInside(shape, p)) << described(shape) << " at " << p.transpose();
            inside += distance < 0.0 ? 1 : 0;
        }
        EXPECT_GE(inside, std::holds_alternative<Sheet>(shape) ? 0 : 1000) << described(shape);
    }
}

TEST(Tessellation, VerticesLieOnTheSurfaceAndTrianglesWithinTheChordError) {
    // Truth: closed form. Points spread over every triangle, corners and edges included.
    for (const double chord_error : {1e-4, 1e-5, 1e-6}) {
        for (const Shape& shape : allShapes()) {
            const geometry::TriangleMesh mesh = tessellate(shape, chord_error);
            double worst = 0.0;
            for (const Vec3& v : mesh.vertices) ASSERT_NEAR(signedDistance(shape, v), 0.0, 1e-14) << described(shape);
            for (const auto& t : mesh.triangles)
                for (int i = 0; i <= 4; ++i)
                    for (int j = 0; i + j <= 4; ++j) {
                        const Vec3 p = 0.25 * (i * mesh.vertices[t[0]] + j * mesh.vertices[t[1]] +
                                               (4 - i - j) * mesh.vertices[t[2]]);
                        worst = std::max(worst, std::abs(signedDistance(shape, p)));
                    }
            EXPECT_LE(worst, chord_error + 1e-14) << described(shape);
            EXPECT_LE(worst, chordError(shape, chord_error) + 1e-14) << described(shape);
        }
    }
}

TEST(Tessellation, UsesEveryEdgeOnceInEachDirection) {
    // Truth: invariant. What watertight and consistently oriented means; a sheet has its border, four edges.
    for (const Shape& shape : allShapes()) {
        const test::EdgeCount edges = test::countEdges(tessellate(shape, 1e-5));
        EXPECT_EQ(edges.crowded, 0u) << described(shape);
        EXPECT_EQ(edges.open, std::holds_alternative<Sheet>(shape) ? 4u : 0u) << described(shape);
    }
}

TEST(Tessellation, HasTheVolumeAndAreaOfTheShape) {
    // Truth: closed form. The surface moves by the chord error at most, the volume by that times the area; the area of
    // an inscribed polygon falls short by its relative sagitta, which goes with the chord error: below 1e-4 at 0.5 um.
    const double chord_error = test::atFullLength() ? 5e-7 : 5e-6;
    const double sagitta = 1e-4 * chord_error / 5e-7;
    for (const Shape& shape : allShapes()) {
        const geometry::TriangleMesh mesh = tessellate(shape, chord_error);
        EXPECT_NEAR(test::area(mesh), exactArea(shape), sagitta * exactArea(shape)) << described(shape);
        EXPECT_NEAR(test::volume(mesh), exactVolume(shape), chord_error * exactArea(shape)) << described(shape);
    }
}

TEST(Tessellation, ReachesTheExtremePointsOnTheAxes) {
    // Truth: closed form. Segment counts are divisible by four, so the bounds of a round part are exact.
    const geometry::Bounds bounds = geometry::boundsOf(tessellate(Peg{0.02, 0.05, 0.001}, 1e-5));
    EXPECT_EQ(bounds.low, Vec3(-0.01, -0.01, 0.0));
    EXPECT_EQ(bounds.high, Vec3(0.01, 0.01, 0.05));
    const geometry::Bounds keyed = geometry::boundsOf(tessellate(KeyedPeg{0.02, 0.05, 0.006, 0.0025, 0.001}, 1e-5));
    EXPECT_EQ(keyed.low, Vec3(-0.01, -0.01, 0.0));
    EXPECT_EQ(keyed.high, Vec3(0.0125, 0.01, 0.05));
    const geometry::Bounds torus = geometry::boundsOf(tessellate(Torus{0.04, 0.012}, 1e-5));
    EXPECT_EQ(torus.low, Vec3(-(0.02 + 0.006), -(0.02 + 0.006), -0.006));
    EXPECT_EQ(torus.high, Vec3(0.02 + 0.006, 0.02 + 0.006, 0.006));
}

TEST(Tessellation, StaysCoarseAndStaysFiniteAtTheEnds) {
    // Truth: closed form. At least 12 segments however coarse, at most 2048 however fine: 4 (caps, walls) triangles
    // each.
    EXPECT_EQ(tessellate(Cylinder{0.02, 0.03}, 1.0).triangles.size(), 4u * 12u);
    EXPECT_EQ(tessellate(Cylinder{0.02, 0.03}, 1e-18).triangles.size(), 4u * 2048u);
}

TEST(Tessellation, ReachesNoSmallerChordErrorThanItSays) {
    // Truth: closed form. The middle of a chord of n segments is r(1 - cos π/n) off; 2048 segments are the most. The
    // worst point of the triangles is looked for on a lattice over each: it must lie within the error that is said, and
    // nearly reach it.
    for (const double asked : {1e-4, 1e-6, 1e-9}) {
        for (const Shape& shape : {Shape(Sphere{1.0}), Shape(Cylinder{2.0, 0.5}), Shape(Peg{1.5, 0.5, 0.1}),
                                   Shape(BorePlate{3.0, 3.0, 0.5, 2.0, 0.3, 0.05}), Shape(Sphere{0.02})}) {
            const geometry::TriangleMesh mesh = tessellate(shape, asked);
            const double said = chordError(shape, asked);
            double worst = 0.0;
            for (const auto& t : mesh.triangles)
                for (int i = 0; i <= 4; ++i)
                    for (int j = 0; i + j <= 4; ++j) {
                        const Vec3 p =
                            (i * mesh.vertices[t[0]] + j * mesh.vertices[t[1]] + (4 - i - j) * mesh.vertices[t[2]]) / 4;
                        worst = std::max(worst, std::abs(signedDistance(shape, p)));
                    }
            EXPECT_LE(worst, said + 1e-15) << described(shape) << " asked " << asked;
            EXPECT_GT(worst, 0.9 * said) << described(shape) << " asked " << asked;
            if (asked < 1e-8) {
                EXPECT_GT(said, asked) << described(shape);
            }
        }
    }
    EXPECT_LE(chordError(Sphere{0.02}, 1e-6), 1e-6);
    EXPECT_EQ(chordError(Box{1.0, 1.0, 1.0}, 1e-9), 0.0);
    EXPECT_EQ(chordError(Sheet{1.0, 1.0}, 1e-9), 0.0);
}

std::vector<std::string> keysOf(const Shape& shape) {
    std::vector<std::string> keys;
    for (const Error& error : validate(shape)) keys.push_back(error.key);
    return keys;
}

TEST(ShapeValidation, AcceptsWhatCanBeMade) {
    // Truth: closed form. The shapes of this file, and a through bore that is said deeper than the plate.
    for (const Shape& shape : allShapes()) EXPECT_TRUE(validate(shape).empty()) << described(shape);
    EXPECT_TRUE(validate(BorePlate{0.06, 0.06, 0.03, 0.02, 0.04, 0.001}).empty());
}

TEST(ShapeValidation, NamesEachValueThatCannotBe) {
    // Truth: closed form. One row per rule.
    using Keys = std::vector<std::string>;
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(keysOf(Sphere{nan}), Keys{"diameter"});
    EXPECT_EQ(keysOf(Sphere{inf}), Keys{"diameter"});
    EXPECT_EQ(keysOf(Sphere{0.0}), Keys{"diameter"});
    EXPECT_EQ(keysOf(Box{0.01, -0.01, nan}), (Keys{"depth", "height"}));
    EXPECT_EQ(keysOf(Cylinder{0.01, 0.0}), Keys{"length"});
    EXPECT_EQ(keysOf(Sheet{1001.0, 0.1}), Keys{"width"});
    EXPECT_EQ(keysOf(Peg{0.02, 0.05, -1e-3}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(Peg{0.02, 0.05, nan}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(Peg{0.02, 0.05, 0.01}), Keys{"chamfer"});    // no tip face left
    EXPECT_EQ(keysOf(Peg{0.02, 0.001, 0.001}), Keys{"chamfer"});  // no wall left
    EXPECT_EQ(keysOf(BorePlate{0.06, 0.02, 0.03, 0.02, 0.02, 0.0}), Keys{"bore_diameter"});
    EXPECT_EQ(keysOf(BorePlate{0.06, 0.022, 0.03, 0.02, 0.02, 0.001}), Keys{"chamfer"});  // mouth reaches the side
    EXPECT_EQ(keysOf(BorePlate{0.06, 0.06, 0.03, 0.02, 0.002, 0.002}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(BorePlate{0.06, 0.06, 0.03, 0.02, inf, 0.0}), Keys{"bore_depth"});
    EXPECT_EQ(validate(Sphere{-0.02})[0].value, "-0.02 m");
    EXPECT_EQ(keysOf(Torus{0.02, 0.02}), Keys{"tube_diameter"});  // no hole left
    EXPECT_EQ(keysOf(Torus{nan, -0.01}), (Keys{"diameter", "tube_diameter"}));
    EXPECT_EQ(keysOf(SquarePeg{0.02, 0.01, 0.05, 0.005}), Keys{"chamfer"});  // the tip becomes an edge
    EXPECT_EQ(keysOf(SquarePeg{0.02, 0.02, 0.001, 0.001}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(SquarePeg{0.0, 0.02, 0.05, nan}), (Keys{"width", "chamfer"}));
    EXPECT_EQ(keysOf(KeyedPeg{0.02, 0.05, 0.02, 0.002, 0.0}), Keys{"key_width"});
    EXPECT_EQ(keysOf(KeyedPeg{0.02, 0.05, 0.006, 0.0, 0.0}), Keys{"key_height"});
    EXPECT_EQ(keysOf(KeyedPeg{0.02, 0.05, 0.006, 0.002, 0.003}), Keys{"chamfer"});  // no key left at the tip
    EXPECT_EQ(keysOf(KeyedPeg{0.02, 0.001, 0.006, 0.002, 0.001}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(ThreadBolt{0.008, 0.0021, 0.02, 0.0}), Keys{"pitch"});
    EXPECT_EQ(keysOf(ThreadBolt{0.008, 0.001, 0.0009, 0.0}), Keys{"length"});
    EXPECT_EQ(keysOf(ThreadBolt{0.008, 0.001, 0.2, 0.0}), Keys{"length"});
    EXPECT_EQ(keysOf(ThreadBolt{0.008, 0.001, 0.02, 0.004}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(ThreadNut{0.008, 0.001, 0.008, 0.006, 0.0}), Keys{"nominal_diameter"});
    EXPECT_EQ(keysOf(ThreadNut{0.008, 0.001, 0.0083, 0.006, 0.0, 0.0002}), Keys{"nominal_diameter"});
    EXPECT_EQ(keysOf(ThreadNut{0.008, 0.001, 0.013, 0.006, 0.0, 0.00025}), Keys{"clearance"});
    EXPECT_EQ(keysOf(ThreadBolt{0.008, 0.001, 0.02, 0.0, -0.0001}), Keys{"clearance"});
    EXPECT_EQ(keysOf(ThreadNut{0.008, 0.001, 0.013, 0.0121, 0.0}), Keys{"height"});
    EXPECT_EQ(keysOf(ThreadBolt{0.008, 0.001, 0.02, 0.0, 0.0, pi / 91}), Keys{"flank_angle_deg"});
    EXPECT_EQ(keysOf(ThreadBolt{0.02, 0.005, 0.02, 0.0, 0.0, pi / 90, 0.0}), Keys{"flank_height"});  // between edges
    EXPECT_EQ(keysOf(ThreadBolt{0.008, 0.001, 0.02, 0.0, 0.0, pi / 3, 0.0008}), Keys{"flank_height"});
    EXPECT_EQ(keysOf(ThreadBolt{0.008, 0.001, 0.02, 0.0, 0.0, pi / 90, 0.0001}), Keys{});
    EXPECT_EQ(keysOf(ThreadNut{0.008, nan, 0.013, 0.006, 0.0}), Keys{"pitch"});
    EXPECT_EQ(keysOf(ThreadNut{0.008, 0.001, 0.013, 0.006, 0.0031}), Keys{"chamfer"});  // mouths meet
    EXPECT_EQ(keysOf(SquareBorePlate{0.06, 0.05, 0.03, 0.06, 0.02, 0.02, 0.0}), Keys{"pocket_width"});
    EXPECT_EQ(keysOf(SquareBorePlate{0.06, 0.05, 0.03, 0.02, 0.05, 0.02, 0.0}), Keys{"pocket_depth"});
    EXPECT_EQ(keysOf(SquareBorePlate{0.06, 0.05, 0.03, 0.02, 0.048, 0.02, 0.001}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(SquareBorePlate{0.06, 0.05, 0.03, 0.02, 0.02, 0.002, 0.002}), Keys{"chamfer"});
    EXPECT_EQ(keysOf(KeyedBorePlate{0.06, 0.02, 0.03, 0.02, 0.006, 0.002, 0.02, 0.0}), Keys{"bore_diameter"});
    EXPECT_EQ(keysOf(KeyedBorePlate{0.06, 0.05, 0.03, 0.02, 0.02, 0.002, 0.02, 0.0}), Keys{"key_width"});
    EXPECT_EQ(keysOf(KeyedBorePlate{0.06, 0.05, 0.03, 0.02, 0.006, 0.02, 0.02, 0.0}), Keys{"key_height"});
    EXPECT_EQ(keysOf(KeyedBorePlate{0.06, 0.05, 0.03, 0.02, 0.006, 0.019, 0.02, 0.001}), Keys{"chamfer"});
}

}  // namespace
}  // namespace passung::shape
