#include "core/closed_form/touch_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "core/closed_form/circle_samples.h"
#include "core/closed_form/touch_minimum.h"

namespace passung::closed_form {

namespace {

constexpr int kCircleSamples = kCirclePieces;
constexpr int kStraightSamples = 12;  // pieces
constexpr int kRingSamples = 96;      // of a circle against a face that is not simple on it: minima may lie close
constexpr double kOnFace = 1e-9;      // [m]
constexpr double kFlat = 0.02;        // of a line on a face [rad]

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

    std::span<const Face* const> faces() const noexcept { return {faces_.data(), count_}; }
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
    const LinePlace at = placeAt(line, t);
    return gradientOf(face, pointOf(line, at)).dot(slopeOf(line, at));
}

/// A lump's function along a line.
class Walk {
public:
    static constexpr double kEnough = kClosed;

    struct Point : LinePlace {
        Vec3 p;
    };

    Walk(const Curve& line, const Lump& lump) noexcept : line_(line), lump_(lump), highest_(line, lump) {}

    const Curve& line() const noexcept { return line_; }
    const Lump& lump() const noexcept { return lump_; }
    const Highest& faces() const noexcept { return highest_; }

    Point at(double t) const noexcept {
        const LinePlace place = placeAt(line_, t);
        return {place, pointOf(line_, place)};
    }
    double value(const Face& face, const Point& at) const noexcept { return valueOf(face, at.p); }
    double slope(const Face& face, const Point& at) const noexcept {
        return gradientOf(face, at.p).dot(slopeOf(line_, at));
    }
    const Face* highest(const Point& at, double& value) const noexcept { return highest_.at(at.p, value); }

private:
    const Curve& line_;
    const Lump& lump_;
    Highest highest_;
};

using Sample = SampleOn<Walk>;

/// Places of whole circles at the samples.
struct CirclePlaces {
    std::array<LinePlace, kCircleSamples + 1> all;

    CirclePlaces() noexcept {
        constexpr double kPiece = 2.0 * std::numbers::pi / kCircleSamples;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double t = -std::numbers::pi + kPiece * static_cast<double>(i);
            all[i] = {t, std::cos(t), std::sin(t)};
        }
    }
};
const CirclePlaces kCirclePlaces;

/// Those along a whole circle, many at once.
class CircleRow {
public:
    explicit CircleRow(const Walk& walk) noexcept : walk_(walk) { told_ = rows_.take(walk.line(), faces()); }

    /// False: a face or a place is not what many at once are computed for.
    bool told() const noexcept { return told_; }
    double value(std::size_t i) const noexcept { return rows_.value[i]; }
    double slope(std::size_t i) const noexcept { return rows_.slope[i]; }
    const Face* face(std::size_t i) const noexcept { return faces()[static_cast<std::size_t>(rows_.face[i])]; }
    Sample operator[](std::size_t i) const noexcept {
        return {rows_.value[i], rows_.slope[i], face(i), {kCirclePlaces.all[i], rows_.point(i)}};
    }
    /// The same, of one whose faces are not told.
    Sample alone(std::size_t i) const noexcept {
        Sample sample;
        sample.at = {kCirclePlaces.all[i], rows_.point(i)};
        sample.face = walk_.highest(sample.at, sample.value);
        sample.slope = gradientOf(*sample.face, sample.at.p).dot(rows_.way(i));
        return sample;
    }

private:
    std::span<const Face* const> faces() const noexcept { return walk_.faces().faces(); }

    const Walk& walk_;
    CircleSamples rows_;
    bool told_ = false;
};

/// Those along any other line, one by one.
class LineRow {
public:
    Sample& at(std::size_t i) noexcept { return all_[i]; }
    double value(std::size_t i) const noexcept { return all_[i].value; }
    double slope(std::size_t i) const noexcept { return all_[i].slope; }
    const Face* face(std::size_t i) const noexcept { return all_[i].face; }
    const Sample& operator[](std::size_t i) const noexcept { return all_[i]; }

private:
    std::array<Sample, kCircleSamples + 1> all_;
};

/// Between two samples that both fall or both rise: a kink from the one's face, which turned on the way, to the
/// other's.
std::optional<Touch> kinkBetween(const Walk& walk, const Sample& low, const Sample& high) noexcept {
    if (low.face == high.face || (low.slope < 0.0) != (high.slope < 0.0)) return std::nullopt;
    const bool turned = low.slope < 0.0 ? walk.slope(*high.face, low.at) > 0.0 : walk.slope(*low.face, high.at) < 0.0;
    if (!turned) return std::nullopt;
    const Walk::Point at = walk.at(crossingBetween(walk, low, high));
    const double falls = walk.slope(*low.face, at), rises = walk.slope(*high.face, at);
    const double gap = walk.value(*low.face, at);
    if (!(falls < 0.0 && rises > 0.0) || valueOf(walk.lump(), at.p) > gap + 1e-15) return std::nullopt;
    return kinkAt(at, gap, placeOf(walk.lump(), *low.face), placeOf(walk.lump(), *high.face), rises / (rises - falls));
}

bool isThere(const Touches& touches, const Curve& line, double t) noexcept {
    for (const Touch& touch : touches.all())
        if (apartOn(line, touch.t, t) < kSameTouch) return true;
    return false;
}

/// Where a line that lies on a face leaves it, whether or not that is a minimum: it tilts about either end.
void addEnd(const Walk& walk, const Face& face, double t, double reach, Touches& touches) noexcept {
    const double gap = valueOf(face, pointOf(walk.line(), t));
    if (gap > reach || isThere(touches, walk.line(), t)) return;
    touches.add({.kind = Touch::Kind::Fixed, .t = t, .gap = gap, .a = placeOf(walk.lump(), face)});
}

bool liesOn(const Curve& line, double slope) noexcept { return std::abs(slope) < kFlat * line.extent(); }

/// Of a straight line through `at`, where a plane is the highest face.
void addEndsOnPlane(const Walk& walk, const Face& face, double at, double reach, Touches& touches) noexcept {
    const Curve& edge = walk.line();
    const double slope = slopeOn(face, edge, at), value = valueOf(face, pointOf(edge, at));
    if (!face.isPlane() || !liesOn(edge, slope)) return;
    double low = -edge.end, high = edge.end;
    for (const Face* other : walk.faces().faces()) {
        if (other == &face || !other->isPlane()) continue;
        const double relative = slopeOn(*other, edge, at) - slope;
        const double short_of = value - valueOf(*other, pointOf(edge, at));
        if (relative > 0.0) high = std::min(high, at + short_of / relative);
        if (relative < 0.0) low = std::max(low, at + short_of / relative);
    }
    for (const double t : {low, high})
        if (low <= high && std::abs(t) < edge.end) addEnd(walk, face, t, reach, touches);
}

/// A straight edge and a function that has one minimum on it.
double searchConvex(const Walk& walk, double reach, Touches& touches) noexcept {
    const double end = walk.line().end;
    const Lump& lump = walk.lump();
    const Sample low = sampleAt(walk, -end), high = sampleAt(walk, end);
    double least = std::min(low.value, high.value);
    if (low.slope < 0.0 && high.slope > 0.0) {
        const Touch touch = minimumBetween(walk, low, high);
        least = touch.gap;
        if (touch.gap <= reach) {
            touches.add(touch);
            addEndsOnPlane(walk, lump.faces[touch.a], touch.t, reach, touches);
            if (touch.b != Touch::kNone) addEndsOnPlane(walk, lump.faces[touch.b], touch.t, reach, touches);
        }
    } else {
        const Sample& lower = low.value < high.value ? low : high;
        addEndsOnPlane(walk, *lower.face, lower.at.t, reach, touches);
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

/// An upper bound of the second derivative of a face's function along a line, between two samples that are no more
/// than `way` apart: eᵀ K e + g · bend, with K at most 1 / r across the axis, and below 0 of what is hollow.
double mostBend(const Face& face, const Curve& line, const Sample& low, const Sample& high, double way) noexcept {
    const double turn = line.kind == Curve::Kind::Circle ? line.extent() : 0.0;
    if (face.kind == Face::Kind::Torus || face.kind == Face::Kind::Helicoid)
        return std::numeric_limits<double>::infinity();
    if (face.isPlane() || face.hollow) return turn;
    const auto fromAxis = [&](const Vec3& p) {
        const Vec3 d = p - face.origin;
        return face.kind == Face::Kind::Sphere ? d.norm() : (d - d.dot(face.axis) * face.axis).norm();
    };
    const double r = std::min(fromAxis(low.at.p), fromAxis(high.at.p)) - 0.5 * way;
    return r > 0.0 ? turn + line.extent() * line.extent() / r : std::numeric_limits<double>::infinity();
}

/// A lower bound of the largest function between two samples that are `piece` of t apart, closer than by the length of
/// the way alone: with a second derivative of at most M a function is short of its chord by at most M piece² / 8.
double closerBound(const Curve& line, const Sample& low, const Sample& high, double piece) noexcept {
    const double way = line.extent() * piece;
    double bound = 0.5 * (low.value + high.value - way);
    const auto take = [&](const Face& face, double at_low, double at_high) {
        bound =
            std::max(bound, std::min(at_low, at_high) - 0.125 * mostBend(face, line, low, high, way) * piece * piece);
    };
    if (low.face == high.face) {
        take(*low.face, low.value, high.value);
    } else {
        take(*low.face, low.value, valueOf(*low.face, high.at.p));
        take(*high.face, valueOf(*high.face, low.at.p), high.value);
    }
    return bound;
}

/// A straight core's material ends with flat faces, so that only what lies beside it counts: nothing does of a plane or
/// a hollow face, which are nearest to its ends.
bool canTouch(const Curve& core, const Face& face) noexcept {
    return core.kind != Curve::Kind::Straight || !(face.isPlane() || face.hollow);
}

}  // namespace

namespace {

/// What samples bracket. `piece`: of t, from one to the next.
template <class Row>
double searchBetween(const Walk& walk, const Row& samples, std::size_t pieces, double piece, double reach,
                     Touches& touches, double* closer) noexcept {
    const Curve& edge = walk.line();
    const double farthest = edge.extent() * piece;
    double least = samples.value(0);
    for (std::size_t i = 0; i < pieces; ++i) {
        const double bound = 0.5 * (samples.value(i) + samples.value(i + 1) - farthest);
        least = std::min(least, bound);
        if (bound > reach) continue;
        const bool brackets = samples.slope(i) < 0.0 && samples.slope(i + 1) >= 0.0;
        if (!brackets && samples.face(i) == samples.face(i + 1)) continue;
        const Sample &low = samples[i], &high = samples[i + 1];
        if (low.face != high.face && (liesOn(edge, low.slope) || liesOn(edge, high.slope))) {
            const Face& flat = liesOn(edge, low.slope) ? *low.face : *high.face;
            const Face& other = &flat == low.face ? *high.face : *low.face;
            const double t = crossingBetween(walk, low, high);
            if (slopeOn(flat, edge, t) * slopeOn(other, edge, t) > 0.0) addEnd(walk, flat, t, reach, touches);
        }
        if (!brackets) {
            if (const auto kink = kinkBetween(walk, low, high); kink && kink->gap <= reach) touches.add(*kink);
            continue;
        }
        const Touch touch = minimumBetween(walk, low, high);
        if (touch.gap <= reach) touches.add(touch);
    }
    if (closer != nullptr) {
        *closer = samples.value(0);
        for (std::size_t i = 0; i < pieces; ++i)
            *closer = std::min(*closer, closerBound(edge, samples[i], samples[i + 1], piece));
    }
    const bool circle = edge.kind == Curve::Kind::Circle;
    const std::size_t every = circle ? kFixedEvery : kStraightSamples;
    for (std::size_t i = 0; i < pieces + (edge.isClosed() ? 0 : 1); i += every)
        if (!(samples.value(i) > reach))
            addFixed(walk, samples[i], reach, touches,
                     circle ? static_cast<std::uint8_t>(i / kFixedEvery) : Touch::kNone);
    return least;
}

}  // namespace

double searchEdge(const Curve& edge, const Lump& lump, double reach, Touches& touches, double* closer) noexcept {
    const Walk walk(edge, lump);
    const Highest& highest = walk.faces();
    if (highest.least() > reach) return highest.least();
    if (edge.kind == Curve::Kind::Straight && highest.isConvex()) return searchConvex(walk, reach, touches);
    const int pieces = edge.kind == Curve::Kind::Circle ? kCircleSamples : kStraightSamples;
    const double begin = -edge.end, piece = 2.0 * edge.end / pieces;
    const auto all = static_cast<std::size_t>(pieces);
    if (edge.isClosed()) {
        const CircleRow row(walk);
        if (row.told()) return searchBetween(walk, row, all, piece, reach, touches, closer);
        LineRow samples;
        for (std::size_t i = 0; i <= all; ++i) samples.at(i) = row.alone(i);
        return searchBetween(walk, samples, all, piece, reach, touches, closer);
    }
    LineRow samples;
    for (int i = 0; i <= pieces; ++i) samples.at(static_cast<std::size_t>(i)) = sampleAt(walk, begin + piece * i);
    return searchBetween(walk, samples, all, piece, reach, touches, closer);
}

bool canTouch(const Curve& core, const Lump& lump) noexcept {
    return std::any_of(lump.faces.begin(), lump.faces.end(), [&](const Face& face) { return canTouch(core, face); });
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
        const bool straight = core.kind == Curve::Kind::Straight;
        if (!canTouch(core, face)) continue;
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
