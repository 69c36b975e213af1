#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/truth/separation.h"

namespace passung::truth {

namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kInSupport = 1e-9;  // [m]

/// Any direction may stand among the normals, and any among the edges: further ones change nothing.
struct Polyhedron {
    std::vector<Vec3> points, normals, edges;
};

Polyhedron boxOf(const Vec3& low, const Vec3& high) {
    Polyhedron box;
    for (int i = 0; i < 8; ++i)
        box.points.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                                (i & 4) != 0 ? high.z() : low.z());
    box.normals = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    box.edges = box.normals;
    return box;
}

Polyhedron barOf(const shape::SquarePeg& peg) {
    const double x = 0.5 * peg.width, y = 0.5 * peg.depth, c = peg.chamfer;
    Polyhedron bar = boxOf({-x, -y, c}, {x, y, peg.length});
    for (const double i : {-1.0, 1.0})
        for (const double k : {-1.0, 1.0}) {
            bar.points.emplace_back(i * (x - c), k * (y - c), 0.0);
            bar.edges.push_back(Vec3(i, k, 1.0).normalized());
        }
    for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
        bar.normals.push_back((side - Vec3::UnitZ()).normalized());
    return bar;
}

/// What lies beyond one wall of a pocket: `out` from the axis to it, `aside` along it.
Polyhedron wallOf(const shape::SquareBorePlate& plate, const Vec3& out, const Vec3& aside, double half, double end,
                  double width) {
    const double c = plate.chamfer;
    Polyhedron wall;
    for (const double t : {-width, width})
        for (const auto& [s, z] : {std::pair(half, -c), std::pair(half + c, 0.0), std::pair(end, 0.0),
                                   std::pair(end, -plate.height), std::pair(half, -plate.height)})
            wall.points.push_back(s * out + t * aside + Vec3(0, 0, z));
    wall.normals = {out, aside, Vec3::UnitZ(), (Vec3::UnitZ() - out).normalized()};
    wall.edges = {out, aside, Vec3::UnitZ(), (Vec3::UnitZ() + out).normalized()};
    return wall;
}

std::optional<Polyhedron> heldOf(const shape::Shape& shape) {
    if (const auto* box = std::get_if<shape::Box>(&shape)) {
        const Vec3 half(0.5 * box->width, 0.5 * box->depth, 0.5 * box->height);
        return boxOf(-half, half);
    }
    if (const auto* peg = std::get_if<shape::SquarePeg>(&shape)) return barOf(*peg);
    return std::nullopt;
}

/// The convex pieces of an obstacle; none: it is no polyhedron.
std::vector<Polyhedron> piecesOf(const shape::Shape& shape) {
    if (const auto whole = heldOf(shape)) return {*whole};
    const auto* plate = std::get_if<shape::SquareBorePlate>(&shape);
    if (plate == nullptr) return {};
    const double x = 0.5 * plate->width, y = 0.5 * plate->depth;
    const double px = 0.5 * plate->pocket_width, py = 0.5 * plate->pocket_depth;
    std::vector<Polyhedron> pieces;
    for (const double sign : {-1.0, 1.0}) {
        pieces.push_back(wallOf(*plate, {sign, 0, 0}, {0, 1, 0}, px, x, y));
        pieces.push_back(wallOf(*plate, {0, sign, 0}, {1, 0, 0}, py, y, x));
    }
    if (plate->bore_depth < plate->height)
        pieces.push_back(boxOf({-x, -y, -plate->height}, {x, y, -plate->bore_depth}));
    return pieces;
}

Polyhedron moved(const Pose& X, const Polyhedron& body) {
    Polyhedron there = body;
    for (Vec3& p : there.points) p = X * p;
    for (auto* directions : {&there.normals, &there.edges})
        for (Vec3& d : *directions) d = X.q * d;
    return there;
}

double leastAlong(const Polyhedron& body, const Vec3& n) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : body.points) least = std::min(least, n.dot(p));
    return least;
}

/// The direction in which the bodies are farthest apart, from `fixed` to `held`.
struct Axis {
    Vec3 n = Vec3::UnitZ();
    double gap = -std::numeric_limits<double>::infinity();
};

Axis bestAxis(const Polyhedron& held, const Polyhedron& fixed) {
    Axis best;
    const auto tryBoth = [&](const Vec3& direction) {
        for (const Vec3& n : {direction, Vec3(-direction)}) {
            const double gap = leastAlong(held, n) + leastAlong(fixed, -n);
            if (gap > best.gap) best = {n, gap};
        }
    };
    for (const auto* body : {&held, &fixed})
        for (const Vec3& n : body->normals) tryBoth(n);
    for (const Vec3& e : held.edges)
        for (const Vec3& f : fixed.edges) {
            const Vec3 n = e.cross(f);
            if (n.norm() > 1e-5) tryBoth(n.normalized());
        }
    return best;
}

double crossOf(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Counter-clockwise; of points on one line its two ends (Andrew 1979).
std::vector<Vec2> hullOf(std::vector<Vec2> points) {
    std::sort(points.begin(), points.end(),
              [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
    std::vector<Vec2> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t first = hull.size();
        for (const Vec2& p : points) {
            while (hull.size() >= first + 2 &&
                   crossOf(hull.back() - hull[hull.size() - 2], p - hull[hull.size() - 2]) <= 1e-18)
                hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

bool isIn(const std::vector<Vec2>& hull, const Vec2& p) {
    constexpr double kOn = 1e-9;  // [m]
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Vec2 edge = hull[(i + 1) % hull.size()] - hull[i];
        if (crossOf(edge.normalized(), p - hull[i]) < -kOn) return false;
    }
    if (hull.size() > 2) return true;
    const Vec2 edge = hull[1] - hull[0];
    const double along = edge.dot(p - hull[0]) / edge.squaredNorm();
    return along >= 0.0 && along <= 1.0;
}

/// The corners of what two convex figures have in common.
std::vector<Vec2> cornersOfBoth(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
    std::vector<Vec2> corners;
    for (const Vec2& p : a)
        if (isIn(b, p)) corners.push_back(p);
    for (const Vec2& p : b)
        if (isIn(a, p)) corners.push_back(p);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t k = 0; k < b.size(); ++k) {
            const Vec2 e = a[(i + 1) % a.size()] - a[i], f = b[(k + 1) % b.size()] - b[k], d = b[k] - a[i];
            const double turn = crossOf(e, f);
            if (std::abs(turn) < 1e-9 * e.norm() * f.norm()) continue;
            const double s = crossOf(d, f) / turn, t = crossOf(d, e) / turn;
            if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) corners.push_back(a[i] + s * e);
        }
    return corners;
}

/// The places where two bodies touch that are apart along `n` alone.
std::vector<Vec3> placesOf(const Polyhedron& held, const Polyhedron& fixed, const Vec3& n) {
    const auto supportOf = [](const Polyhedron& body, const Vec3& direction) {
        const double least = leastAlong(body, direction);
        std::vector<Vec3> points;
        for (const Vec3& p : body.points)
            if (direction.dot(p) < least + kInSupport) points.push_back(p);
        return points;
    };
    const std::vector<Vec3> a = supportOf(held, n), b = supportOf(fixed, -n);
    if (a.size() == 1) return a;
    if (b.size() == 1) return b;
    const Vec3 e1 = n.unitOrthogonal(), e2 = n.cross(e1);
    const auto flat = [&](const std::vector<Vec3>& points) {
        std::vector<Vec2> there;
        for (const Vec3& p : points) there.emplace_back(e1.dot(p), e2.dot(p));
        return hullOf(there);
    };
    std::vector<Vec3> places;
    for (const Vec2& p : cornersOfBoth(flat(a), flat(b)))
        places.push_back(p.x() * e1 + p.y() * e2 + n.dot(a.front()) * n);
    if (!places.empty()) return places;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : a) middle += p / static_cast<double>(a.size());
    return {middle};
}

class Polyhedra : public Separation {
public:
    Polyhedra(Polyhedron held, std::vector<Polyhedron> fixed) : held_(std::move(held)), fixed_(std::move(fixed)) {}

    bool rowsAt(const Pose& X_WG, double rho, double reach, std::vector<FreedomRow>& rows) const override {
        const Polyhedron held = moved(X_WG, held_);
        for (const Polyhedron& piece : fixed_) {
            const Axis axis = bestAxis(held, piece);
            if (axis.gap > reach) continue;
            for (const Vec3& p : placesOf(held, piece, axis.n)) {
                FreedomRow row;
                row.along << axis.n, (p - X_WG.p).cross(axis.n) / rho;
                row.gap = axis.gap;
                rows.push_back(row);
            }
        }
        return true;
    }

private:
    Polyhedron held_;
    std::vector<Polyhedron> fixed_;  // world
};

}  // namespace

std::unique_ptr<Separation> separationOfPolyhedra(const shape::Shape& held, std::span<const PlacedShape> obstacles) {
    const auto body = heldOf(held);
    if (!body) return nullptr;
    std::vector<Polyhedron> fixed;
    for (const auto& [shape, X_WO] : obstacles) {
        const auto pieces = piecesOf(shape);
        if (pieces.empty()) return nullptr;
        for (const Polyhedron& piece : pieces) fixed.push_back(moved(X_WO, piece));
    }
    return std::make_unique<Polyhedra>(*body, std::move(fixed));
}

}  // namespace passung::truth
