#include "core/closed_form/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/closed_form/solid_parts.h"
#include "core/closed_form/thread_solid.h"

namespace passung::closed_form {

namespace {

using shape::BorePlate;
using shape::Box;
using shape::KeyedBorePlate;
using shape::KeyedPeg;
using shape::Peg;
using shape::SquareBorePlate;
using shape::SquarePeg;

Curve circle(const Vec3& centre, double radius) {
    return {Curve::Kind::Circle, centre, radius * Vec3::UnitX(), radius * Vec3::UnitY(), std::numbers::pi, 0.0};
}

/// The part of a circle on the side of -x where |y| > `half`, or x < 0.
Curve arcBeside(const Vec3& centre, double radius, double half) {
    Curve arc = circle(centre, radius);
    arc.e1 = -arc.e1;
    arc.e2 = -arc.e2;
    arc.end = std::numbers::pi - std::asin(half / radius);
    return arc;
}

/// A convex polyhedron between parallel outlines, each the rectangle |x| <= hx, |y| <= hy at a height.
struct RectangleAt {
    double z, hx, hy;
};

Vec3 corner(const RectangleAt& level, int i) {
    constexpr std::array<double, 4> kX = {1, -1, -1, 1}, kY = {1, 1, -1, -1};
    const auto at = static_cast<std::size_t>(i % 4);
    return {kX[at] * level.hx, kY[at] * level.hy, level.z};
}

/// Rings of edges and those between them.
void addRectangleEdges(const std::vector<RectangleAt>& levels, std::vector<Curve>& edges) {
    for (std::size_t k = 0; k < levels.size(); ++k)
        for (int i = 0; i < 4; ++i) {
            edges.push_back(straight(corner(levels[k], i), corner(levels[k], i + 1)));
            if (k + 1 < levels.size()) edges.push_back(straight(corner(levels[k], i), corner(levels[k + 1], i)));
        }
}

/// The planes |x| <= hx, |y| <= hy.
void addSides(double hx, double hy, Lump& lump) {
    for (const double sign : {1.0, -1.0}) {
        lump.faces.push_back(plane({sign * hx, 0, 0}, {sign, 0, 0}));
        lump.faces.push_back(plane({0, sign * hy, 0}, {0, sign, 0}));
    }
}

SmoothSolid solidFrom(const shape::Sphere& s) {
    const double radius = 0.5 * s.diameter;
    Curve core;
    core.thickness = radius;
    return {{{{sphere(Vec3::Zero(), radius)}}}, {}, {core}};
}

SmoothSolid solidFrom(const shape::Torus& t) {
    Curve core = circle(Vec3::Zero(), 0.5 * t.diameter);
    core.thickness = 0.5 * t.tube_diameter;
    return {{{{torus(Vec3::Zero(), Vec3::UnitZ(), 0.5 * t.diameter, core.thickness)}}}, {}, {core}};
}

SmoothSolid solidFrom(const Box& b) {
    SmoothSolid solid;
    Lump& lump = solid.lumps.emplace_back();
    addSides(0.5 * b.width, 0.5 * b.depth, lump);
    addEnds(-0.5 * b.height, 0.5 * b.height, lump);
    addRectangleEdges({{-0.5 * b.height, 0.5 * b.width, 0.5 * b.depth}, {0.5 * b.height, 0.5 * b.width, 0.5 * b.depth}},
                      solid.edges);
    return solid;
}

/// A round bar from `low` to `high` with a chamfer at its low end.
void addRoundBar(double radius, double low, double high, double chamfer, SmoothSolid& solid) {
    Lump& lump = solid.lumps.emplace_back();
    lump.faces.push_back(cylinder(Vec3::Zero(), Vec3::UnitZ(), radius));
    addEnds(low, high, lump);
    solid.edges.push_back(circle({0, 0, low}, radius - chamfer));
    solid.edges.push_back(circle({0, 0, high}, radius));
    if (chamfer > 0.0) {
        lump.faces.push_back(cone({0, 0, low}, Vec3::UnitZ(), radius - chamfer, 1.0));
        solid.edges.push_back(circle({0, 0, low + chamfer}, radius));
    }
    Curve core = straight({0, 0, low + chamfer}, {0, 0, high});
    core.thickness = radius;
    solid.cores.push_back(core);
}

SmoothSolid solidFrom(const shape::Cylinder& c) {
    SmoothSolid solid;
    addRoundBar(0.5 * c.diameter, -0.5 * c.length, 0.5 * c.length, 0.0, solid);
    return solid;
}

SmoothSolid solidFrom(const Peg& peg) {
    SmoothSolid solid;
    addRoundBar(0.5 * peg.diameter, 0.0, peg.length, peg.chamfer, solid);
    return solid;
}

/// A bar of the rectangle from x0 to x1 and |y| <= hy, from z = 0 up, with a chamfer at its low end on the sides that
/// are named by their normals.
void addBar(double x0, double x1, double hy, double length, double chamfer, bool back, SmoothSolid& solid) {
    Lump& lump = solid.lumps.emplace_back();
    addEnds(0.0, length, lump);
    const double middle = 0.5 * (x0 + x1), hx = 0.5 * (x1 - x0);
    const Vec3 shift(middle, 0, 0);
    const auto side = [&](const Vec3& normal, double half, bool bevelled) {
        lump.faces.push_back(plane(shift + half * normal, normal));
        if (chamfer > 0.0 && bevelled)
            lump.faces.push_back(plane(shift + half * normal + Vec3(0, 0, chamfer), normal - Vec3::UnitZ()));
    };
    side(Vec3::UnitX(), hx, true);
    side(-Vec3::UnitX(), hx, back);
    side(Vec3::UnitY(), hy, true);
    side(-Vec3::UnitY(), hy, true);
    std::vector<RectangleAt> levels = {{length, hx, hy}, {chamfer, hx, hy}};
    if (chamfer > 0.0) levels.push_back({0.0, hx - chamfer, hy - chamfer});
    const std::size_t first = solid.edges.size();
    addRectangleEdges(levels, solid.edges);
    for (std::size_t i = first; i < solid.edges.size(); ++i) solid.edges[i].centre += shift;
}

SmoothSolid solidFrom(const SquarePeg& peg) {
    SmoothSolid solid;
    addBar(-0.5 * peg.width, 0.5 * peg.width, 0.5 * peg.depth, peg.length, peg.chamfer, true, solid);
    return solid;
}

SmoothSolid solidFrom(const KeyedPeg& peg) {
    SmoothSolid solid;
    const double radius = 0.5 * peg.diameter;
    addRoundBar(radius, 0.0, peg.length, peg.chamfer, solid);
    addBar(0.0, radius + peg.key_height, 0.5 * peg.key_width, peg.length, peg.chamfer, false, solid);
    return solid;
}

/// Faces that every lump of a plate has, and the plate's outer edges.
Lump slab(double width, double depth, double height) {
    Lump lump;
    addEnds(-height, 0.0, lump);
    addSides(0.5 * width, 0.5 * depth, lump);
    return lump;
}

template <class Plate>
void addOutside(const Plate& plate, SmoothSolid& solid) {
    addRectangleEdges(
        {{-plate.height, 0.5 * plate.width, 0.5 * plate.depth}, {0, 0.5 * plate.width, 0.5 * plate.depth}},
        solid.edges);
    if (plate.bore_depth >= plate.height) return;
    Lump floor = slab(plate.width, plate.depth, plate.height);
    floor.faces[0] = plane({0, 0, -plate.bore_depth}, {0, 0, 1});
    solid.lumps.push_back(floor);
}

/// The wall of a round bore with its chamfer, added to a lump.
void addHollow(double radius, double chamfer, Lump& lump) {
    lump.faces.push_back(cylinder(Vec3::Zero(), Vec3::UnitZ(), radius, true));
    if (chamfer > 0.0) lump.faces.push_back(cone(Vec3::Zero(), Vec3::UnitZ(), radius + chamfer, 1.0, true));
}

SmoothSolid solidFrom(const BorePlate& plate) {
    SmoothSolid solid;
    const double radius = 0.5 * plate.bore_diameter;
    Lump around = slab(plate.width, plate.depth, plate.height);
    addHollow(radius, plate.chamfer, around);
    solid.lumps.push_back(around);
    solid.edges.push_back(circle({0, 0, -plate.chamfer}, radius));
    if (plate.chamfer > 0.0) solid.edges.push_back(circle(Vec3::Zero(), radius + plate.chamfer));
    if (plate.bore_depth >= plate.height) solid.edges.push_back(circle({0, 0, -plate.height}, radius));
    addOutside(plate, solid);
    return solid;
}

/// A flat wall of a pocket whose material lies beyond it in the direction `into`, with its chamfer.
void addWall(const Vec3& into, double half, double chamfer, Lump& lump) {
    lump.faces.push_back(plane(half * into, -into));
    if (chamfer > 0.0) lump.faces.push_back(plane((half + chamfer) * into, Vec3::UnitZ() - into));
}

SmoothSolid solidFrom(const SquareBorePlate& plate) {
    SmoothSolid solid;
    const double hx = 0.5 * plate.pocket_width, hy = 0.5 * plate.pocket_depth;
    for (const double sign : {1.0, -1.0}) {
        for (const auto& [into, half] : {std::pair(Vec3(sign, 0, 0), hx), std::pair(Vec3(0, sign, 0), hy)}) {
            Lump wall = slab(plate.width, plate.depth, plate.height);
            addWall(into, half, plate.chamfer, wall);
            solid.lumps.push_back(wall);
        }
    }
    const double c = plate.chamfer;
    std::vector<RectangleAt> levels = {{-c, hx, hy}};
    if (c > 0.0) levels.push_back({0.0, hx + c, hy + c});
    if (plate.bore_depth >= plate.height) levels.push_back({-plate.height, hx, hy});
    for (const RectangleAt& level : levels)  // the corners between them are concave: no edges
        for (int i = 0; i < 4; ++i) solid.edges.push_back(straight(corner(level, i), corner(level, i + 1)));
    addOutside(plate, solid);
    return solid;
}

SmoothSolid solidFrom(const KeyedBorePlate& plate) {
    SmoothSolid solid;
    const double radius = 0.5 * plate.bore_diameter, half = 0.5 * plate.key_width, c = plate.chamfer;
    const double reach = radius + plate.key_height;
    // Where the bore meets the keyway's side, both wider by `grown`.
    const auto crossing = [&](double grown) {
        return std::sqrt((radius + grown) * (radius + grown) - (half + grown) * (half + grown));
    };
    const auto lump = [&] { return slab(plate.width, plate.depth, plate.height); };
    for (const double sign : {1.0, -1.0}) {  // beside the keyway, outside the bore
        Lump beside = lump();
        addHollow(radius, c, beside);
        addWall({0, sign, 0}, half, c, beside);
        solid.lumps.push_back(beside);
    }
    Lump opposite = lump();
    addHollow(radius, c, opposite);
    opposite.faces.push_back(plane(Vec3::Zero(), Vec3::UnitX()));
    solid.lumps.push_back(opposite);
    Lump top = lump();
    addWall({1, 0, 0}, reach, c, top);
    solid.lumps.push_back(top);

    solid.edges.push_back(arcBeside({0, 0, -c}, radius, half));
    if (c > 0.0) solid.edges.push_back(arcBeside(Vec3::Zero(), radius + c, half + c));
    if (plate.bore_depth >= plate.height) solid.edges.push_back(arcBeside({0, 0, -plate.height}, radius, half));
    const double low = -std::min(plate.bore_depth, plate.height);
    for (const double sign : {1.0, -1.0}) {
        solid.edges.push_back(straight({crossing(0.0), sign * half, low}, {crossing(0.0), sign * half, -c}));
        // Where the cone of the mouth meets the keyway's slope: a conic, in pieces within some nanometres of it.
        constexpr int kPieces = 16;
        const auto at = [&](int i) {
            const double grown = c * i / kPieces;
            return Vec3(crossing(grown), sign * (half + grown), grown - c);
        };
        for (int i = 0; c > 0.0 && i < kPieces; ++i) solid.edges.push_back(straight(at(i), at(i + 1)));
    }
    std::vector<std::pair<double, double>> levels = {{-c, 0.0}};  // height, growth
    if (c > 0.0) levels.emplace_back(0.0, c);
    if (plate.bore_depth >= plate.height) levels.emplace_back(-plate.height, 0.0);
    for (const auto& [z, grown] : levels) {
        const double from = crossing(grown);
        for (const double sign : {1.0, -1.0})
            solid.edges.push_back(
                straight({from, sign * (half + grown), z}, {reach + grown, sign * (half + grown), z}));
        solid.edges.push_back(straight({reach + grown, -(half + grown), z}, {reach + grown, half + grown, z}));
    }
    addOutside(plate, solid);
    return solid;
}

/// Between a face and the opposite one of its lump, if it is one.
double thicknessBetween(const Face& face, const Face& other) {
    constexpr double kOpposite = -0.999;
    const double none = std::numeric_limits<double>::infinity();
    if (face.kind == Face::Kind::Torus) return 2.0 * face.tube;
    if (face.kind == Face::Kind::Helicoid) return 0.25 * face.pitch;  // of a ridge; at its crest's edges half of it
    if (!face.hollow && (face.kind == Face::Kind::Cylinder || face.kind == Face::Kind::Sphere))
        return 2.0 * face.radius;
    if (!other.isPlane()) return none;
    if (face.isPlane()) return face.axis.dot(other.axis) < kOpposite ? -valueOf(other, face.origin) : none;
    const bool along = std::abs(face.axis.dot(other.axis)) < 1.0 + kOpposite;
    return face.kind == Face::Kind::Cylinder && along ? -valueOf(other, face.origin) - face.radius : none;
}

/// Amid a groove the flanks are 0.216 pitches away, and a look goes an eighth of one.
constexpr double kThreadSight = 0.17;
constexpr double kTurn = 2.0 * std::numbers::pi;

double widestOf(const Curve& spiral, double begin, double end) noexcept {
    return std::max(std::abs(spiral.radius + spiral.widening * begin), std::abs(spiral.radius + spiral.widening * end));
}

/// No point of a line is farther from its frame's origin [m].
double reachOf(const Curve& line) noexcept {
    if (line.kind != Curve::Kind::Spiral) return line.centre.norm() + line.extent() + line.thickness;
    const double highest = std::max(std::abs(line.centre.z() + line.climb * line.begin),
                                    std::abs(line.centre.z() + line.climb * line.end));
    return std::hypot(widestOf(line, line.begin, line.end), highest);
}

std::optional<SmoothSolid> solidFrom(const shape::Sheet&) { return std::nullopt; }
SmoothSolid solidFrom(const shape::ThreadBolt& bolt) { return threadSolid(bolt); }
SmoothSolid solidFrom(const shape::ThreadNut& nut) { return threadSolid(nut); }

constexpr double kConicOnFace = 2e-8;  // of a conic in pieces [m]

/// The faces of a lump that meet in an edge, where they are two, and those at which it ends, where three meet.
void nameFaces(const Lump& lump, Curve& edge) {
    if (edge.kind == Curve::Kind::Spiral) return;
    const auto isOn = [&](const Face& face, double share) {
        return std::abs(valueOf(face, pointOf(edge, share * edge.end))) < kConicOnFace;
    };
    std::vector<Face> sides;
    for (const Face& face : lump.faces)
        if (isOn(face, -0.9) && isOn(face, 0.1) && isOn(face, 0.8)) sides.push_back(face);
    if (edge.sides || sides.size() != 2 || valueOf(lump, pointOf(edge, 0.1 * edge.end)) > kConicOnFace) return;
    edge.sides = std::array{sides[0], sides[1]};
    if (edge.kind == Curve::Kind::Circle)
        for (std::size_t i = 0; i <= kCirclePieces / kFixedEvery; ++i)
            edge.fixed.push_back(frameOf(edge, placeAt(edge, fixedPlace(edge, i))));
    if (edge.kind != Curve::Kind::Straight) return;
    for (const double end : {-1.0, 1.0}) {
        std::vector<Face> caps;
        for (const Face& face : lump.faces)
            if (isOn(face, end) && !isOn(face, 0.1)) caps.push_back(face);
        if (caps.size() == 1) edge.caps[end < 0.0 ? 0 : 1] = caps[0];
    }
}

}  // namespace

std::optional<SmoothSolid> solidOf(const shape::Shape& shape) {
    auto solid = std::visit([](const auto& s) -> std::optional<SmoothSolid> { return solidFrom(s); }, shape);
    if (!solid) return solid;
    for (Curve& edge : solid->edges)
        for (const Lump& lump : solid->lumps) nameFaces(lump, edge);
    return solid;
}

LinePlace placeAt(const Curve& curve, double t) noexcept {
    if (curve.kind != Curve::Kind::Circle && curve.kind != Curve::Kind::Spiral) return {.t = t};
    return {t, std::cos(t), std::sin(t)};
}

Vec3 pointOf(const Curve& curve, const LinePlace& at) noexcept {
    switch (curve.kind) {
        case Curve::Kind::Circle:
            return curve.centre + at.cosine * curve.e1 + at.sine * curve.e2;
        case Curve::Kind::Straight:
            return curve.centre + at.t * curve.e1;
        case Curve::Kind::Spiral:
            return curve.centre + (curve.radius + curve.widening * at.t) * (at.cosine * curve.e1 + at.sine * curve.e2) +
                   curve.climb * at.t * curve.e3;
        case Curve::Kind::Point:
            break;
    }
    return curve.centre;
}

Vec3 slopeOf(const Curve& curve, const LinePlace& at) noexcept {
    switch (curve.kind) {
        case Curve::Kind::Circle:
            return at.cosine * curve.e2 - at.sine * curve.e1;
        case Curve::Kind::Straight:
            return curve.e1;
        case Curve::Kind::Spiral: {
            const double c = at.cosine, s = at.sine, t = at.t;
            return curve.widening * (c * curve.e1 + s * curve.e2) +
                   (curve.radius + curve.widening * t) * (c * curve.e2 - s * curve.e1) + curve.climb * curve.e3;
        }
        case Curve::Kind::Point:
            break;
    }
    return Vec3::Zero();
}

Vec3 bendOf(const Curve& curve, const LinePlace& at) noexcept {
    if (curve.kind == Curve::Kind::Spiral) {
        const double c = at.cosine, s = at.sine, t = at.t;
        return 2.0 * curve.widening * (c * curve.e2 - s * curve.e1) -
               (curve.radius + curve.widening * t) * (c * curve.e1 + s * curve.e2);
    }
    if (curve.kind != Curve::Kind::Circle) return Vec3::Zero();
    return -at.cosine * curve.e1 - at.sine * curve.e2;
}

double fixedPlace(const Curve& circle, std::size_t i) noexcept {
    const double piece = 2.0 * circle.end / kCirclePieces;
    return -circle.end + piece * (kFixedEvery * static_cast<int>(i));
}

EdgeFrame frameOf(const Curve& edge, const LinePlace& at) noexcept {
    const Vec3 p = pointOf(edge, at);
    EdgeFrame frame{.way = slopeOf(edge, at).normalized(),
                    .a = gradientOf((*edge.sides)[0], p),
                    .b = gradientOf((*edge.sides)[1], p)};
    frame.turn = frame.a.cross(frame.b).dot(frame.way);
    return frame;
}

std::size_t piecesOf(const Curve& line) noexcept {
    if (line.kind != Curve::Kind::Spiral) return 1;
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil((line.end - line.begin) / kTurn)));
}

LinePiece pieceOf(const Curve& line, std::size_t i) noexcept {
    if (line.kind != Curve::Kind::Spiral) return {-line.end, line.end, line.centre, line.extent(), line.extent()};
    LinePiece piece;
    piece.begin = line.begin + kTurn * static_cast<double>(i);
    piece.end = i + 1 < piecesOf(line) ? line.begin + kTurn * static_cast<double>(i + 1) : line.end;
    const double widest = widestOf(line, piece.begin, piece.end), half = 0.5 * (piece.end - piece.begin);
    piece.middle = line.centre + 0.5 * (piece.begin + piece.end) * line.climb * line.e3;
    piece.extent = std::hypot(widest, half * line.climb);
    piece.speed = std::sqrt(widest * widest + line.widening * line.widening + line.climb * line.climb);
    return piece;
}

double valueOf(const Lump& lump, const Vec3& p) noexcept {
    double most = -std::numeric_limits<double>::infinity();
    for (const Face& face : lump.faces) most = std::max(most, valueOf(face, p));
    return most;
}

double valueOf(const SmoothSolid& solid, const Vec3& p) noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (const Lump& lump : solid.lumps) least = std::min(least, valueOf(lump, p));
    return least;
}

double reachOf(const SmoothSolid& solid) noexcept {
    double most = 0.0;
    for (const auto* lines : {&solid.edges, &solid.cores})
        for (const Curve& line : *lines) most = std::max(most, reachOf(line));
    return most;
}

bool isThread(const SmoothSolid& solid) noexcept { return std::isfinite(sightOf(solid)); }

double sightOf(const SmoothSolid& solid) noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (const Lump& lump : solid.lumps)
        for (const Face& face : lump.faces)
            if (face.kind == Face::Kind::Helicoid) least = std::min(least, kThreadSight * face.pitch);
    return least;
}

double thicknessOf(const SmoothSolid& solid) noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (const Lump& lump : solid.lumps)
        for (const Face& face : lump.faces)
            for (const Face& other : lump.faces) {
                const double between = thicknessBetween(face, other);
                if (between > 0.0) least = std::min(least, between);
            }
    return least;
}

}  // namespace passung::closed_form
