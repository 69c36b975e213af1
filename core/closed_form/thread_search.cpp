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
constexpr std::size_t kFan = 6;         // pieces from one fixed point to the next
constexpr double kAcross = 0.15;        // of a pitch: a piece of a line across a thread's ridges
constexpr int kMostAcross = 64;         // such pieces
constexpr double kLevel = 1e-9;         // second derivative by t [m]
constexpr double kLeastRadius = 1e-12;  // [m]

/// A lump's function along a line.
class Walk {
public:
    using Point = ThreadPoint;

    Walk(const Curve& line, const LinePiece& piece, const Lump& lump) noexcept : line_(line), lump_(lump) {
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

using Sample = SampleOn<Walk>;

class ThreadSearch {
public:
    ThreadSearch(const Walk& walk, double reach, Touches& touches) noexcept
        : walk_(walk), reach_(reach), touches_(touches) {}

    double search(const LinePiece& piece, const ThreadSamples& samples) noexcept {
        const double farthest = piece.speed * (piece.end - piece.begin) / static_cast<double>(samples.pieces());
        double least = std::numeric_limits<double>::infinity();
        Sample low = sampled(samples[0]);
        double bound = boundAt(low);
        for (std::size_t i = 0; i < samples.pieces(); ++i) {
            if (i % kFan == 0) addFixed(walk_, low, reach_, touches_);
            Sample high = sampled(samples[i + 1]);
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
    Sample sampled(const ThreadPoint& point) const noexcept {
        Sample sample;
        sample.at = point;
        sample.face = walk_.highest(point, sample.value);
        sample.slope = walk_.slope(*sample.face, point);
        return sample;
    }

    /// Of the function there, and of what it is when the next turn's flank begins to count: no sample changes faster.
    double boundAt(const Sample& sample) const noexcept {
        if (sample.face != walk_.flank()) return sample.value;
        return std::min(sample.value, beforeNextRidge(*sample.face, sample.at.p.z(), sample.at.phi));
    }

    /// In pieces in which the line does not go far across ridges.
    void look(const Sample& low, const Sample& high) noexcept {
        const Face* flank = walk_.flank();
        if (flank == nullptr) return bracket(low, high);
        const double begin = low.at.t, span = high.at.t - begin;
        const double across =
            span / flank->pitch *
            std::max(std::abs(Walk::acrossRidges(*flank, low.at)), std::abs(Walk::acrossRidges(*flank, high.at)));
        const int pieces = std::clamp(static_cast<int>(std::ceil(std::min(across / kAcross, 1e3))), 1, kMostAcross);
        if (pieces == 1) return lookAtTurns(low, high);
        Sample from = low;
        for (int i = 1; i <= pieces; ++i) {
            const Sample to = i < pieces ? sampleAt(walk_, begin + span * i / pieces) : high;
            lookAtTurns(from, to);
            from = to;
        }
    }

    /// Where the line passes the middle of a ridge, only what lies on its side of the flank counts.
    void lookAtTurns(const Sample& low, const Sample& high) noexcept {
        const Face& flank = *walk_.flank();
        const double side = flank.along > 0.0 ? 1.0 : -1.0;
        const auto outwards = [&](const ThreadPoint& at) { return side * fromRidge(flank, at.p.z(), at.phi); };
        const double at_low = outwards(low.at), at_high = outwards(high.at);
        const bool passes = (at_low > 0.0) != (at_high > 0.0) && std::abs(at_low - at_high) < 0.5 * flank.pitch;
        if (!passes) return bracket(low, high);
        Sample middle;
        middle.at = walk_.at(
            zeroBetween(low.at.t, high.at.t, at_low, at_high, [&](double t) { return outwards(walk_.at(t)); }));
        middle.face = walk_.besideFlank(middle.at, middle.value);
        if (middle.face == nullptr) return;
        middle.slope = walk_.slope(*middle.face, middle.at);
        at_low > 0.0 ? bracket(low, middle) : bracket(middle, high);
    }

    void bracket(const Sample& low, const Sample& high) noexcept {
        if (!(low.slope < 0.0 && high.slope >= 0.0)) return;
        // Parallel, but for less than what a fixed point tells as well.
        if (low.face == high.face && high.slope - low.slope < kLevel * (high.at.t - low.at.t)) return;
        const Touch touch = minimumBetween(walk_, low, high);
        if (touch.gap <= reach_) touches_.add(touch);
    }

    const Walk& walk_;
    double reach_;
    Touches& touches_;
};

}  // namespace

ThreadPoint threadPoint(const Curve& line, double t) noexcept {
    ThreadPoint at;
    at.t = t;
    if (line.kind == Curve::Kind::Spiral) {
        const double c = std::cos(t), s = std::sin(t), radius = line.radius + line.widening * t;
        const Vec3 out = c * line.e1 + s * line.e2, around = c * line.e2 - s * line.e1;
        at.p = line.centre + radius * out + line.climb * t * line.e3;
        at.by_t = line.widening * out + radius * around + line.climb * line.e3;
    } else {
        at.p = pointOf(line, t);
        at.by_t = slopeOf(line, t);
    }
    const double x = at.p.x(), y = at.p.y(), u = at.by_t.x(), v = at.by_t.y();
    at.r = std::sqrt(x * x + y * y);
    at.phi = std::atan2(y, x);
    const double r = std::max(at.r, kLeastRadius);
    at.r_by_t = (x * u + y * v) / r;
    at.phi_by_t = (x * v - y * u) / (r * r);
    return at;
}

void ThreadSamples::take(const Curve& line, const LinePiece& piece) noexcept {
    const double span = piece.end - piece.begin;
    const int pieces = line.kind == Curve::Kind::Straight
                           ? kStraightPieces
                           : std::max(kFewestPieces, static_cast<int>(std::ceil(span / kPiece - 1e-9)));
    pieces_ = std::min<std::size_t>(static_cast<std::size_t>(pieces), kMost);
    for (std::size_t i = 0; i < pieces_; ++i)
        points_[i] = threadPoint(line, piece.begin + span * static_cast<double>(i) / static_cast<double>(pieces_));
    points_[pieces_] = threadPoint(line, piece.end);
}

double searchAlongThread(const Curve& edge, const LinePiece& piece, const ThreadSamples& samples, const Lump& lump,
                         double reach, Touches& touches) noexcept {
    const Walk walk(edge, piece, lump);
    if (walk.least() > reach) return walk.least();
    return ThreadSearch(walk, reach, touches).search(piece, samples);
}

bool hasFlank(const Lump& lump) noexcept {
    return std::any_of(lump.faces.begin(), lump.faces.end(),
                       [](const Face& face) { return face.kind == Face::Kind::Helicoid; });
}

}  // namespace passung::closed_form
