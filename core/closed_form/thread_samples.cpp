#include "core/closed_form/thread_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace passung::closed_form {

namespace {

using Faces = std::span<const Face* const>;

constexpr double kTurnPiece = 2.0 * std::numbers::pi / ThreadSamples::kMost;  // of a spiral and a circle [rad]
constexpr int kFewestPieces = 4;
constexpr int kStraightPieces = 12;
constexpr double kLeastRadius = 1e-12;  // [m]

/// Cosines and sines at the pieces of a turn.
struct TurnDirections {
    alignas(64) ThreadSamples::Row turned{}, cosine{}, sine{};

    TurnDirections() noexcept {
        for (std::size_t i = 0; i < ThreadSamples::kRoom; ++i) {
            turned[i] = kTurnPiece * static_cast<double>(i);
            cosine[i] = std::cos(turned[i]);
            sine[i] = std::sin(turned[i]);
        }
    }
};
const TurnDirections kTurnDirections;

/// What is known of an angle about the axis, being near to another: atan(q) of a small q, as exact as the numbers are.
PASSUNG_INLINE double smallAngle(double q) noexcept {
    const double q2 = q * q;
    return q * (1.0 + q2 * (-1.0 / 3.0 + q2 * (1.0 / 5.0 + q2 * (-1.0 / 7.0 + q2 * (1.0 / 9.0)))));
}
constexpr double kSmallAngle = 0.03;  // then what smallAngle() leaves out is below 2e-18

struct Turn {
    Vec3 e1, e2;                      // at its begin
    double begin = 0.0;               // of t
    double level = 1.0, first = 0.0;  // length of e1 across the axis, its angle about it
    bool upright = false;
};

/// Sums of three in the order of Eigen's.
PASSUNG_INLINE double sum(double a, double b, double c) noexcept { return (a + b) + c; }

/// Where the spiral lies nearly about the axis, angles are those of its own t and a little more. How many do not.
PASSUNG_INLINE std::int64_t takeTurn(const Curve& spiral, const Turn& turn, ThreadSamples& s,
                                     ThreadSamples::Row& far) noexcept {
    const double cx = spiral.centre.x(), cy = spiral.centre.y(), cz = spiral.centre.z();
    const double ax = turn.e1.x(), ay = turn.e1.y(), az = turn.e1.z();
    const double bx = turn.e2.x(), by = turn.e2.y(), bz = turn.e2.z();
    const double ux = spiral.e3.x(), uy = spiral.e3.y(), uz = spiral.e3.z();
    const double widest = spiral.radius, widening = spiral.widening, climb = spiral.climb;
    const double begin = turn.begin, level = turn.level, first = turn.first;
    const bool upright = turn.upright;
    std::int64_t apart = 0;
    for (std::size_t i = 0; i < ThreadSamples::kRoom; ++i) {
        const double turned = kTurnDirections.turned[i], c = kTurnDirections.cosine[i], d = kTurnDirections.sine[i];
        const double t = begin + turned, radius = widest + widening * t, risen = climb * t;
        const double out_x = c * ax + d * bx, out_y = c * ay + d * by, out_z = c * az + d * bz;
        const double on_x = c * bx - d * ax, on_y = c * by - d * ay, on_z = c * bz - d * az;
        const double x = sum(cx, radius * out_x, risen * ux), y = sum(cy, radius * out_y, risen * uy);
        const double u = sum(widening * out_x, radius * on_x, climb * ux);
        const double v = sum(widening * out_y, radius * on_y, climb * uy);
        s.t[i] = t;
        s.x[i] = x;
        s.y[i] = y;
        s.z[i] = sum(cz, radius * out_z, risen * uz);
        s.by_x[i] = u;
        s.by_y[i] = v;
        s.by_z[i] = sum(widening * out_z, radius * on_z, climb * uz);
        const double to_x = (c * ax - d * ay) / level, to_y = (d * ax + c * ay) / level;
        const double along = x * to_x + y * to_y, aside = y * to_x - x * to_y;
        const bool near = upright && std::abs(aside) < kSmallAngle * along;
        far[i] = near ? 0.0 : 1.0;
        apart += near ? 0 : 1;
        const double r = std::sqrt(x * x + y * y), q = std::max(r, kLeastRadius);
        s.r[i] = r;
        s.phi[i] = first + turned + smallAngle(aside / along);
        s.r_by_t[i] = (x * u + y * v) / q;
        s.phi_by_t[i] = (x * v - y * u) / (q * q);
    }
    return apart;
}

template <Face::Kind kKind>
PASSUNG_INLINE void takeFace(const Face& face, std::int64_t number, const ThreadSamples& s, ThreadHeights& h) noexcept {
    const double ox = face.origin.x(), oy = face.origin.y(), oz = face.origin.z();
    const double ax = face.axis.x(), ay = face.axis.y(), az = face.axis.z();
    const double radius = face.radius, along = face.along, out = face.out, sign = face.hollow ? -1.0 : 1.0;
    for (std::size_t i = 0; i < ThreadSamples::kRoom; ++i) {
        double value = 0.0, slope = 0.0;
        if constexpr (kKind == Face::Kind::Plane) {
            value = sum(ax * (s.x[i] - ox), ay * (s.y[i] - oy), az * (s.z[i] - oz));
            slope = sum(ax * s.by_x[i], ay * s.by_y[i], az * s.by_z[i]);
        } else if constexpr (kKind == Face::Kind::Cylinder) {
            value = sign * (s.r[i] - radius);
            slope = sign * s.r_by_t[i];
        } else {
            value = sign * (out * (s.r[i] - radius) + along * (s.z[i] - oz));
            slope = sign * (out * s.r_by_t[i] + along * s.by_z[i]);
        }
        const bool higher = value > h.value[i];
        h.value[i] = higher ? value : h.value[i];
        h.slope[i] = higher ? slope : h.slope[i];
        h.face[i] = higher ? number : h.face[i];
    }
}

/// One place at a time.
void takeOther(const Face& face, std::int64_t number, const ThreadSamples& s, ThreadHeights& h) noexcept {
    for (std::size_t i = 0; i <= s.pieces(); ++i) {
        const Vec3 p(s.x[i], s.y[i], s.z[i]);
        const double value = valueOf(face, p);
        if (!(value > h.value[i])) continue;
        h.value[i] = value;
        h.slope[i] = gradientOf(face, p).dot(Vec3(s.by_x[i], s.by_y[i], s.by_z[i]));
        h.face[i] = number;
    }
}

/// Its function is nowhere below what it is amid its ridge.
PASSUNG_INLINE void takeFlank(const Face& flank, double reach, const ThreadSamples& s, ThreadHeights& h) noexcept {
    const double oz = flank.origin.z(), radius = flank.radius, out = flank.out, steep = std::abs(flank.along);
    const double pitch = flank.pitch, lead = pitch / (2.0 * std::numbers::pi), deep = steep * (0.25 * pitch);
    const double rise = flank.along;
    const bool above = rise > 0.0;
    const double before = std::min(reach, 0.0);
    // Nearer to the axis it is steeper, which matters amid material alone.
    const double least = reach < 0.0 ? flank.least : -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < ThreadSamples::kRoom; ++i) {
        const double up = s.z[i] - oz - lead * s.phi[i];
        const double from = above ? up : -up;
        const double away = from - pitch * std::floor(from / pitch + 0.25);
        const double outwards = out * (s.r[i] - radius), value = outwards + steep * away;
        const double known = std::min(steep * (0.75 * pitch - away), s.r[i] - least) + before, beside = h.value[i];
        const bool higher = !(value <= beside);
        const double low = std::max(std::min(value, known), outwards - deep);
        const double across = s.by_z[i] - lead * s.phi_by_t[i];
        const double slope = out * s.r_by_t[i] + rise * across;
        h.away[i] = away;
        h.across[i] = across;
        h.value[i] = higher ? value : beside;
        h.slope[i] = higher ? slope : h.slope[i];
        h.bound[i] = higher ? std::max(low, beside) : beside;
        h.face[i] = higher ? ThreadHeights::kFlank : h.face[i];
    }
}

PASSUNG_INLINE void takeHeights(const ThreadSamples& s, Faces others, const Face* flank, double reach,
                                ThreadHeights& h) noexcept {
    for (std::size_t i = 0; i < ThreadSamples::kRoom; ++i) {
        h.value[i] = -std::numeric_limits<double>::infinity();
        h.slope[i] = 0.0;
        h.face[i] = ThreadHeights::kFlank;
    }
    for (std::size_t k = 0; k < others.size(); ++k) {
        const Face& face = *others[k];
        const auto number = static_cast<std::int64_t>(k);
        if (face.kind == Face::Kind::Plane)
            takeFace<Face::Kind::Plane>(face, number, s, h);
        else if (face.kind == Face::Kind::Cylinder && face.about_z)
            takeFace<Face::Kind::Cylinder>(face, number, s, h);
        else if (face.kind == Face::Kind::Cone && face.about_z)
            takeFace<Face::Kind::Cone>(face, number, s, h);
        else
            takeOther(face, number, s, h);
    }
    if (flank != nullptr)
        takeFlank(*flank, reach, s, h);
    else
        h.bound = h.value;
}

using TurnFunction = std::int64_t (*)(const Curve&, const Turn&, ThreadSamples&, ThreadSamples::Row&);
using HeightsFunction = void (*)(const ThreadSamples&, Faces, const Face*, double, ThreadHeights&);

std::int64_t turnBaseline(const Curve& spiral, const Turn& turn, ThreadSamples& s, ThreadSamples::Row& far) noexcept {
    return takeTurn(spiral, turn, s, far);
}
PASSUNG_V3 std::int64_t turnV3(const Curve& spiral, const Turn& turn, ThreadSamples& s,
                               ThreadSamples::Row& far) noexcept {
    return takeTurn(spiral, turn, s, far);
}
PASSUNG_V4 std::int64_t turnV4(const Curve& spiral, const Turn& turn, ThreadSamples& s,
                               ThreadSamples::Row& far) noexcept {
    return takeTurn(spiral, turn, s, far);
}
void heightsBaseline(const ThreadSamples& s, Faces others, const Face* flank, double reach, ThreadHeights& h) noexcept {
    takeHeights(s, others, flank, reach, h);
}
PASSUNG_V3 void heightsV3(const ThreadSamples& s, Faces others, const Face* flank, double reach,
                          ThreadHeights& h) noexcept {
    takeHeights(s, others, flank, reach, h);
    PASSUNG_CLEAR_UPPER();
}
PASSUNG_V4 void heightsV4(const ThreadSamples& s, Faces others, const Face* flank, double reach,
                          ThreadHeights& h) noexcept {
    takeHeights(s, others, flank, reach, h);
    PASSUNG_CLEAR_UPPER();
}

using field::Instructions;

TurnFunction turnWith(Instructions instructions) noexcept {
    return instructions == Instructions::V4 ? turnV4 : instructions == Instructions::V3 ? turnV3 : turnBaseline;
}
HeightsFunction heightsWith(Instructions instructions) noexcept {
    return instructions == Instructions::V4   ? heightsV4
           : instructions == Instructions::V3 ? heightsV3
                                              : heightsBaseline;
}

const Instructions kBestInstructions = field::bestInstructions();

}  // namespace

ThreadPoint threadPoint(const Curve& line, double t) noexcept {
    ThreadPoint at;
    at.t = t;
    const LinePlace place = placeAt(line, t);
    at.p = pointOf(line, place);
    at.by_t = slopeOf(line, place);
    if (line.kind == Curve::Kind::Circle) {
        at.cosine = place.cosine;
        at.sine = place.sine;
    }
    const double x = at.p.x(), y = at.p.y(), u = at.by_t.x(), v = at.by_t.y();
    at.r = std::sqrt(x * x + y * y);
    at.phi = std::atan2(y, x);
    const double r = std::max(at.r, kLeastRadius);
    at.r_by_t = (x * u + y * v) / r;
    at.phi_by_t = (x * v - y * u) / (r * r);
    return at;
}

ThreadPoint ThreadSamples::operator[](std::size_t i) const noexcept {
    return {.t = t[i],
            .p = {x[i], y[i], z[i]},
            .by_t = {by_x[i], by_y[i], by_z[i]},
            .r = r[i],
            .phi = phi[i],
            .r_by_t = r_by_t[i],
            .phi_by_t = phi_by_t[i]};
}

void ThreadSamples::set(std::size_t i, const ThreadPoint& at) noexcept {
    t[i] = at.t;
    x[i] = at.p.x();
    y[i] = at.p.y();
    z[i] = at.p.z();
    by_x[i] = at.by_t.x();
    by_y[i] = at.by_t.y();
    by_z[i] = at.by_t.z();
    r[i] = at.r;
    phi[i] = at.phi;
    r_by_t[i] = at.r_by_t;
    phi_by_t[i] = at.phi_by_t;
}

void ThreadSamples::take(const Curve& line, const LinePiece& piece) noexcept { take(line, piece, kBestInstructions); }

void ThreadSamples::take(const Curve& line, const LinePiece& piece, field::Instructions instructions) noexcept {
    const double span = piece.end - piece.begin;
    const int pieces = line.kind == Curve::Kind::Straight
                           ? kStraightPieces
                           : std::max(kFewestPieces, static_cast<int>(std::ceil(span / kTurnPiece - 1e-9)));
    pieces_ = std::min<std::size_t>(static_cast<std::size_t>(pieces), kMost);
    if (line.kind == Curve::Kind::Spiral && pieces > kFewestPieces) {
        const double c = std::cos(piece.begin), s = std::sin(piece.begin);
        Turn turn;
        turn.e1 = c * line.e1 + s * line.e2;
        turn.e2 = c * line.e2 - s * line.e1;
        turn.begin = piece.begin;
        turn.level = std::sqrt(turn.e1.x() * turn.e1.x() + turn.e1.y() * turn.e1.y());
        turn.first = std::atan2(turn.e1.y(), turn.e1.x());
        turn.upright = line.e3.z() > 0.5;
        alignas(64) ThreadSamples::Row far;
        if (turnWith(instructions)(line, turn, *this, far) > 0)
            for (std::size_t i = 0; i < pieces_; ++i)
                if (far[i] > 0.0) phi[i] = std::atan2(y[i], x[i]);
    } else {
        for (std::size_t i = 0; i < pieces_; ++i)
            set(i, threadPoint(line, piece.begin + span * static_cast<double>(i) / static_cast<double>(pieces_)));
    }
    set(pieces_, threadPoint(line, piece.end));
}

void ThreadHeights::take(const ThreadSamples& samples, std::span<const Face* const> others, const Face* flank,
                         double reach) noexcept {
    take(samples, others, flank, reach, kBestInstructions);
}

void ThreadHeights::take(const ThreadSamples& samples, std::span<const Face* const> others, const Face* flank,
                         double reach, field::Instructions instructions) noexcept {
    heightsWith(instructions)(samples, others, flank, reach, *this);
}

}  // namespace passung::closed_form
