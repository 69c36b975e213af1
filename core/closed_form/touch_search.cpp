#include "core/closed_form/touch_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/closed_form/touch_minimum.h"

namespace passung::closed_form {

namespace {

constexpr int kCircleSamples = 24;
constexpr int kStraightSamples = 12;  // pieces
constexpr int kRingSamples = 96;      // of a circle against a face that is not simple on it: minima may lie close
constexpr double kOnFace = 1e-9;      // [m]

/// Cosines and sines at the samples of a circle.
struct CircleSamples {
    std::array<double, kCircleSamples + 1> cosine{}, sine{};

    CircleSamples() noexcept {
        for (std::size_t i = 0; i < cosine.size(); ++i) {
            const double t = std::numbers::pi * (2.0 * static_cast<double>(i) / kCircleSamples - 1.0);
            cosine[i] = std::cos(t);
            sine[i] = std::sin(t);
        }
    }
};
const CircleSamples kCircle;

/// The i-th sample of a line.
Vec3 samplePoint(const Curve& line, int i, double t) noexcept {
    if (!line.isClosed()) return pointOf(line, t);
    const auto at = static_cast<std::size_t>(i);
    return line.centre + kCircle.cosine[at] * line.e1 + kCircle.sine[at] * line.e2;
}

Vec3 sampleSlope(const Curve& line, int i, double t) noexcept {
    if (!line.isClosed()) return slopeOf(line, t);
    const auto at = static_cast<std::size_t>(i);
    return kCircle.cosine[at] * line.e2 - kCircle.sine[at] * line.e1;
}

/// The faces of a lump that can be the largest somewhere along a line.
class Highest {
public:
    Highest(const Curve& line, const Lump& lump) noexcept {
        const double extent = line.extent();
        least_ = -std::numeric_limits<double>::infinity();
        std::array<double, kMostFaces> values{};
        const std::size_t all = std::min(lump.faces.size(), kMostFaces);
        for (std::size_t i = 0; i < all; ++i) {
            values[i] = valueOf(lump.faces[i], line.centre);
            least_ = std::max(least_, values[i] - extent);
        }
        for (std::size_t i = 0; i < all; ++i)
            if (values[i] + extent >= least_) faces_[count_++] = &lump.faces[i];
    }

    /// The function is nowhere on the line below this.
    double least() const noexcept { return least_; }
    bool isConvex() const noexcept {
        return std::all_of(faces_.begin(), faces_.begin() + static_cast<std::ptrdiff_t>(count_),
                           [](const Face* face) { return face->isConvex(); });
    }

    const Face* at(const Vec3& p, double& value) const noexcept {
        const Face* highest = faces_[0];
        value = valueOf(*highest, p);
        for (std::size_t i = 1; i < count_; ++i) {
            const double other = valueOf(*faces_[i], p);
            if (other <= value) continue;
            value = other;
            highest = faces_[i];
        }
        return highest;
    }

private:
    std::array<const Face*, kMostFaces> faces_{};
    std::size_t count_ = 0;
    double least_;
};

double slopeOn(const Face& face, const Curve& line, double t) noexcept {
    if (line.kind != Curve::Kind::Circle) return gradientOf(face, line.centre + t * line.e1).dot(line.e1);
    const double c = std::cos(t), s = std::sin(t);
    return gradientOf(face, line.centre + c * line.e1 + s * line.e2).dot(c * line.e2 - s * line.e1);
}

/// A lump's function along a line.
class Walk {
public:
    static constexpr double kEnough = kClosed;

    struct Point {
        double t = 0.0;
        Vec3 p;
    };

    Walk(const Curve& line, const Lump& lump) noexcept : line_(line), lump_(lump), highest_(line, lump) {}

    const Curve& line() const noexcept { return line_; }
    const Lump& lump() const noexcept { return lump_; }
    const Highest& faces() const noexcept { return highest_; }

    Point at(double t) const noexcept { return {t, pointOf(line_, t)}; }
    double value(const Face& face, const Point& at) const noexcept { return valueOf(face, at.p); }
    double slope(const Face& face, const Point& at) const noexcept { return slopeOn(face, line_, at.t); }
    const Face* highest(const Point& at, double& value) const noexcept { return highest_.at(at.p, value); }

private:
    const Curve& line_;
    const Lump& lump_;
    Highest highest_;
};

using Sample = SampleOn<Walk>;

/// A straight edge and a function that has one minimum on it.
double searchConvex(const Walk& walk, double reach, Touches& touches) noexcept {
    const double end = walk.line().end;
    const Sample low = sampleAt(walk, -end), high = sampleAt(walk, end);
    double least = std::min(low.value, high.value);
    if (low.slope < 0.0 && high.slope > 0.0) {
        const Touch touch = minimumBetween(walk, low, high);
        least = touch.gap;
        if (touch.gap <= reach) touches.add(touch);
    }
    addFixed(walk, low, reach, touches);
    addFixed(walk, high, reach, touches);
    return least;
}

/// The point is outside the lump by this face, and the nearest point on the face's whole surface lies on the lump's.
bool hasFootOn(const Face& face, const Lump& lump, const Vec3& p) noexcept {
    const double value = valueOf(face, p);
    if (value < valueOf(lump, p) - kOnFace) return false;
    const Vec3 foot = p - value * gradientOf(face, p);
    return std::all_of(lump.faces.begin(), lump.faces.end(),
                       [&](const Face& other) { return &other == &face || valueOf(other, foot) <= kOnFace; });
}

void addCore(const Curve& core, const Face& face, const Lump& lump, double t, double reach, Touches& touches) noexcept {
    const Vec3 p = pointOf(core, t);
    const double gap = valueOf(face, p) - core.thickness;
    if (gap > reach || !hasFootOn(face, lump, p)) return;
    touches.add({.kind = Touch::Kind::Smooth, .t = t, .gap = gap, .a = placeOf(lump, face)});
}

}  // namespace

double searchEdge(const Curve& edge, const Lump& lump, double reach, Touches& touches) noexcept {
    const Walk walk(edge, lump);
    const Highest& highest = walk.faces();
    if (highest.least() > reach) return highest.least();
    if (edge.kind == Curve::Kind::Straight && highest.isConvex()) return searchConvex(walk, reach, touches);
    const bool closed = edge.isClosed();
    const int pieces = edge.kind == Curve::Kind::Circle ? kCircleSamples : kStraightSamples;
    const double begin = -edge.end, piece = 2.0 * edge.end / pieces;
    std::array<Sample, kCircleSamples + 1> samples;
    for (int i = 0; i <= pieces; ++i) {
        Sample& sample = samples[static_cast<std::size_t>(i)];
        sample.at = {begin + piece * i, Vec3::Zero()};
        sample.at.p = samplePoint(edge, i, sample.at.t);
        sample.face = highest.at(sample.at.p, sample.value);
    }
    const double farthest = edge.extent() * piece;
    double least = samples[0].value;
    bool sloped = false;  // the sample before has its slope
    for (int i = 0; i < pieces; ++i) {
        Sample& low = samples[static_cast<std::size_t>(i)];
        Sample& high = samples[static_cast<std::size_t>(i) + 1];
        const double bound = 0.5 * (low.value + high.value - farthest);
        least = std::min(least, bound);
        if (bound > reach) {
            sloped = false;
            continue;
        }
        if (!sloped) low.slope = gradientOf(*low.face, low.at.p).dot(sampleSlope(edge, i, low.at.t));
        high.slope = gradientOf(*high.face, high.at.p).dot(sampleSlope(edge, i + 1, high.at.t));
        sloped = true;
        if (!(low.slope < 0.0 && high.slope >= 0.0)) continue;
        const Touch touch = minimumBetween(walk, low, high);
        if (touch.gap <= reach) touches.add(touch);
    }
    const int fan = edge.kind == Curve::Kind::Circle ? kCircleSamples / 8 : kStraightSamples;
    for (int i = 0; i < pieces + (closed ? 0 : 1); i += fan)
        addFixed(walk, samples[static_cast<std::size_t>(i)], reach, touches);
    return least;
}

double searchCore(const Curve& core, const Lump& lump, double reach, Touches& touches) noexcept {
    const auto boundOf = [&core](const Face& face) {
        const bool level = face.isPlane() && core.kind == Curve::Kind::Straight;
        return valueOf(face, core.centre) - (level ? std::abs(face.axis.dot(core.e1)) : core.extent()) - core.thickness;
    };
    double least = -std::numeric_limits<double>::infinity();
    for (const Face& face : lump.faces) least = std::max(least, boundOf(face));
    if (least > reach) return least;
    for (const Face& face : lump.faces) {
        if (boundOf(face) > reach) continue;
        if (core.kind == Curve::Kind::Point) {
            addCore(core, face, lump, 0.0, reach, touches);
            continue;
        }
        // A straight core's material ends with flat faces, so that only what lies beside it counts: nothing does of
        // a plane or a hollow face, which are nearest to its ends.
        const bool straight = core.kind == Curve::Kind::Straight;
        if (straight && (face.isPlane() || face.hollow)) continue;
        const int pieces = straight ? kStraightSamples : kRingSamples;
        const double begin = -core.end, piece = 2.0 * core.end / pieces;
        double low = begin, at_low = slopeOn(face, core, low);
        for (int i = 1; i <= pieces; ++i) {
            const double high = begin + piece * i, at_high = slopeOn(face, core, high);
            if (at_low < 0.0 && at_high >= 0.0)
                addCore(core, face, lump,
                        zeroBetween(low, high, at_low, at_high, [&](double t) { return slopeOn(face, core, t); }),
                        reach, touches);
            low = high;
            at_low = at_high;
        }
    }
    return least;
}

}  // namespace passung::closed_form
