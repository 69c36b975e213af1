#include "core/closed_form/touch_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "core/closed_form/circle_samples.h"

namespace passung::closed_form {

namespace {

constexpr int kCircleSamples = CircleSamples::kPieces;
constexpr int kStraightSamples = 12;  // pieces
constexpr int kRingSamples = 96;      // of a circle against a face that is not simple on it: minima may lie close
constexpr int kSteps = 60;            // to close a bracket
constexpr double kClosed = 1e-10;     // of a line's parameter
constexpr double kOnFace = 1e-9;      // [m]
constexpr double kFlat = 0.02;        // of a line on a face [rad]

std::uint8_t placeOf(const Lump& lump, const Face& face) noexcept {
    return static_cast<std::uint8_t>(&face - lump.faces.data());
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
    if (line.kind != Curve::Kind::Circle) return gradientOf(face, line.centre + t * line.e1).dot(line.e1);
    const double c = std::cos(t), s = std::sin(t);
    return gradientOf(face, line.centre + c * line.e1 + s * line.e2).dot(c * line.e2 - s * line.e1);
}

/// A place on the line, with the highest face there.
struct Sample {
    double t = 0.0, value = 0.0, slope = 0.0;
    const Face* face = nullptr;
    Vec3 p;
};

Sample sampleAt(const Curve& line, const Highest& highest, double t) noexcept {
    Sample sample;
    sample.t = t;
    sample.p = pointOf(line, t);
    sample.face = highest.at(sample.p, sample.value);
    sample.slope = slopeOn(*sample.face, line, t);
    return sample;
}

using EdgeSamples = std::array<Sample, kCircleSamples + 1>;

/// Those of a whole circle, as far as possible at once.
void sampleCircle(const Curve& circle, const Highest& highest, double begin, double piece,
                  EdgeSamples& samples) noexcept {
    CircleSamples all;
    const bool told = all.take(circle, highest.faces());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Sample& sample = samples[i];
        sample.t = begin + piece * static_cast<double>(i);
        sample.p = all.point(i);
        if (told) {
            sample.value = all.value[i];
            sample.slope = all.slope[i];
            sample.face = highest.faces()[static_cast<std::size_t>(all.face[i])];
        } else {
            sample.face = highest.at(sample.p, sample.value);
            sample.slope = gradientOf(*sample.face, sample.p).dot(all.way(i));
        }
    }
}

void sampleEdge(const Curve& edge, const Highest& highest, double begin, double piece, int pieces,
                EdgeSamples& samples) noexcept {
    if (edge.isClosed()) return sampleCircle(edge, highest, begin, piece, samples);
    for (int i = 0; i <= pieces; ++i) samples[static_cast<std::size_t>(i)] = sampleAt(edge, highest, begin + piece * i);
}

/// The zero of a function between two places where its sign differs, by false position after Illinois.
template <class Function>
double zeroBetween(double low, double high, double at_low, double at_high, Function function) noexcept {
    int side = 0;
    for (int i = 0; i < kSteps && high - low > kClosed; ++i) {
        double t = at_high == at_low ? 0.5 * (low + high) : (low * at_high - high * at_low) / (at_high - at_low);
        if (!(t > low && t < high)) t = 0.5 * (low + high);
        const double value = function(t);
        if (std::abs(value) < 1e-18) return t;
        if ((value > 0.0) == (at_high > 0.0)) {
            if (side == 1) at_low *= 0.5;
            high = t;
            at_high = value;
            side = 1;
        } else {
            if (side == -1) at_high *= 0.5;
            low = t;
            at_low = value;
            side = -1;
        }
    }
    return 0.5 * (low + high);
}

/// The minimum between two samples of which the first falls and the second rises.
Touch minimumBetween(const Curve& line, const Lump& lump, const Highest& highest, Sample low, Sample high) noexcept {
    Sample here = low;
    for (int i = 0; i < kSteps; ++i) {
        const bool one_face = low.face == high.face;
        const double t = one_face ? zeroBetween(low.t, high.t, low.slope, high.slope,
                                                [&](double at) { return slopeOn(*low.face, line, at); })
                                  : zeroBetween(low.t, high.t, valueOf(*high.face, low.p) - low.value,
                                                high.value - valueOf(*low.face, high.p), [&](double at) {
                                                    const Vec3 p = pointOf(line, at);
                                                    return valueOf(*high.face, p) - valueOf(*low.face, p);
                                                });
        here = sampleAt(line, highest, t);
        const double of_low = valueOf(*low.face, here.p);
        if (here.value > of_low + 1e-15 && here.face != low.face && here.face != high.face) {
            (here.slope < 0.0 ? low : high) = here;  // a third face
            continue;
        }
        if (one_face) return {.kind = Touch::Kind::Smooth, .t = t, .gap = of_low, .a = placeOf(lump, *low.face)};
        const double falls = slopeOn(*low.face, line, t), rises = slopeOn(*high.face, line, t);
        if (falls <= 0.0 && rises >= 0.0) {
            if (rises - falls <= 0.0)
                return {.kind = Touch::Kind::Smooth, .t = t, .gap = of_low, .a = placeOf(lump, *low.face)};
            return {.kind = Touch::Kind::Kink,
                    .t = t,
                    .gap = of_low,
                    .a = placeOf(lump, *low.face),
                    .b = placeOf(lump, *high.face),
                    .share = rises / (rises - falls)};
        }
        if (falls > 0.0)
            high = {t, of_low, falls, low.face, here.p};
        else
            low = {t, of_low, rises, high.face, here.p};
    }
    return {.kind = Touch::Kind::Fixed, .t = here.t, .gap = here.value, .a = placeOf(lump, *here.face)};
}

/// Between two samples that both fall or both rise: a kink from the one's face, which turned on the way, to the
/// other's.
std::optional<Touch> kinkBetween(const Curve& line, const Lump& lump, const Sample& low, const Sample& high) noexcept {
    if (low.face == high.face || (low.slope < 0.0) != (high.slope < 0.0)) return std::nullopt;
    const bool turned =
        low.slope < 0.0 ? slopeOn(*high.face, line, low.t) > 0.0 : slopeOn(*low.face, line, high.t) < 0.0;
    if (!turned) return std::nullopt;
    const double t = zeroBetween(low.t, high.t, valueOf(*high.face, low.p) - low.value,
                                 high.value - valueOf(*low.face, high.p), [&](double at) {
                                     const Vec3 p = pointOf(line, at);
                                     return valueOf(*high.face, p) - valueOf(*low.face, p);
                                 });
    const double falls = slopeOn(*low.face, line, t), rises = slopeOn(*high.face, line, t);
    const double gap = valueOf(*low.face, pointOf(line, t));
    if (!(falls < 0.0 && rises > 0.0) || valueOf(lump, pointOf(line, t)) > gap + 1e-15) return std::nullopt;
    return Touch{.kind = Touch::Kind::Kink,
                 .t = t,
                 .gap = gap,
                 .a = placeOf(lump, *low.face),
                 .b = placeOf(lump, *high.face),
                 .share = rises / (rises - falls)};
}

bool isThere(const Touches& touches, const Curve& line, double t) noexcept {
    for (const Touch& touch : touches.all())
        if (apartOn(line, touch.t, t) < kSameTouch) return true;
    return false;
}

/// Where a line that lies on a face leaves it, whether or not that is a minimum: it tilts about either end.
void addEnd(const Curve& line, const Lump& lump, const Face& face, double t, double reach, Touches& touches) noexcept {
    const double gap = valueOf(face, pointOf(line, t));
    if (gap > reach || isThere(touches, line, t)) return;
    touches.add({.kind = Touch::Kind::Fixed, .t = t, .gap = gap, .a = placeOf(lump, face)});
}

bool liesOn(const Curve& line, double slope) noexcept { return std::abs(slope) < kFlat * line.extent(); }

/// Of a straight line through `at`, where a plane is the highest face.
void addEndsOnPlane(const Curve& edge, const Lump& lump, const Highest& highest, const Face& face, double at,
                    double reach, Touches& touches) noexcept {
    const double slope = slopeOn(face, edge, at), value = valueOf(face, pointOf(edge, at));
    if (!face.isPlane() || !liesOn(edge, slope)) return;
    double low = -edge.end, high = edge.end;
    for (const Face* other : highest.faces()) {
        if (other == &face || !other->isPlane()) continue;
        const double relative = slopeOn(*other, edge, at) - slope;
        const double short_of = value - valueOf(*other, pointOf(edge, at));
        if (relative > 0.0) high = std::min(high, at + short_of / relative);
        if (relative < 0.0) low = std::max(low, at + short_of / relative);
    }
    for (const double t : {low, high})
        if (low <= high && std::abs(t) < edge.end) addEnd(edge, lump, face, t, reach, touches);
}

bool isBeside(const Touches& touches, const Curve& line, double t) noexcept {
    for (const Touch& touch : touches.all()) {
        if (apartOn(line, touch.t, t) < (touch.kind == Touch::Kind::Kink ? kBesideKink : kSameTouch)) return true;
    }
    return false;
}

void addFixed(const Curve& edge, const Lump& lump, const Sample& at, double reach, Touches& touches) noexcept {
    if (at.value > reach || isBeside(touches, edge, at.t)) return;
    touches.add({.kind = Touch::Kind::Fixed, .t = at.t, .gap = at.value, .a = placeOf(lump, *at.face)});
}

/// A straight edge and a function that has one minimum on it.
double searchConvex(const Curve& edge, const Lump& lump, const Highest& highest, double reach,
                    Touches& touches) noexcept {
    const Sample low = sampleAt(edge, highest, -edge.end), high = sampleAt(edge, highest, edge.end);
    double least = std::min(low.value, high.value);
    if (low.slope < 0.0 && high.slope > 0.0) {
        const Touch touch = minimumBetween(edge, lump, highest, low, high);
        least = touch.gap;
        if (touch.gap <= reach) {
            touches.add(touch);
            addEndsOnPlane(edge, lump, highest, lump.faces[touch.a], touch.t, reach, touches);
            if (touch.b != Touch::kNone)
                addEndsOnPlane(edge, lump, highest, lump.faces[touch.b], touch.t, reach, touches);
        }
    } else {
        const Sample& lower = low.value < high.value ? low : high;
        addEndsOnPlane(edge, lump, highest, *lower.face, lower.t, reach, touches);
    }
    addFixed(edge, lump, low, reach, touches);
    addFixed(edge, lump, high, reach, touches);
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
    if (face.isPlane() || face.hollow) return turn;
    if (face.kind == Face::Kind::Torus) return std::numeric_limits<double>::infinity();
    const auto fromAxis = [&](const Vec3& p) {
        const Vec3 d = p - face.origin;
        return face.kind == Face::Kind::Sphere ? d.norm() : (d - d.dot(face.axis) * face.axis).norm();
    };
    const double r = std::min(fromAxis(low.p), fromAxis(high.p)) - 0.5 * way;
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
        take(*low.face, low.value, valueOf(*low.face, high.p));
        take(*high.face, valueOf(*high.face, low.p), high.value);
    }
    return bound;
}

/// A straight core's material ends with flat faces, so that only what lies beside it counts: nothing does of a plane or
/// a hollow face, which are nearest to its ends.
bool canTouch(const Curve& core, const Face& face) noexcept {
    return core.kind != Curve::Kind::Straight || !(face.isPlane() || face.hollow);
}

}  // namespace

double searchEdge(const Curve& edge, const Lump& lump, double reach, Touches& touches, double* closer) noexcept {
    const Highest highest(edge, lump);
    if (highest.least() > reach) return highest.least();
    if (edge.kind == Curve::Kind::Straight && highest.isConvex())
        return searchConvex(edge, lump, highest, reach, touches);
    const bool closed = edge.isClosed();
    const int pieces = edge.kind == Curve::Kind::Circle ? kCircleSamples : kStraightSamples;
    const double begin = -edge.end, piece = 2.0 * edge.end / pieces;
    EdgeSamples samples;
    sampleEdge(edge, highest, begin, piece, pieces, samples);
    const double farthest = edge.extent() * piece;
    double least = samples[0].value;
    for (int i = 0; i < pieces; ++i) {
        const Sample& low = samples[static_cast<std::size_t>(i)];
        const Sample& high = samples[static_cast<std::size_t>(i) + 1];
        const double bound = 0.5 * (low.value + high.value - farthest);
        least = std::min(least, bound);
        if (bound > reach) continue;
        if (low.face != high.face && (liesOn(edge, low.slope) || liesOn(edge, high.slope))) {
            const Face& flat = liesOn(edge, low.slope) ? *low.face : *high.face;
            const Face& other = &flat == low.face ? *high.face : *low.face;
            const auto ahead = [&](const Vec3& p) { return valueOf(*high.face, p) - valueOf(*low.face, p); };
            const double t = zeroBetween(low.t, high.t, ahead(low.p), ahead(high.p),
                                         [&](double at) { return ahead(pointOf(edge, at)); });
            if (slopeOn(flat, edge, t) * slopeOn(other, edge, t) > 0.0) addEnd(edge, lump, flat, t, reach, touches);
        }
        if (!(low.slope < 0.0 && high.slope >= 0.0)) {
            if (const auto kink = kinkBetween(edge, lump, low, high); kink && kink->gap <= reach) touches.add(*kink);
            continue;
        }
        const Touch touch = minimumBetween(edge, lump, highest, low, high);
        if (touch.gap <= reach) touches.add(touch);
    }
    if (closer != nullptr) {
        *closer = samples[0].value;
        for (std::size_t i = 0; i < static_cast<std::size_t>(pieces); ++i)
            *closer = std::min(*closer, closerBound(edge, samples[i], samples[i + 1], piece));
    }
    const int fan = edge.kind == Curve::Kind::Circle ? kCircleSamples / 8 : kStraightSamples;
    for (int i = 0; i < pieces + (closed ? 0 : 1); i += fan)
        addFixed(edge, lump, samples[static_cast<std::size_t>(i)], reach, touches);
    return least;
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
