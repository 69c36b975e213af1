#include "analysis/truth/surface_pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace passung::truth {
namespace {

using Vec2 = Eigen::Vector2d;
using Circle = TurnedPiece::Circle;

constexpr int kParts = 4;       // of a whole turn
constexpr int kLeastSides = 8;  // of a polygon around a hole

Vec2 direction(double turns) {
    return {std::cos(2.0 * std::numbers::pi * turns), std::sin(2.0 * std::numbers::pi * turns)};
}

/// Where the tangents of the unit circle at two directions meet.
Vec2 meetingOfTangents(const Vec2& a, const Vec2& b) { return (a + b) / (1.0 + a.dot(b)); }

Vec3 onCircle(const Vec2& d, const Circle& c) { return {c.radius * d.x(), c.radius * d.y(), c.height}; }

Circle between(const Circle& a, const Circle& b) { return {0.5 * (a.radius + b.radius), 0.5 * (a.height + b.height)}; }

class Builder {
public:
    SurfacePieces pieces;

    void turn(const Circle& low, const Circle& high) { pieces.turned.push_back({{}, low, high}); }
    void disc(double radius, double height) { turn({0.0, height}, {radius, height}); }
    void rectangle(double half_width, double half_depth, double height) {
        pieces.flat.push_back({{-half_width, -half_depth, height},
                               {half_width, -half_depth, height},
                               {half_width, half_depth, height},
                               {-half_width, half_depth, height}});
    }
    void sides(double half_width, double half_depth, double low, double high) {
        for (const double side : {-1.0, 1.0}) {
            const double x = side * half_width, y = side * half_depth;
            pieces.flat.push_back(
                {{x, -half_depth, low}, {x, half_depth, low}, {x, half_depth, high}, {x, -half_depth, high}});
            pieces.flat.push_back(
                {{-half_width, y, low}, {half_width, y, low}, {half_width, y, high}, {-half_width, y, high}});
        }
    }
    /// A rectangle with a round hole: a ring about the hole, and what is beyond a polygon that lies in this ring.
    void rectangleWithHole(double half_width, double half_depth, double hole, double height) {
        const double ring = 0.5 * (hole + std::min(half_width, half_depth));
        const double angle = std::acos(0.5 * (1.0 + hole / ring));  // of half a side, its middle beyond the hole
        const int sides = std::max(kLeastSides, static_cast<int>(std::ceil(std::numbers::pi / angle)));
        turn({hole, height}, {ring, height});
        for (int k = 0; k < sides; ++k)
            beyond(ring * direction(static_cast<double>(k) / sides),
                   ring * direction(static_cast<double>(k + 1) / sides), {half_width, half_depth}, height);
    }

private:
    /// The part of a rectangle between two rays through `a` and `b`, beyond the line of both.
    void beyond(const Vec2& a, const Vec2& b, const Vec2& half, double height) {
        const auto border = [&](const Vec2& p) {
            return std::min(half.x() / std::max(std::abs(p.x()), 1e-300),
                            half.y() / std::max(std::abs(p.y()), 1e-300)) *
                   p;
        };
        const Vec2 end_a = border(a), end_b = border(b);
        FlatPiece piece{{a.x(), a.y(), height}, {end_a.x(), end_a.y(), height}};
        for (const Vec2& corner : {Vec2(half.x(), half.y()), Vec2(-half.x(), half.y()), Vec2(-half.x(), -half.y()),
                                   Vec2(half.x(), -half.y())})
            if (a.x() * corner.y() - a.y() * corner.x() > 0.0 && corner.x() * b.y() - corner.y() * b.x() > 0.0)
                piece.emplace_back(corner.x(), corner.y(), height);
        piece.emplace_back(end_b.x(), end_b.y(), height);
        piece.emplace_back(b.x(), b.y(), height);
        pieces.flat.push_back(std::move(piece));
    }
};

void add(const shape::Cylinder& c, Builder& builder) {
    const double radius = 0.5 * c.diameter, half = 0.5 * c.length;
    builder.disc(radius, -half);
    builder.turn({radius, -half}, {radius, half});
    builder.disc(radius, half);
}

void add(const shape::Box& b, Builder& builder) {
    const double w = 0.5 * b.width, d = 0.5 * b.depth, h = 0.5 * b.height;
    builder.rectangle(w, d, -h);
    builder.sides(w, d, -h, h);
    builder.rectangle(w, d, h);
}

void add(const shape::Peg& peg, Builder& builder) {
    const double radius = 0.5 * peg.diameter;
    builder.disc(radius - peg.chamfer, 0.0);
    if (peg.chamfer > 0.0) builder.turn({radius - peg.chamfer, 0.0}, {radius, peg.chamfer});
    builder.turn({radius, peg.chamfer}, {radius, peg.length});
    builder.disc(radius, peg.length);
}

void add(const shape::BorePlate& plate, Builder& builder) {
    const double w = 0.5 * plate.width, d = 0.5 * plate.depth, bore = 0.5 * plate.bore_diameter;
    const bool through = plate.bore_depth >= plate.height;
    const double floor = through ? -plate.height : -plate.bore_depth;
    builder.rectangleWithHole(w, d, bore + plate.chamfer, 0.0);
    if (plate.chamfer > 0.0) builder.turn({bore, -plate.chamfer}, {bore + plate.chamfer, 0.0});
    builder.turn({bore, floor}, {bore, -plate.chamfer});
    builder.sides(w, d, -plate.height, 0.0);
    if (through) {
        builder.rectangleWithHole(w, d, bore, -plate.height);
    } else {
        builder.disc(bore, floor);
        builder.rectangle(w, d, -plate.height);
    }
}

/// Of other kinds nothing.
template <class Other>
void add(const Other&, Builder&) {}

}  // namespace

std::array<Sector, 2> Sector::halves() const {
    const double c = std::sqrt(0.5 * (1.0 + cosine)), s = std::sqrt(0.5 * (1.0 - cosine));
    const Vec2 across(-middle.y(), middle.x());
    return {Sector{c * middle - s * across, 0.5 * half_angle, c, s},
            Sector{c * middle + s * across, 0.5 * half_angle, c, s}};
}

Sector Sector::doubled() const {
    const Vec2 twice(middle.x() * middle.x() - middle.y() * middle.y(), 2.0 * middle.x() * middle.y());
    if (half_angle >= 0.5 * std::numbers::pi) return {.middle = twice};
    return {twice, 2.0 * half_angle, cosine * cosine - sine * sine, 2.0 * sine * cosine};
}

std::array<Vec3, 8> TurnedPiece::corners() const {
    const Vec2& m = sector.middle;
    const Vec2 aside = sector.sine * Vec2(-m.y(), m.x());
    const Vec2 from = sector.cosine * m - aside, to = sector.cosine * m + aside;
    const std::array<Vec2, 4> around{from, meetingOfTangents(from, m), meetingOfTangents(m, to), to};
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < around.size(); ++i) {
        corners[i] = onCircle(around[i], low);
        corners[i + around.size()] = onCircle(around[i], high);
    }
    return corners;
}

Vec3 TurnedPiece::middle() const { return onCircle(sector.middle, between(low, high)); }

/// Half a line's length, and the larger chord from the middle of an arc to its end.
double TurnedPiece::radius() const {
    return 0.5 * lengthAlong() +
           std::max(low.radius, high.radius) * std::sqrt(2.0 * std::max(0.0, 1.0 - sector.cosine));
}

double TurnedPiece::lengthAround() const { return 2.0 * std::max(low.radius, high.radius) * sector.half_angle; }

double TurnedPiece::lengthAlong() const { return Vec2(high.radius - low.radius, high.height - low.height).norm(); }

std::array<TurnedPiece, 2> TurnedPiece::halvesAround() const {
    const auto sectors = sector.halves();
    return {TurnedPiece{sectors[0], low, high}, TurnedPiece{sectors[1], low, high}};
}

std::array<TurnedPiece, 2> TurnedPiece::halvesAlong() const {
    const Circle middle = between(low, high);
    return {TurnedPiece{sector, low, middle}, TurnedPiece{sector, middle, high}};
}

AxialView::AxialView(const Pose& X)
    : R_(X.q.toRotationMatrix()),
      p_(X.p),
      a_(R_.col(0).head<2>()),
      b_(R_.col(1).head<2>()),
      difference_(0.5 * (a_.squaredNorm() - b_.squaredNorm()), a_.dot(b_)),
      mean_(0.5 * (a_.squaredNorm() + b_.squaredNorm())) {}

/// For r - z the root is bounded by its tangent at s², from above; from below it is short of this by at most
/// (r² - s²)² / (2 s (r + s)²).
AxialView::OfCircle AxialView::see(const Circle& circle, const Sector& sector, const Sector& doubled) const {
    const Vec3 centre = p_ + circle.height * R_.col(2);
    const double q = circle.radius;
    const Vec2 e = centre.head<2>(), upwards = q * Vec2(R_(2, 0), R_(2, 1));
    const Vec2 once = 2.0 * q * Vec2(e.dot(a_), e.dot(b_)), twice = q * q * difference_;
    const double squared = e.squaredNorm() + q * q * mean_, most_twice = doubled.most(twice),
                 least_twice = doubled.least(twice);
    OfCircle seen{e, std::max(0.0, squared + sector.least(once) + least_twice), 0.0, {}};
    seen.most_squared = squared + sector.most(once) + most_twice;
    AxialExtent& extent = seen.extent;
    extent.least_radius = std::sqrt(seen.least_squared);
    extent.most_radius = std::sqrt(std::max(0.0, seen.most_squared));
    extent.least_height = centre.z() + sector.least(upwards);
    extent.most_height = centre.z() + sector.most(upwards);
    extent.least_slope = extent.least_radius - extent.most_height;
    extent.most_slope = extent.most_radius - extent.least_height;
    const double s = std::sqrt(squared);
    if (!(s > 0.0)) return seen;
    const Vec2 sloping = once / (2.0 * s) - upwards;
    const double off = std::max(seen.most_squared - squared, squared - seen.least_squared);
    const double sum = extent.least_radius + s;
    extent.most_slope = std::min(extent.most_slope, s - centre.z() + sector.most(sloping) + most_twice / (2.0 * s));
    extent.least_slope = std::max(extent.least_slope, s - centre.z() + sector.least(sloping) + least_twice / (2.0 * s) -
                                                          off * off / (2.0 * s * sum * sum));
    return seen;
}

AxialExtent AxialView::extentOf(const TurnedPiece& piece) const {
    const Sector doubled = piece.sector.doubled();
    const OfCircle low = see(piece.low, piece.sector, doubled), high = see(piece.high, piece.sector, doubled);
    const double across = (high.centre - low.centre).norm() + std::abs(piece.high.radius - piece.low.radius);
    const double a = low.least_squared, b = high.least_squared, length = across * across;
    // The least of (1 - t) a + t b - t (1 - t) length.
    const double least =
        std::abs(a - b) >= length ? std::min(a, b) : 0.5 * (a + b) - 0.25 * length - (a - b) * (a - b) / (4.0 * length);
    AxialExtent extent;
    extent.least_radius = std::sqrt(std::max(0.0, least));
    extent.most_radius = std::max(low.extent.most_radius, high.extent.most_radius);
    extent.least_height = std::min(low.extent.least_height, high.extent.least_height);
    extent.most_height = std::max(low.extent.most_height, high.extent.most_height);
    extent.most_slope = std::max(low.extent.most_slope, high.extent.most_slope);
    // r is short of its chord by at most this; where it is the line's own length the heights alone are better.
    const double sag = std::min(0.5 * across, 0.125 * length / std::max(extent.least_radius, 1e-300));
    extent.least_slope = std::max(extent.least_radius - extent.most_height,
                                  std::min(low.extent.least_slope, high.extent.least_slope) - sag);
    return extent;
}

SurfacePieces SurfacePieces::of(const shape::Shape& shape) {
    Builder builder;
    std::visit([&](const auto& s) { add(s, builder); }, shape);
    return builder.pieces;
}

}  // namespace passung::truth
