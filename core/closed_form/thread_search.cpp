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
                return face.out * at.r_by_t +
                       face.along * (at.by_t.z() - face.pitch / (2.0 * std::numbers::pi) * at.phi_by_t);
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

/// How faces about the z axis bend along a line: bounds of second derivatives by t, at places that are no nearer to the
/// axis than r. With q across the axis, r'' = (|q'|² + q · q'' - r'²) / r and φ'' = (q × q'') / r² - 2 r' φ' / r.
struct ThreadBend {
    ThreadBend(const Curve& line, const LinePiece& piece) noexcept : speed(piece.speed) {
        if (line.kind == Curve::Kind::Straight) return;
        bend = piece.speed + 2.0 * std::abs(line.widening);
        const bool spiral = line.kind == Curve::Kind::Spiral;
        bend_z = spiral ? bend * std::hypot(line.e3.x(), line.e3.y()) : std::hypot(line.e1.z(), line.e2.z());
    }

    /// Of what is away along the axis from a flank's middle line.
    double away(const Face& flank, double r) const noexcept {
        const double turn = bend / r + 2.0 * speed * speed / (r * r);
        return bend_z + flank.pitch / (2.0 * std::numbers::pi) * turn;
    }
    /// Upwards, of the part of a flank's function that the radius makes.
    double ofRadius(const Face& flank, double r) const noexcept {
        return std::abs(flank.out) * (flank.out < 0.0 ? bend : bend + speed * speed / r);
    }
    /// Upwards, of a face's function.
    double of(const Face& face, double r) const noexcept {
        const double inwards = bend, outwards = bend + speed * speed / r;
        switch (face.kind) {
            case Face::Kind::Plane:
                return bend;
            case Face::Kind::Cylinder:
                if (face.about_z) return face.hollow ? inwards : outwards;
                break;
            case Face::Kind::Cone:
                if (face.about_z) return face.out * (face.hollow ? inwards : outwards) + std::abs(face.along) * bend_z;
                break;
            case Face::Kind::Helicoid:
                return ofRadius(face, r) + std::abs(face.along) * away(face, r);
            default:
                break;
        }
        return std::numeric_limits<double>::infinity();
    }

    double speed = 0.0, bend = 0.0, bend_z = 0.0;  // |P'|, |P''| and its part along the axis are no more [m]
};

class ThreadSearch {
public:
    ThreadSearch(const SpiralWalk& walk, const LinePiece& piece, double reach, Touches& touches) noexcept
        : walk_(walk), bend_(walk.line(), piece), reach_(reach), touches_(touches) {}

    double search(const LinePiece& piece, const ThreadSamples& samples) noexcept {
        ThreadHeights heights;
        heights.take(samples, walk_.others(), walk_.flank(), reach_);
        const Seen seen{samples, heights};
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < samples.pieces(); ++i) {
            if (i % kFan == 0) addFixedAt(seen, i);
            const double farthest = piece.speed * (samples.t[i + 1] - samples.t[i]);
            double between = 0.5 * (heights.bound[i] + heights.bound[i + 1] - farthest);
            if (reach_ < 0.0 && heights.face[i] == heights.face[i + 1])
                between = std::max(between, lastingBound(seen, i, faceAt(seen, i)));
            if (reach_ < 0.0 && walk_.flank() != nullptr) between = std::max(between, floorBound(seen, i));
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
        return {seen.heights.value[i], seen.heights.slope[i], &faceAt(seen, i), seen.samples[i]};
    }
    void addFixedAt(const Seen& seen, std::size_t i) noexcept {
        if (!(seen.heights.value[i] > reach_)) addFixed(walk_, sampled(seen, i), reach_, touches_);
    }

    /// In pieces in which the line does not go far across ridges.
    void look(const Seen& seen, std::size_t i) noexcept {
        const ThreadHeights& heights = seen.heights;
        const Face* flank = walk_.flank();
        const bool brackets = heights.slope[i] < 0.0 && heights.slope[i + 1] >= 0.0;
        if (flank == nullptr) {
            if (brackets && !isAbove(seen, i)) bracket(sampled(seen, i), sampled(seen, i + 1));
            return;
        }
        const double begin = seen.samples.t[i], span = seen.samples.t[i + 1] - begin;
        const double across =
            span / flank->pitch * std::max(std::abs(heights.across[i]), std::abs(heights.across[i + 1]));
        const int pieces = std::clamp(static_cast<int>(std::ceil(std::min(across / kAcross, 1e3))), 1, kMostAcross);
        const double at_low = outOfRidge(*flank, heights.away[i]), at_high = outOfRidge(*flank, heights.away[i + 1]);
        if (pieces == 1) {
            if (passesRidge(at_low, at_high) || (brackets && !isAbove(seen, i)))
                lookAtTurns(sampled(seen, i), at_low, sampled(seen, i + 1), at_high);
            return;
        }
        SpiralSample from = sampled(seen, i);
        double at_from = at_low;
        for (int k = 1; k <= pieces; ++k) {
            const SpiralSample to = k < pieces ? sampleAt(walk_, begin + span * k / pieces) : sampled(seen, i + 1);
            const double at_to = k < pieces ? outwardsAt(to.at) : at_high;
            lookAtTurns(from, at_from, to, at_to);
            from = to;
            at_from = at_to;
        }
    }

    /// A bound of one face's function between two samples, of which both values are known: how far it is short of the
    /// chord.
    double chordBound(const Seen& seen, std::size_t i, const Face& face, double low, double high) const noexcept {
        const ThreadSamples& samples = seen.samples;
        const double piece = samples.t[i + 1] - samples.t[i];
        const double r = std::min(samples.r[i], samples.r[i + 1]) - 0.5 * bend_.speed * piece;
        if (!(r > 0.0)) return -std::numeric_limits<double>::infinity();
        if (face.kind == Face::Kind::Helicoid) {
            // No jump between them: the flank of no other turn begins to count.
            const ThreadHeights& heights = seen.heights;
            const double low_away = heights.away[i], high_away = heights.away[i + 1];
            const double bend = bend_.away(face, r) * piece,
                         most = std::max(std::abs(heights.across[i]), std::abs(heights.across[i + 1])) + bend;
            const bool jumps = !(most * piece < 0.5 * face.pitch) ||
                               !(std::abs(low_away - high_away) < 0.5 * face.pitch) ||
                               !(std::max(low_away, high_away) + 0.125 * bend * piece < 0.75 * face.pitch);
            if (jumps) return -std::numeric_limits<double>::infinity();
        }
        return std::min(low, high) - 0.125 * bend_.of(face, r) * piece * piece;
    }
    /// The same of the highest face at both, as ThreadHeights::bound is one: it lasts while the line moves. @pre reach
    /// < 0
    double lastingBound(const Seen& seen, std::size_t i, const Face& face) const noexcept {
        const ThreadHeights& heights = seen.heights;
        const double bound = chordBound(seen, i, face, heights.value[i], heights.value[i + 1]);
        if (face.kind != Face::Kind::Helicoid || !(bound > reach_)) return bound;
        const ThreadSamples& samples = seen.samples;
        const double piece = samples.t[i + 1] - samples.t[i];
        const double r = std::min(samples.r[i], samples.r[i + 1]) - 0.5 * bend_.speed * piece;
        const double away =
            std::max(heights.away[i], heights.away[i + 1]) + 0.125 * bend_.away(face, r) * piece * piece;
        const double known = std::min(std::abs(face.along) * (0.75 * face.pitch - away), r - face.least);
        return std::min(bound, known + reach_);
    }
    /// What the flank's function is nowhere below, it being least amid its ridge.
    double floorBound(const Seen& seen, std::size_t i) const noexcept {
        const Face& flank = *walk_.flank();
        const ThreadSamples& samples = seen.samples;
        const double piece = samples.t[i + 1] - samples.t[i];
        const double r = std::min(samples.r[i], samples.r[i + 1]) - 0.5 * bend_.speed * piece;
        if (!(r > 0.0)) return -std::numeric_limits<double>::infinity();
        const double least =
            std::min(flank.out * (samples.r[i] - flank.radius), flank.out * (samples.r[i + 1] - flank.radius));
        return least - 0.25 * std::abs(flank.along) * flank.pitch - 0.125 * bend_.ofRadius(flank, r) * piece * piece;
    }
    /// The function is above the reach between two samples.
    bool isAbove(const Seen& seen, std::size_t i) const noexcept {
        const double low = seen.heights.value[i], high = seen.heights.value[i + 1];
        const Face &of_low = faceAt(seen, i), &of_high = faceAt(seen, i + 1);
        if (&of_low == &of_high) return chordBound(seen, i, of_low, low, high) > reach_;
        return chordBound(seen, i, of_low, low, walk_.value(of_low, seen.samples[i + 1])) > reach_ ||
               chordBound(seen, i, of_high, walk_.value(of_high, seen.samples[i]), high) > reach_;
    }

    bool passesRidge(double at_low, double at_high) const noexcept {
        return (at_low > 0.0) != (at_high > 0.0) && std::abs(at_low - at_high) < 0.5 * walk_.flank()->pitch;
    }
    double outwardsAt(const ThreadPoint& at) const noexcept {
        return outOfRidge(*walk_.flank(), fromFlank(*walk_.flank(), at.p.z(), at.phi));
    }

    /// Where the line passes the middle of a ridge, only what lies on its side of the flank counts.
    void lookAtTurns(const SpiralSample& low, double at_low, const SpiralSample& high, double at_high) noexcept {
        if (!passesRidge(at_low, at_high)) return bracket(low, high);
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
    ThreadBend bend_;
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
    return ThreadSearch(walk, piece, reach, touches).search(piece, samples);
}

bool hasFlank(const Lump& lump) noexcept {
    return std::any_of(lump.faces.begin(), lump.faces.end(),
                       [](const Face& face) { return face.kind == Face::Kind::Helicoid; });
}

}  // namespace passung::closed_form
