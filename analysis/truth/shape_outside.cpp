#include "analysis/truth/shape_outside.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace passung::truth {
namespace {

using namespace shape;

constexpr double kHalfRoot = 1.0 / std::numbers::sqrt2;

double positive(double x) { return std::max(x, 0.0); }
/// std::hypot, three times as fast, of lengths that are far from the ends of the numbers' range.
double lengthOf(double x, double y) { return std::sqrt(x * x + y * y); }
double radial(const Vec3& p) { return lengthOf(p.x(), p.y()); }

/// The direction from the z axis to `p`.
Vec3 outwards(const Vec3& p) {
    const double r = radial(p);
    return r > 0.0 ? Vec3(p.x() / r, p.y() / r, 0.0) : Vec3(1.0, 0.0, 0.0);
}

/// The least of the bounds over one corner list. A set costs the less the sooner a tighter one came before it.
class Bound {
public:
    Bound(std::span<const Vec3> corners, const Vec3& centre, double enough)
        : middle(centre), corners_(corners), least_(enough) {}

    /// A convex set by an upper bound of a point's distance from it.
    template <class Distance>
    void set(const Distance& distance) {
        double most = 0.0;
        for (const Vec3& corner : corners_) {
            most = std::max(most, distance(corner));
            if (most >= least_) return;
        }
        least_ = most;
    }
    /// The half-space n·p ≥ h, n of length 1.
    void beyond(const Vec3& n, double h) {
        set([&](const Vec3& p) { return positive(h - n.dot(p)); });
    }
    /// Both half-spaces at once: n·p ≥ h and m·p ≥ k.
    void beyondBoth(const Vec3& n, double h, const Vec3& m, double k) {
        const double c = n.dot(m);
        set([&](const Vec3& p) {
            const double a = h - n.dot(p), b = k - m.dot(p);  // > 0: short of it
            if (a <= 0.0 && b <= 0.0) return 0.0;
            if (a > 0.0 && b - c * a <= 0.0) return a;  // the foot on the first plane is beyond the second
            if (b > 0.0 && a - c * b <= 0.0) return b;
            return std::sqrt(positive(a * a + b * b - 2.0 * c * a * b) / (1.0 - c * c));  // the line of both
        });
    }
    /// An outside that is convex in each half plane about the z axis only, by the distance from it in that. Its second
    /// derivatives are above -bend, so that within the hull it exceeds the corners' by no more than ½ bend · radius².
    template <class Distance>
    void bent(double bend, const Distance& distance) {
        double radius2 = 0.0;
        for (const Vec3& corner : corners_) radius2 = std::max(radius2, (corner - middle).squaredNorm());
        set([&](const Vec3& p) { return distance(p) + 0.5 * bend * radius2; });
    }
    double radius() const {
        double radius2 = 0.0;
        for (const Vec3& corner : corners_) radius2 = std::max(radius2, (corner - middle).squaredNorm());
        return std::sqrt(radius2);
    }
    void besideBox(double half_width, double half_depth, double low, double high) {
        beyond({1, 0, 0}, half_width);
        beyond({-1, 0, 0}, half_width);
        beyond({0, 1, 0}, half_depth);
        beyond({0, -1, 0}, half_depth);
        aboveAndBelow(low, high);
    }
    void aboveAndBelow(double low, double high) {
        beyond({0, 0, 1}, high);
        beyond({0, 0, -1}, -low);
    }
    double least() const { return least_; }

    const Vec3& middle;

private:
    std::span<const Vec3> corners_;
    double least_;
};

void add(const Sphere& s, Bound& bound) {
    const double r = bound.middle.norm();
    bound.beyond(r > 0.0 ? Vec3(bound.middle / r) : Vec3(0, 0, 1), 0.5 * s.diameter);
}

void add(const Box& b, Bound& bound) { bound.besideBox(0.5 * b.width, 0.5 * b.depth, -0.5 * b.height, 0.5 * b.height); }

void add(const Cylinder& c, Bound& bound) {
    bound.beyond(outwards(bound.middle), 0.5 * c.diameter);
    bound.aboveAndBelow(-0.5 * c.length, 0.5 * c.length);
}

/// Tangents of the tube's circle: beyond one that leans outwards a half-space, else the inside of a cone or cylinder,
/// cos(a) (r - R) + sin(a) z ≥ tube radius with cos(a) < 0.
void add(const Torus& t, Bound& bound) {
    const double ring = 0.5 * t.diameter, tube = 0.5 * t.tube_diameter;
    const double x = radial(bound.middle) - ring, z = bound.middle.z(), length = lengthOf(x, z);
    const double c = length > 0.0 ? x / length : 0.0, s = length > 0.0 ? z / length : 1.0;
    if (c >= 0.0) {
        bound.beyond(c * outwards(bound.middle) + Vec3(0, 0, s), ring * c + tube);
    } else {
        // Where the tangent's foot lies beyond the axis the true distance is larger: that to the apex.
        bound.set([&](const Vec3& p) {
            const double r = radial(p), short_of = tube - (c * (r - ring) + s * p.z());
            if (short_of <= 0.0) return 0.0;
            if (r + short_of * c >= 0.0) return short_of;
            return std::abs(s) > 0.0 ? lengthOf(r, p.z() - (tube + c * ring) / s) : short_of;
        });
    }
}

void add(const Sheet&, Bound&) {}

void add(const Peg& peg, Bound& bound) {
    const double radius = 0.5 * peg.diameter;
    const Vec3 out = outwards(bound.middle);
    bound.beyond(out, radius);
    bound.aboveAndBelow(0.0, peg.length);
    if (peg.chamfer > 0.0) bound.beyond(kHalfRoot * (out - Vec3(0, 0, 1)), kHalfRoot * (radius - peg.chamfer));
}

void add(const SquarePeg& peg, Bound& bound) {
    const double w = 0.5 * peg.width, d = 0.5 * peg.depth;
    bound.besideBox(w, d, 0.0, peg.length);
    if (!(peg.chamfer > 0.0)) return;
    for (const double side : {-1.0, 1.0}) {
        bound.beyond(kHalfRoot * Vec3(side, 0, -1), kHalfRoot * (w - peg.chamfer));
        bound.beyond(kHalfRoot * Vec3(0, side, -1), kHalfRoot * (d - peg.chamfer));
    }
}

/// Beyond the round body and beside or beyond the key at once; only the chamfer of the key's sides has no set.
void add(const KeyedPeg& peg, Bound& bound) {
    const double radius = 0.5 * peg.diameter, half_key = 0.5 * peg.key_width, reach = radius + peg.key_height;
    const Vec3 out = outwards(bound.middle);
    bound.aboveAndBelow(0.0, peg.length);
    bound.beyond({1, 0, 0}, reach);
    bound.beyond(out, std::max(radius, positive(out.x()) * reach + std::abs(out.y()) * half_key));
    const double side = bound.middle.y() < 0.0 ? -1.0 : 1.0;
    const Vec3 beside(0, side, 0);
    if (beside.dot(out) < 0.999) bound.beyondBoth(out, radius, beside, half_key);
    if (!(peg.chamfer > 0.0)) return;
    bound.beyond(kHalfRoot * Vec3(1, 0, -1), kHalfRoot * (reach - peg.chamfer));
    const Vec3 slope = kHalfRoot * (out - Vec3(0, 0, 1));
    const double h = kHalfRoot * (radius - peg.chamfer);
    if (out.x() <= 0.0 && half_key <= radius - peg.chamfer) bound.beyond(slope, h);
    bound.beyondBoth(slope, h, beside, half_key);
}

/// The room of a round bore above `floor`.
void addBore(double radius, double floor, Bound& bound) {
    bound.set([=](const Vec3& p) { return lengthOf(positive(radial(p) - radius), positive(floor - p.z())); });
}

/// The room between the slopes of a mouth: r ≤ radius + s with s = z + chamfer ≥ 0. The distance, or a little more
/// below it.
double mouthDistance(double radius, double chamfer, const Vec3& p) {
    const double lift = positive(-(p.z() + chamfer));
    const double over = positive(radial(p) - radius - (p.z() + chamfer + lift));
    return lengthOf(0.5 * over, lift + 0.5 * over);
}
void addRoundMouth(double radius, double chamfer, Bound& bound) {
    bound.set([=](const Vec3& p) { return mouthDistance(radius, chamfer, p); });
}

/// Room between x_low and x_high, |y| ≤ half_y, above `floor`.
void addSlot(double x_low, double x_high, double half_y, double floor, Bound& bound) {
    bound.set([=](const Vec3& p) {
        return Vec3(positive(std::max(x_low - p.x(), p.x() - x_high)), positive(std::abs(p.y()) - half_y),
                    positive(floor - p.z()))
            .norm();
    });
}

/// The same room where it widens: all borders but `fixed_low` by s = z + chamfer ≥ 0.
void addSlotMouth(double x_low, double x_high, double half_y, double chamfer, bool fixed_low, Bound& bound) {
    bound.set([=](const Vec3& p) {
        const double lift = positive(-(p.z() + chamfer)), s = p.z() + chamfer + lift;
        const double low = positive(x_low - (fixed_low ? 0.0 : s) - p.x());
        const double ex = std::max(fixed_low ? 2.0 * low : low, positive(p.x() - x_high - s));
        const double ey = positive(std::abs(p.y()) - half_y - s);
        return Vec3(0.5 * ex, 0.5 * ey, lift + 0.5 * std::max(ex, ey)).norm();
    });
}

/// Between two ridges of a thread, by its profile in half planes: a trapezium with one open side. `sign`: 1 of a bolt,
/// whose grooves open outwards, -1 of a nut. At `bottom` it is 2 `half` wide, and its flanks lean by `lean` from there.
void addGroove(double pitch, double bottom, double half, double lean, double middle, double sign, Bound& bound) {
    const auto heightOf = [&](const Vec3& p, double near) {  // over the middle of a ridge, the angle being near one
        double phi = std::atan2(p.y(), p.x());
        phi += 2.0 * std::numbers::pi * std::round((near - phi) / (2.0 * std::numbers::pi));
        return p.z() - middle - pitch * phi / (2.0 * std::numbers::pi);
    };
    const double r = radial(bound.middle), least = r - bound.radius();
    if (!(least > 0.5 * r)) return;
    const double near = std::atan2(bound.middle.y(), bound.middle.x());
    const double groove = pitch * std::round(heightOf(bound.middle, near) / pitch);
    const double lead = pitch / (2.0 * std::numbers::pi), cosine = std::cos(lean), sine = std::sin(lean);
    bound.bent((1.0 + lead / least) / least, [&](const Vec3& p) {
        const double out = sign * (radial(p) - bottom), aside = std::abs(heightOf(p, near) - groove) - half;
        const double beyond = cosine * aside - sine * out;  // the flank
        if (beyond <= 0.0 && out >= 0.0) return 0.0;
        if (aside <= 0.0) return -out;
        const double along = cosine * out + sine * aside;  // the flank, from its corner on
        return along >= 0.0 ? beyond : lengthOf(aside, out);
    });
}

template <class Thread>
double flankHeight(const Thread& thread) {
    return thread.flank_height > 0.0 ? thread.flank_height : 0.625 * 0.5 * std::numbers::sqrt3 * thread.pitch;
}

/// Half the width of a groove at its bottom. Ridge and groove are equally wide at 3/5 of the height from a bolt's crest
/// and a nut's root on, the groove by the clearance's half across its flanks more.
template <class Thread>
double halfBottom(const Thread& thread, double share) {
    const double lean = 0.5 * thread.flank_angle;
    return 0.25 * thread.pitch - share * flankHeight(thread) * std::tan(lean) +
           thread.clearance * (0.5 - std::sin(lean)) / std::cos(lean);
}

void add(const ThreadBolt& bolt, Bound& bound) {
    const double radius = 0.5 * bolt.nominal_diameter - bolt.clearance;
    const Vec3 out = outwards(bound.middle);
    bound.beyond(out, radius);
    bound.aboveAndBelow(0.0, bolt.length);
    if (bolt.chamfer > 0.0) bound.beyond(kHalfRoot * (out - Vec3(0, 0, 1)), kHalfRoot * (radius - bolt.chamfer));
    addGroove(bolt.pitch, radius - flankHeight(bolt), halfBottom(bolt, 0.4), 0.5 * bolt.flank_angle, 0.5 * bolt.pitch,
              1.0, bound);
}

template <class Plate>
double floorOf(const Plate& plate) {
    return plate.bore_depth >= plate.height ? -std::numeric_limits<double>::infinity() : -plate.bore_depth;
}

void add(const BorePlate& plate, Bound& bound) {
    addBore(0.5 * plate.bore_diameter, floorOf(plate), bound);
    bound.besideBox(0.5 * plate.width, 0.5 * plate.depth, -plate.height, 0.0);
    if (plate.chamfer > 0.0) addRoundMouth(0.5 * plate.bore_diameter, plate.chamfer, bound);
}

void add(const SquareBorePlate& plate, Bound& bound) {
    const double w = 0.5 * plate.pocket_width, d = 0.5 * plate.pocket_depth;
    addSlot(-w, w, d, floorOf(plate), bound);
    bound.besideBox(0.5 * plate.width, 0.5 * plate.depth, -plate.height, 0.0);
    if (plate.chamfer > 0.0) addSlotMouth(-w, w, d, plate.chamfer, false, bound);
}

void add(const KeyedBorePlate& plate, Bound& bound) {
    const double radius = 0.5 * plate.bore_diameter, half_key = 0.5 * plate.key_width;
    const double reach = radius + plate.key_height;
    addBore(radius, floorOf(plate), bound);
    addSlot(0.0, reach, half_key, floorOf(plate), bound);
    bound.besideBox(0.5 * plate.width, 0.5 * plate.depth, -plate.height, 0.0);
    if (!(plate.chamfer > 0.0)) return;
    addRoundMouth(radius, plate.chamfer, bound);
    addSlotMouth(0.0, reach, half_key, plate.chamfer, true, bound);
}

void add(const ThreadNut& nut, Bound& bound) {
    const double radius = 0.5 * nut.nominal_diameter + nut.clearance, crest = radius - flankHeight(nut);
    addBore(crest, -std::numeric_limits<double>::infinity(), bound);
    bound.aboveAndBelow(-nut.height, 0.0);
    bound.beyond(outwards(bound.middle), 0.5 * nut.outer_diameter);
    if (nut.chamfer > 0.0) {
        addRoundMouth(crest, nut.chamfer, bound);
        bound.set([&](const Vec3& p) {
            return mouthDistance(crest, nut.chamfer, {p.x(), p.y(), -nut.height - p.z()});
        });
    }
    addGroove(nut.pitch, radius, halfBottom(nut, 0.6), 0.5 * nut.flank_angle, 0.0, -1.0, bound);
}

double deepest(const Cylinder& c, const AxialExtent& e) {
    return std::min(0.5 * c.diameter - e.least_radius, 0.5 * c.length - std::max(e.least_height, -e.most_height));
}

double deepest(const Peg& peg, const AxialExtent& e) {
    const double radius = 0.5 * peg.diameter;
    return std::min({radius - e.least_radius, e.most_height, peg.length - e.least_height,
                     kHalfRoot * (radius - peg.chamfer - e.least_slope)});
}

/// Above the plate, below it, in its bore and between the slopes of its mouth.
double deepest(const BorePlate& plate, const AxialExtent& e) {
    const double radius = 0.5 * plate.bore_diameter;
    const double of_bore = lengthOf(positive(e.most_radius - radius), positive(floorOf(plate) - e.least_height));
    const double lift = positive(-(e.least_height + plate.chamfer));
    const double over = 0.5 * positive(e.most_slope - radius - plate.chamfer);
    return std::min({of_bore, lengthOf(over, lift + over), -e.least_height, plate.height + e.most_height});
}

template <class Other>
double deepest(const Other&, const AxialExtent&) {
    return std::numeric_limits<double>::infinity();
}

}  // namespace

double deepestOver(const Shape& shape, const AxialExtent& extent) {
    return positive(std::visit([&](const auto& s) { return deepest(s, extent); }, shape));
}

double deepestOver(const Shape& shape, std::span<const Vec3> corners, const Vec3& middle, double enough) {
    Bound bound(corners, middle, enough);
    std::visit([&](const auto& s) { add(s, bound); }, shape);
    return bound.least();
}

}  // namespace passung::truth
