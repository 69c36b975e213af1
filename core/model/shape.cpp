#include "core/model/shape.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace passung::model {

namespace {

/// Nothing that a hand touches is larger; squares of such lengths stay far from overflow.
constexpr double kLargest = 1000.0;  // [m]

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

double square(double x) { return x * x; }

/// Squared distance of (x, y) to the segment from (ax, ay) to (bx, by).
double squaredToSegment(double x, double y, double ax, double ay, double bx, double by) {
    const double ex = bx - ax, ey = by - ay;
    const double px = x - ax, py = y - ay;
    const double length2 = ex * ex + ey * ey;
    const double t = length2 > 0.0 ? std::clamp((px * ex + py * ey) / length2, 0.0, 1.0) : 0.0;
    return square(px - t * ex) + square(py - t * ey);
}

/// Signed distance to a box with half edges h about the origin, from the excesses q = |p| - h.
template <class Excess>
double fromExcess(const Excess& q) {
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

double distanceTo(const Sphere& s, const Vec3& p) { return p.norm() - 0.5 * s.diameter; }

double distanceTo(const Box& b, const Vec3& p) {
    const Vec3 q = p.cwiseAbs() - 0.5 * Vec3(b.width, b.depth, b.height);
    return fromExcess(q);
}

double distanceTo(const Cylinder& c, const Vec3& p) {
    const double r = std::sqrt(square(p.x()) + square(p.y()));
    const Eigen::Vector2d q(r - 0.5 * c.diameter, std::abs(p.z()) - 0.5 * c.length);
    return fromExcess(q);
}

double distanceTo(const Sheet& s, const Vec3& p) {
    const double dx = std::max(std::abs(p.x()) - 0.5 * s.width, 0.0);
    const double dy = std::max(std::abs(p.y()) - 0.5 * s.depth, 0.0);
    return std::sqrt(square(dx) + square(dy) + square(p.z()));
}

/// A solid of revolution: the nearest surface point lies in the half plane of p, so the distance to the profile in
/// (r, z) is the distance. The profile is convex: inside means below all of its lines.
double distanceTo(const Peg& peg, const Vec3& p) {
    const double r = std::sqrt(square(p.x()) + square(p.y()));
    const double z = p.z();
    const double radius = 0.5 * peg.diameter, c = peg.chamfer, length = peg.length;
    const double d2 = std::min(
        {squaredToSegment(r, z, 0.0, 0.0, radius - c, 0.0), squaredToSegment(r, z, radius - c, 0.0, radius, c),
         squaredToSegment(r, z, radius, c, radius, length), squaredToSegment(r, z, radius, length, 0.0, length)});
    const bool inside = z > 0.0 && z < length && r < radius && r - z < radius - c;
    return inside ? -std::sqrt(d2) : std::sqrt(d2);
}

/// Squared distance to a horizontal rectangle (half edges hx, hy, about the axis) without the open disc of `hole`
/// inside it, `dz` above or below. In the plane: from outside the rectangle its border is nearest, and the hole does
/// not reach that; from inside the hole its rim is.
double squaredToFace(double ex, double ey, double r, double hole, double dz) {
    if (r < hole) return square(hole - r) + square(dz);
    return square(std::max(ex, 0.0)) + square(std::max(ey, 0.0)) + square(dz);
}

/// Least distance over the pieces of the surface; the sign from membership. Pieces: top face, bottom face, the nearer
/// of each pair of sides, and (in r, z) chamfer cone, bore wall, floor of a blind bore.
double distanceTo(const BorePlate& plate, const Vec3& p) {
    const double r = std::sqrt(square(p.x()) + square(p.y()));
    const double z = p.z();
    const double bore = 0.5 * plate.bore_diameter, mouth = bore + plate.chamfer;
    const bool through = plate.bore_depth >= plate.height;
    const double floor_z = through ? -plate.height : -plate.bore_depth;
    // How far p is beyond the planes of the box, per axis; ≤ 0 between them.
    const double ex = std::abs(p.x()) - 0.5 * plate.width;
    const double ey = std::abs(p.y()) - 0.5 * plate.depth;
    const double ez = std::max(z, -plate.height - z);

    const double side_z2 = square(std::max(ez, 0.0));
    double d2 = std::min(square(ex) + square(std::max(ey, 0.0)), square(ey) + square(std::max(ex, 0.0))) + side_z2;
    d2 = std::min(d2, squaredToFace(ex, ey, r, mouth, z));
    d2 = std::min(d2, squaredToFace(ex, ey, r, through ? bore : 0.0, z + plate.height));
    d2 = std::min(d2, squaredToSegment(r, z, bore, -plate.chamfer, bore, floor_z));
    if (plate.chamfer > 0.0) d2 = std::min(d2, squaredToSegment(r, z, mouth, 0.0, bore, -plate.chamfer));
    if (!through) d2 = std::min(d2, square(std::max(r - bore, 0.0)) + square(z - floor_z));

    const bool in_cavity = (through || z > floor_z) && r < bore + std::max(0.0, z + plate.chamfer);
    const bool inside = ex < 0.0 && ey < 0.0 && ez < 0.0 && !in_cavity;
    return inside ? -std::sqrt(d2) : std::sqrt(d2);
}

/// Collects what is wrong with the values of one shape.
class Check {
public:
    explicit Check(const char* kind) : kind_(kind) {}

    void length(const char* key, double value) {
        if (!(value > 0.0 && value <= kLargest)) add(key, value, "must be a length above 0 m, at most 1000 m");
    }
    void chamfer(double value, double limit, const std::string& requirement) {
        if (!(value >= 0.0 && value <= kLargest))
            add("chamfer", value, "must be a length, 0 m or more (0 = sharp)");
        else if (!(value < limit))
            add("chamfer", value, requirement);
    }
    void add(const char* key, double value, const std::string& requirement) {
        std::array<char, 32> text{};
        const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
        Error error;
        error.message = std::string(kind_) + ": " + requirement;
        error.key = key;
        error.value = std::string(text.data(), end) + " m";
        errors_.push_back(error);
    }
    bool empty() const { return errors_.empty(); }
    std::vector<Error> take() { return std::move(errors_); }

private:
    const char* kind_;
    std::vector<Error> errors_;
};

void validateLengths(const Sphere& s, Check& check) { check.length("diameter", s.diameter); }

void validateLengths(const Box& b, Check& check) {
    check.length("width", b.width);
    check.length("depth", b.depth);
    check.length("height", b.height);
}

void validateLengths(const Cylinder& c, Check& check) {
    check.length("diameter", c.diameter);
    check.length("length", c.length);
}

void validateLengths(const Sheet& s, Check& check) {
    check.length("width", s.width);
    check.length("depth", s.depth);
}

void validateLengths(const Peg& p, Check& check) {
    check.length("diameter", p.diameter);
    check.length("length", p.length);
    if (!check.empty()) return;
    check.chamfer(p.chamfer, std::min(0.5 * p.diameter, p.length),
                  "must be less than half the diameter and less than the length");
}

void validateLengths(const BorePlate& p, Check& check) {
    check.length("width", p.width);
    check.length("depth", p.depth);
    check.length("height", p.height);
    check.length("bore_diameter", p.bore_diameter);
    check.length("bore_depth", p.bore_depth);
    if (!check.empty()) return;
    const double half = 0.5 * std::min(p.width, p.depth);
    check.chamfer(p.chamfer, std::min(p.bore_depth, p.height), "must be less than the depth of the bore");
    if (!check.empty()) return;
    if (!(0.5 * p.bore_diameter < half))
        check.add("bore_diameter", p.bore_diameter, "must be less than the plate's width and depth");
    else if (!(0.5 * p.bore_diameter + p.chamfer < half))
        check.add("chamfer", p.chamfer, "the widened mouth must lie inside the plate's top face");
}

}  // namespace

const char* kindName(const Shape& shape) {
    return std::visit(Overloaded{[](const Sphere&) { return "sphere"; }, [](const Box&) { return "box"; },
                                 [](const Cylinder&) { return "cylinder"; }, [](const Sheet&) { return "sheet"; },
                                 [](const Peg&) { return "peg"; }, [](const BorePlate&) { return "bore_plate"; }},
                      shape);
}

std::vector<double> dimensions(const Shape& shape) {
    using Values = std::vector<double>;
    return std::visit(Overloaded{[](const Sphere& s) { return Values{s.diameter}; },
                                 [](const Box& b) {
                                     return Values{b.width, b.depth, b.height};
                                 },
                                 [](const Cylinder& c) {
                                     return Values{c.diameter, c.length};
                                 },
                                 [](const Sheet& s) {
                                     return Values{s.width, s.depth};
                                 },
                                 [](const Peg& p) {
                                     return Values{p.diameter, p.length, p.chamfer};
                                 },
                                 [](const BorePlate& p) {
                                     return Values{p.width,         p.depth,      p.height,
                                                   p.bore_diameter, p.bore_depth, p.chamfer};
                                 }},
                      shape);
}

std::vector<Error> validate(const Shape& shape) {
    Check check(kindName(shape));
    std::visit([&](const auto& s) { validateLengths(s, check); }, shape);
    return check.take();
}

double signedDistance(const Shape& shape, const Vec3& point) {
    return std::visit([&](const auto& s) { return distanceTo(s, point); }, shape);
}

}  // namespace passung::model
