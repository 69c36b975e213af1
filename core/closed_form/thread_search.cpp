#include "core/closed_form/thread_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "core/closed_form/touch_minimum.h"

namespace passung::closed_form {

namespace {

constexpr std::size_t kFan = 4;   // pieces from one fixed point to the next
constexpr double kAcross = 0.15;  // of a pitch: a piece of a line across a thread's ridges
constexpr int kMostAcross = 64;   // such pieces
constexpr double kLevel = 1e-9;   // second derivative by t [m]
constexpr double kSamePitch = 1e-12;

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
    std::span<const Face* const> others() const noexcept { return {faces_.data(), count_}; }
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
double boundOfHelix(const Curve& line, const LinePiece& piece, const Lump& lump, double reach) noexcept {
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
        const double least_radius = reach < 0.0 ? face.least : -std::numeric_limits<double>::infinity();
        const double known = std::min(beforeNextRidge(face, z, phi), line.radius - least_radius);
        least = std::max(
            least, std::min(face.out * (line.radius - face.radius) + std::abs(face.along) * fromFlank(face, z, phi),
                            known + std::min(reach, 0.0)));
    }
    return least - off;
}

using SpiralSample = SampleOn<SpiralWalk>;

class ThreadSearch {
public:
    ThreadSearch(const SpiralWalk& walk, double reach, Touches& touches) noexcept
        : walk_(walk), reach_(reach), touches_(touches) {}

    double search(const LinePiece& piece, const ThreadSamples& samples) noexcept {
        ThreadHeights heights;
        heights.take(samples, walk_.others(), walk_.flank(), reach_);
        const Seen seen{samples, heights};
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < samples.pieces(); ++i) {
            if (i % kFan == 0) addFixedAt(seen, i);
            const double farthest = piece.speed * (samples.t[i + 1] - samples.t[i]);
            const double between = 0.5 * (heights.bound[i] + heights.bound[i + 1] - farthest);
            least = std::min(least, between);
            if (between <= reach_) look(seen, i);
        }
        const Curve& line = walk_.line();
        const bool ends = line.kind == Curve::Kind::Spiral ? piece.end >= line.end : !line.isClosed();
        if (ends) addFixedAt(seen, samples.pieces());
        return least;
    }

private:
    struct Seen {
        const ThreadSamples& samples;
        const ThreadHeights& heights;
    };

    const Face& faceAt(const Seen& seen, std::size_t i) const noexcept {
        const std::int64_t face = seen.heights.face[i];
        return face == ThreadHeights::kFlank ? *walk_.flank() : *walk_.others()[static_cast<std::size_t>(face)];
    }
    SpiralSample sampled(const Seen& seen, std::size_t i) const noexcept {
        SpiralSample sample;
        sample.at = seen.samples[i];
        sample.value = seen.heights.value[i];
        sample.face = &faceAt(seen, i);
        sample.slope = walk_.slope(*sample.face, sample.at);
        return sample;
    }
    void addFixedAt(const Seen& seen, std::size_t i) noexcept {
        if (!(seen.heights.value[i] > reach_)) addFixed(walk_, sampled(seen, i), reach_, touches_);
    }

    /// In pieces in which the line does not go far across ridges.
    void look(const Seen& seen, std::size_t i) noexcept {
        const SpiralSample low = sampled(seen, i), high = sampled(seen, i + 1);
        const Face* flank = walk_.flank();
        if (flank == nullptr) return bracket(low, high);
        const double begin = low.at.t, span = high.at.t - begin;
        const double across = span / flank->pitch *
                              std::max(std::abs(SpiralWalk::acrossRidges(*flank, low.at)),
                                       std::abs(SpiralWalk::acrossRidges(*flank, high.at)));
        const int pieces = std::clamp(static_cast<int>(std::ceil(std::min(across / kAcross, 1e3))), 1, kMostAcross);
        const double at_low = outOfRidge(*flank, seen.heights.away[i]);
        const double at_high = outOfRidge(*flank, seen.heights.away[i + 1]);
        if (pieces == 1) return lookAtTurns(low, at_low, high, at_high);
        SpiralSample from = low;
        double at_from = at_low;
        for (int k = 1; k <= pieces; ++k) {
            const SpiralSample to = k < pieces ? sampleAt(walk_, begin + span * k / pieces) : high;
            const double at_to = k < pieces ? outwardsAt(to.at) : at_high;
            lookAtTurns(from, at_from, to, at_to);
            from = to;
            at_from = at_to;
        }
    }

    double outwardsAt(const ThreadPoint& at) const noexcept {
        return outOfRidge(*walk_.flank(), fromFlank(*walk_.flank(), at.p.z(), at.phi));
    }

    /// Where the line passes the middle of a ridge, only what lies on its side of the flank counts.
    void lookAtTurns(const SpiralSample& low, double at_low, const SpiralSample& high, double at_high) noexcept {
        const bool passes =
            (at_low > 0.0) != (at_high > 0.0) && std::abs(at_low - at_high) < 0.5 * walk_.flank()->pitch;
        if (!passes) return bracket(low, high);
        SpiralSample middle;
        middle.at = walk_.at(
            zeroBetween(low.at.t, high.at.t, at_low, at_high, [&](double t) { return outwardsAt(walk_.at(t)); }));
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

double searchAlongThread(const Curve& edge, const LinePiece& piece, const ThreadSamples& samples, const Lump& lump,
                         double reach, Touches& touches) noexcept {
    const double bound = boundOfHelix(edge, piece, lump, reach);
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
