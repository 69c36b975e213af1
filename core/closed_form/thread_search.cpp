#include "core/closed_form/thread_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/closed_form/touch_minimum.h"

namespace passung::closed_form {

namespace {

constexpr double kPiece = 2.0 * std::numbers::pi / ThreadSamples::kMost;  // of a spiral and a circle [rad]
constexpr int kFewestPieces = 4;
constexpr int kStraightPieces = 12;
constexpr std::size_t kFan = 4;   // pieces from one fixed point to the next
constexpr double kAcross = 0.15;  // of a pitch: a piece of a line across a thread's ridges
constexpr int kMostAcross = 64;   // such pieces
constexpr double kLevel = 1e-9;   // second derivative by t [m]
constexpr double kSamePitch = 1e-12;
constexpr double kLeastRadius = 1e-12;  // [m]

/// A lump's function along a line.
class SpiralWalk {
public:
    static constexpr double kEnough = 1e-7;  // [rad]: of the gap less than a picometre, where two faces cross 1e-10 m
    using Point = ThreadPoint;

    SpiralWalk(const Curve& line, const LinePiece& piece, const Lump& lump) noexcept : line_(line), lump_(lump) {
        std::array<double, kMostFaces> values{};
        const std::size_t all = std::min(lump.faces.size(), kMostFaces);
        for (std::size_t i = 0; i < all; ++i) {
            const bool is_flank = lump.faces[i].kind == Face::Kind::Helicoid;
            values[i] = is_flank ? std::numeric_limits<double>::infinity() : valueOf(lump.faces[i], piece.middle);
            if (is_flank)
                flank_ = &lump.faces[i];
            else
                least_ = std::max(least_, values[i] - piece.extent);
        }
        for (std::size_t i = 0; i < all; ++i)
            if (values[i] + piece.extent >= least_ && &lump.faces[i] != flank_) faces_[count_++] = &lump.faces[i];
    }

    const Curve& line() const noexcept { return line_; }
    const Lump& lump() const noexcept { return lump_; }
    const Face* flank() const noexcept { return flank_; }
    /// The function is nowhere on the line below this.
    double least() const noexcept { return least_; }

    Point at(double t) const noexcept { return threadPoint(line_, t); }
    double value(const Face& face, const Point& at) const noexcept {
        switch (face.kind) {
            case Face::Kind::Plane:
                return face.axis.dot(at.p - face.origin);
            case Face::Kind::Helicoid:
                return face.out * (at.r - face.radius) + std::abs(face.along) * fromFlank(face, at.p.z(), at.phi);
            case Face::Kind::Cylinder:
                if (face.about_z) return (face.hollow ? -1.0 : 1.0) * (at.r - face.radius);
                break;
            case Face::Kind::Cone:
                if (face.about_z)
                    return (face.hollow ? -1.0 : 1.0) *
                           (face.out * (at.r - face.radius) + face.along * (at.p.z() - face.origin.z()));
                break;
            default:
                break;
        }
        return valueOf(face, at.p);
    }
    double slope(const Face& face, const Point& at) const noexcept {
        switch (face.kind) {
            case Face::Kind::Plane:
                return face.axis.dot(at.by_t);
            case Face::Kind::Helicoid:
                return face.out * at.r_by_t + face.along * acrossRidges(face, at);
            case Face::Kind::Cylinder:
                if (face.about_z) return (face.hollow ? -1.0 : 1.0) * at.r_by_t;
                break;
            case Face::Kind::Cone:
                if (face.about_z) return (face.hollow ? -1.0 : 1.0) * (face.out * at.r_by_t + face.along * at.by_t.z());
                break;
            default:
                break;
        }
        return gradientOf(face, at.p).dot(at.by_t);
    }
    /// How the line goes along the axis, as ridges see it, by t [m].
    static double acrossRidges(const Face& flank, const Point& at) noexcept {
        return at.by_t.z() - flank.pitch / (2.0 * std::numbers::pi) * at.phi_by_t;
    }

    const Face* highest(const Point& at, double& value) const noexcept {
        const Face* highest = besideFlank(at, value);
        if (flank_ == nullptr) return highest;
        const double of_flank = this->value(*flank_, at);
        if (of_flank <= value && highest != nullptr) return highest;
        value = of_flank;
        return flank_;
    }
    /// Without the flank; none if there is no other.
    const Face* besideFlank(const Point& at, double& value) const noexcept {
        const Face* highest = nullptr;
        value = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < count_; ++i) {
            const double other = this->value(*faces_[i], at);
            if (other <= value) continue;
            value = other;
            highest = faces_[i];
        }
        return highest;
    }

private:
    const Curve& line_;
    const Lump& lump_;
    std::array<const Face*, kMostFaces> faces_{};
    const Face* flank_ = nullptr;
    std::size_t count_ = 0;
    double least_ = -std::numeric_limits<double>::infinity();
};

/// A bound of the function along a helix of the ridges' own pitch, which a helix about the axis keeps all along: less
/// how far the line lies from such a one. -infinity of other lines.
double boundOfHelix(const Curve& line, const LinePiece& piece, const Lump& lump) noexcept {
    double least = -std::numeric_limits<double>::infinity();
    if (line.kind != Curve::Kind::Spiral || line.widening != 0.0 || !(line.e3.z() > 0.5)) return least;
    const double half = 0.5 * (piece.end - piece.begin),
                 turned = std::atan2(line.e1.y() - line.e2.x(), line.e1.x() + line.e2.y());
    const double off = std::sqrt(piece.middle.x() * piece.middle.x() + piece.middle.y() * piece.middle.y()) +
                       (line.e3 - Vec3::UnitZ()).norm() * (line.radius + half * std::abs(line.climb));
    for (const Face& face : lump.faces) {
        if (face.kind == Face::Kind::Cylinder && face.about_z)
            least = std::max(least, (face.hollow ? -1.0 : 1.0) * (line.radius - face.radius));
        if (face.kind != Face::Kind::Helicoid) continue;
        if (std::abs(line.climb * 2.0 * std::numbers::pi - face.pitch) > kSamePitch * face.pitch) continue;
        const double z = piece.middle.z(), phi = 0.5 * (piece.begin + piece.end) + turned;
        least = std::max(
            least, std::min(face.out * (line.radius - face.radius) + std::abs(face.along) * fromFlank(face, z, phi),
                            beforeNextRidge(face, z, phi)));
    }
    return least - off;
}

using SpiralSample = SampleOn<SpiralWalk>;

class ThreadSearch {
public:
    ThreadSearch(const SpiralWalk& walk, double reach, Touches& touches) noexcept
        : walk_(walk), reach_(reach), touches_(touches) {}

    double search(const LinePiece& piece, const ThreadSamples& samples) noexcept {
        const double speed = piece.speed;
        double least = std::numeric_limits<double>::infinity();
        SpiralSample low = sampled(samples[0]);
        double bound = boundAt(low);
        for (std::size_t i = 0; i < samples.pieces(); ++i) {
            if (i % kFan == 0) addFixed(walk_, low, reach_, touches_);
            SpiralSample high = sampled(samples[i + 1]);
            const double farthest = speed * (high.at.t - low.at.t);
            const double bound_high = boundAt(high), between = 0.5 * (bound + bound_high - farthest);
            least = std::min(least, between);
            if (between <= reach_) look(low, high);
            low = high;
            bound = bound_high;
        }
        const Curve& line = walk_.line();
        const bool ends = line.kind == Curve::Kind::Spiral ? piece.end >= line.end : !line.isClosed();
        if (ends) addFixed(walk_, low, reach_, touches_);
        return least;
    }

private:
    SpiralSample sampled(const ThreadPoint& point) const noexcept {
        SpiralSample sample;
        sample.at = point;
        sample.face = walk_.highest(point, sample.value);
        sample.slope = walk_.slope(*sample.face, point);
        return sample;
    }

    /// Of the function there, and of what it is when the next turn's flank begins to count: no sample changes faster.
    double boundAt(const SpiralSample& sample) const noexcept {
        if (sample.face != walk_.flank()) return sample.value;
        return std::min(sample.value, beforeNextRidge(*sample.face, sample.at.p.z(), sample.at.phi));
    }

    /// In pieces in which the line does not go far across ridges.
    void look(const SpiralSample& low, const SpiralSample& high) noexcept {
        const Face* flank = walk_.flank();
        if (flank == nullptr) return bracket(low, high);
        const double begin = low.at.t, span = high.at.t - begin;
        const double across = span / flank->pitch *
                              std::max(std::abs(SpiralWalk::acrossRidges(*flank, low.at)),
                                       std::abs(SpiralWalk::acrossRidges(*flank, high.at)));
        const int pieces = std::clamp(static_cast<int>(std::ceil(std::min(across / kAcross, 1e3))), 1, kMostAcross);
        if (pieces == 1) return lookAtTurns(low, high);
        SpiralSample from = low;
        for (int i = 1; i <= pieces; ++i) {
            const SpiralSample to = i < pieces ? sampleAt(walk_, begin + span * i / pieces) : high;
            lookAtTurns(from, to);
            from = to;
        }
    }

    /// Where the line passes the middle of a ridge, only what lies on its side of the flank counts.
    void lookAtTurns(const SpiralSample& low, const SpiralSample& high) noexcept {
        const Face& flank = *walk_.flank();
        const double side = flank.along > 0.0 ? 1.0 : -1.0;
        const auto outwards = [&](const ThreadPoint& at) { return side * fromRidge(flank, at.p.z(), at.phi); };
        const double at_low = outwards(low.at), at_high = outwards(high.at);
        const bool passes = (at_low > 0.0) != (at_high > 0.0) && std::abs(at_low - at_high) < 0.5 * flank.pitch;
        if (!passes) return bracket(low, high);
        SpiralSample middle;
        middle.at = walk_.at(
            zeroBetween(low.at.t, high.at.t, at_low, at_high, [&](double t) { return outwards(walk_.at(t)); }));
        middle.face = walk_.besideFlank(middle.at, middle.value);
        if (middle.face == nullptr) return;
        middle.slope = walk_.slope(*middle.face, middle.at);
        at_low > 0.0 ? bracket(low, middle) : bracket(middle, high);
    }

    void bracket(const SpiralSample& low, const SpiralSample& high) noexcept {
        if (!(low.slope < 0.0 && high.slope >= 0.0)) return;
        // Parallel, but for less than what a fixed point tells as well.
        if (low.face == high.face && high.slope - low.slope < kLevel * (high.at.t - low.at.t)) return;
        const Touch touch = minimumBetween(walk_, low, high);
        if (touch.gap <= reach_) touches_.add(touch);
    }

    const SpiralWalk& walk_;
    double reach_;
    Touches& touches_;
};

}  // namespace

namespace {

/// Cosines and sines at the pieces of a turn.
struct TurnSamples {
    std::array<double, ThreadSamples::kMost> cosine{}, sine{};

    TurnSamples() noexcept {
        for (std::size_t i = 0; i < cosine.size(); ++i) {
            cosine[i] = std::cos(kPiece * static_cast<double>(i));
            sine[i] = std::sin(kPiece * static_cast<double>(i));
        }
    }
};
const TurnSamples kTurnSamples;

/// Point and slope of a spiral, `out` and `around` being its directions there.
void placeOn(const Curve& spiral, double t, const Vec3& out, const Vec3& around, ThreadPoint& at) noexcept {
    const double radius = spiral.radius + spiral.widening * t;
    at.t = t;
    at.p = spiral.centre + radius * out + spiral.climb * t * spiral.e3;
    at.by_t = spiral.widening * out + radius * around + spiral.climb * spiral.e3;
}

/// The rest, of point and slope; the angle being known.
void seeAboutAxis(double phi, ThreadPoint& at) noexcept {
    const double x = at.p.x(), y = at.p.y(), u = at.by_t.x(), v = at.by_t.y();
    at.r = std::sqrt(x * x + y * y);
    at.phi = phi;
    const double r = std::max(at.r, kLeastRadius);
    at.r_by_t = (x * u + y * v) / r;
    at.phi_by_t = (x * v - y * u) / (r * r);
}

/// atan(q) of a small q, as exact as the numbers are.
double smallAngle(double q) noexcept {
    const double q2 = q * q;
    return q * (1.0 + q2 * (-1.0 / 3.0 + q2 * (1.0 / 5.0 + q2 * (-1.0 / 7.0 + q2 * (1.0 / 9.0)))));
}
constexpr double kSmallAngle = 0.03;  // then what smallAngle() leaves out is below 2e-18

}  // namespace

ThreadPoint threadPoint(const Curve& line, double t) noexcept {
    ThreadPoint at;
    if (line.kind == Curve::Kind::Spiral) {
        const double c = std::cos(t), s = std::sin(t);
        placeOn(line, t, c * line.e1 + s * line.e2, c * line.e2 - s * line.e1, at);
    } else {
        const Place place = placeOn(line, t);
        at.t = t;
        at.cosine = place.cosine;
        at.sine = place.sine;
        at.p = pointOf(line, place);
        at.by_t = slopeOf(line, place);
    }
    seeAboutAxis(std::atan2(at.p.y(), at.p.x()), at);
    return at;
}

/// Where the spiral lies nearly about the axis, angles are those of its own t and a little more.
void ThreadSamples::takeTurn(const Curve& spiral, const LinePiece& piece) noexcept {
    const double c = std::cos(piece.begin), s = std::sin(piece.begin);
    const Vec3 e1 = c * spiral.e1 + s * spiral.e2, e2 = c * spiral.e2 - s * spiral.e1;
    const double level = std::sqrt(e1.x() * e1.x() + e1.y() * e1.y()), begin = std::atan2(e1.y(), e1.x());
    const bool upright = spiral.e3.z() > 0.5;
    for (std::size_t i = 0; i < pieces_; ++i) {
        const double turned = kPiece * static_cast<double>(i), ct = kTurnSamples.cosine[i], st = kTurnSamples.sine[i];
        ThreadPoint& at = points_[i];
        placeOn(spiral, piece.begin + turned, ct * e1 + st * e2, ct * e2 - st * e1, at);
        const double x = (ct * e1.x() - st * e1.y()) / level, y = (st * e1.x() + ct * e1.y()) / level;
        const double along = at.p.x() * x + at.p.y() * y, aside = at.p.y() * x - at.p.x() * y;
        const bool near = upright && std::abs(aside) < kSmallAngle * along;
        seeAboutAxis(near ? begin + turned + smallAngle(aside / along) : std::atan2(at.p.y(), at.p.x()), at);
    }
}

void ThreadSamples::take(const Curve& line, const LinePiece& piece) noexcept {
    const double span = piece.end - piece.begin;
    const int pieces = line.kind == Curve::Kind::Straight
                           ? kStraightPieces
                           : std::max(kFewestPieces, static_cast<int>(std::ceil(span / kPiece - 1e-9)));
    pieces_ = std::min<std::size_t>(static_cast<std::size_t>(pieces), kMost);
    if (line.kind == Curve::Kind::Spiral && pieces > kFewestPieces)
        takeTurn(line, piece);
    else
        for (std::size_t i = 0; i < pieces_; ++i)
            points_[i] = threadPoint(line, piece.begin + span * static_cast<double>(i) / static_cast<double>(pieces_));
    points_[pieces_] = threadPoint(line, piece.end);
}

double searchAlongThread(const Curve& edge, const LinePiece& piece, const ThreadSamples& samples, const Lump& lump,
                         double reach, Touches& touches) noexcept {
    const double bound = boundOfHelix(edge, piece, lump);
    if (bound > reach) return bound;
    const SpiralWalk walk(edge, piece, lump);
    if (walk.least() > reach) return walk.least();
    return ThreadSearch(walk, reach, touches).search(piece, samples);
}

bool hasFlank(const Lump& lump) noexcept {
    return std::any_of(lump.faces.begin(), lump.faces.end(),
                       [](const Face& face) { return face.kind == Face::Kind::Helicoid; });
}

}  // namespace passung::closed_form
