#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "analysis/truth/separation.h"

namespace passung::truth {

namespace {

using std::numbers::pi;

constexpr int kAngles = 32;         // of φ
constexpr int kFloorPoints = 32;    // of the tip's rim
constexpr double kParallel = 1e-5;  // of two faces [rad]

/// A place in the plane of the bore's axis and the direction φ.
struct Corner {
    double s, z;
};

/// A circle of the peg, seen along the tangent.
struct PegCircle {
    double s, z, radius;
};

struct Line {
    double value, slope;
};

/// The peg's shadow and the prism's corners.
class Shadows {
public:
    Shadows(const std::array<Vec3, 3>& centres, const std::array<double, 3>& radii, const Vec3& axis,
            const std::array<Corner, 3>& corners, double angle)
        : out_(std::cos(angle), std::sin(angle), 0.0),
          axis_s_(out_.dot(axis)),
          axis_z_(axis.z()),
          corners_(corners),
          axis_(axis),
          centres_(centres) {
        for (std::size_t i = 0; i < 3; ++i) rings_[i] = {out_.dot(centres[i]), centres[i].z(), radii[i]};
    }

    Vec3 normal(double tilt) const { return -std::cos(tilt) * out_ + Vec3(0, 0, std::sin(tilt)); }

    /// Gap along the normal that leans by `tilt` from the wall's to the top's, and how it changes with it.
    Line at(double tilt) const {
        const double c = std::cos(tilt), s = std::sin(tilt);
        const double along = -c * axis_s_ + s * axis_z_, along_slope = s * axis_s_ + c * axis_z_;
        const double across = std::sqrt(std::max(0.0, 1.0 - along * along));
        const double across_slope = across > 0.0 ? -along * along_slope / across : 0.0;
        Line held{std::numeric_limits<double>::infinity(), 0.0}, fixed{-held.value, 0.0};
        for (const PegCircle& ring : rings_) {
            const double value = -c * ring.s + s * ring.z - ring.radius * across;
            if (value < held.value) held = {value, s * ring.s + c * ring.z - ring.radius * across_slope};
        }
        for (const Corner& corner : corners_) {
            const double value = -c * corner.s + s * corner.z;
            if (value > fixed.value) fixed = {value, s * corner.s + c * corner.z};
        }
        return {held.value - fixed.value, held.slope - fixed.slope};
    }

    /// The tilt of the largest gap.
    double best() const {
        constexpr int kSamples = 8;
        constexpr double kPiece = pi / kSamples;
        std::array<Line, kSamples + 1> lines;
        int most = 0;
        for (int i = 0; i <= kSamples; ++i) {
            lines[static_cast<std::size_t>(i)] = at(kPiece * i - 0.5 * pi);
            if (lines[static_cast<std::size_t>(i)].value > lines[static_cast<std::size_t>(most)].value) most = i;
        }
        double best = kPiece * most - 0.5 * pi, value = lines[static_cast<std::size_t>(most)].value;
        for (const int first : {most - 1, most}) {
            if (first < 0 || first >= kSamples) continue;
            const double tilt =
                between(kPiece * first - 0.5 * pi, kPiece * (first + 1) - 0.5 * pi,
                        lines[static_cast<std::size_t>(first)], lines[static_cast<std::size_t>(first) + 1]);
            if (const double there = at(tilt).value; there > value) {
                best = tilt;
                value = there;
            }
        }
        return best;
    }

    /// Where the bodies touch.
    Vec3 place(double tilt) const {
        constexpr double kSame = 1e-9;  // [m]
        const Vec3 n = normal(tilt);
        std::array<Vec3, 3> points;
        std::array<double, 3> heights{};
        for (std::size_t i = 0; i < 3; ++i) {
            points[i] = pointOf(i, n);
            heights[i] = n.dot(points[i]);
        }
        const auto lowest =
            static_cast<std::size_t>(std::min_element(heights.begin(), heights.end()) - heights.begin());
        const Vec3 along(std::sin(tilt) * out_ + Vec3(0, 0, std::cos(tilt)));
        const auto heightOf = [&](const Corner& corner) {
            return -std::cos(tilt) * corner.s + std::sin(tilt) * corner.z;
        };
        const Corner& corner =
            *std::max_element(corners_.begin(), corners_.end(),
                              [&](const Corner& a, const Corner& b) { return heightOf(a) < heightOf(b); });
        const double wanted = std::sin(tilt) * corner.s + std::cos(tilt) * corner.z;
        for (std::size_t i = 0; i < 3; ++i) {
            if (i == lowest || heights[i] > heights[lowest] + kSame) continue;
            const double from = along.dot(points[lowest]), to = along.dot(points[i]);
            if (std::abs(to - from) < kSame) continue;
            const double share = std::clamp((wanted - from) / (to - from), 0.0, 1.0);
            return points[lowest] + share * (points[i] - points[lowest]);
        }
        return points[lowest];
    }

    /// Of the normal of the peg's side.
    double tiltAlongPeg() const { return std::atan2(axis_s_, axis_z_); }
    /// Gap and place of the bore's edge and the peg's side, if they lie beside each other.
    std::optional<std::pair<double, Vec3>> edgeOnSide() const {
        const double tilt = tiltAlongPeg();
        if (tilt < -0.02 || tilt > 0.25 * pi) return std::nullopt;
        const Vec3 n = normal(tilt), from = pointOf(1, n), to = pointOf(2, n);
        const Vec3 edge = corners_[0].s * out_ + Vec3(0, 0, corners_[0].z);
        const Vec3 along = std::sin(tilt) * out_ + Vec3(0, 0, std::cos(tilt));
        const double share = along.dot(edge - from) / along.dot(to - from);
        if (!(share > 0.0 && share < 1.0)) return std::nullopt;
        return std::pair(n.dot(from - edge), Vec3(from + share * (to - from)));
    }

    /// The ends of what the tip's rim and the line of the plate's edge have in common, seen from above.
    std::array<Vec3, 2> crossings() const {
        const Vec3 tangent(-out_.y(), out_.x(), 0.0);
        const double aside = corners_[1].s - rings_[0].s;
        const double half = std::sqrt(std::max(0.0, rings_[0].radius * rings_[0].radius - aside * aside));
        std::array<Vec3, 2> points;
        for (std::size_t i = 0; i < 2; ++i) {
            Vec3 p = centres_[0] + aside * out_ + (i == 0 ? half : -half) * tangent;
            p.z() -= axis_.dot(p - centres_[0]) / axis_.z();
            points[i] = p;
        }
        return points;
    }
    bool tipCrossesEdge() const { return std::abs(corners_[1].s - rings_[0].s) < rings_[0].radius; }

private:
    Vec3 pointOf(std::size_t i, const Vec3& n) const {
        const Vec3 across = n - n.dot(axis_) * axis_;
        const double length = across.norm();
        return length > 1e-12 ? Vec3(centres_[i] - rings_[i].radius / length * across)
                              : Vec3(centres_[i] + rings_[i].radius * out_);
    }

    /// The largest value between two places, by the crossing of their tangents.
    double between(double low, double high, Line at_low, Line at_high) const {
        for (int i = 0; i < 60 && high - low > 1e-12; ++i) {
            if (at_low.slope <= 0.0) return low;
            if (at_high.slope >= 0.0) return high;
            double t = (at_high.value - at_low.value + at_low.slope * low - at_high.slope * high) /
                       (at_low.slope - at_high.slope);
            const double margin = 1e-3 * (high - low);
            t = i % 4 == 3 ? 0.5 * (low + high) : std::clamp(t, low + margin, high - margin);
            const Line line = at(t);
            if (line.slope > 0.0) {
                low = t;
                at_low = line;
            } else {
                high = t;
                at_high = line;
            }
        }
        return at_low.value > at_high.value ? low : high;
    }

    Vec3 out_;
    double axis_s_, axis_z_;
    std::array<PegCircle, 3> rings_;
    std::array<Corner, 3> corners_;
    Vec3 axis_;
    std::array<Vec3, 3> centres_;
};

class PegInBore : public Separation {
public:
    PegInBore(const shape::Peg& peg, const shape::BorePlate& plate, const Pose& X_WP)
        : peg_(peg), plate_(plate), X_WP_(X_WP) {
        const double bore = 0.5 * plate.bore_diameter;
        corners_ = {Corner{bore, -plate.chamfer}, {bore + plate.chamfer, 0.0}, {bore, -plate.height}};
    }

    bool rowsAt(const Pose& X_WG, double rho, double reach, std::vector<FreedomRow>& rows) const override {
        const Pose X = X_WP_.inverse() * X_WG;
        const Mat3 R = X_WP_.q.toRotationMatrix();
        const auto add = [&](double gap, const Vec3& n, const Vec3& p) {
            FreedomRow row;
            row.along << R * n, R * (p - X.p).cross(n) / rho;
            row.gap = gap;
            rows.push_back(row);
        };
        const double radius = 0.5 * peg_.diameter;
        const Vec3 axis = X.q * Vec3::UnitZ();
        const std::array<Vec3, 3> centres{X.p, X * Vec3(0, 0, peg_.chamfer), X * Vec3(0, 0, peg_.length)};
        const std::array<double, 3> radii{radius - peg_.chamfer, radius, radius};
        if (!isOverPlate(X.p, radius) || centres[2].z() < radius) return false;
        const auto shadows = [&](double angle) { return Shadows(centres, radii, axis, corners_, angle); };
        const auto gapAt = [&](double angle) {
            const Shadows there = shadows(angle);
            return there.at(there.best()).value;
        };
        const auto addAt = [&](double angle) {
            const Shadows there = shadows(angle);
            const double tilt = there.best(), gap = there.at(tilt).value;
            if (gap > reach) return;
            add(gap, there.normal(tilt), there.place(tilt));
            // A line of the peg along the wall: both of its ends, whichever is nearer.
            if (const Vec3 p = there.place(0.0); p.z() < -plate_.chamfer && p.z() > -plate_.height)
                add(there.at(0.0).value, there.normal(0.0), p);
            if (const auto side = there.edgeOnSide())
                add(side->first, there.normal(there.tiltAlongPeg()), side->second);
            if (tilt > 0.5 * pi - kParallel && axis.head<2>().norm() < kParallel && there.tipCrossesEdge())
                for (const Vec3& p : there.crossings())
                    if (p.z() < reach) add(p.z(), Vec3::UnitZ(), p);
        };
        std::array<double, kAngles> gaps;
        constexpr double kPiece = 2.0 * pi / kAngles;
        for (int i = 0; i < kAngles; ++i) {
            const double low = shadows(kPiece * i).at(0.0).value;  // a bound
            gaps[static_cast<std::size_t>(i)] = low > reach ? low : gapAt(kPiece * i);
        }
        for (int i = 0; i < kAngles; ++i) {
            const double here = gaps[static_cast<std::size_t>(i)];
            if (here > reach) continue;
            addAt(kPiece * i);
            if (here <= gaps[static_cast<std::size_t>((i + kAngles - 1) % kAngles)] &&
                here <= gaps[static_cast<std::size_t>((i + 1) % kAngles)])
                addAt(leastBetween(kPiece * (i - 1), kPiece * (i + 1), gapAt));
        }
        if (plate_.bore_depth < plate_.height) {
            const auto addFloor = [&](const Vec3& p) {
                if (p.z() + plate_.bore_depth < reach) add(p.z() + plate_.bore_depth, Vec3::UnitZ(), p);
            };
            for (int i = 0; i < kFloorPoints; ++i) {
                const double t = 2.0 * pi * i / kFloorPoints;
                addFloor(X * Vec3(radii[0] * std::cos(t), radii[0] * std::sin(t), 0.0));
            }
            const Vec3 down = Vec3(0, 0, -1) + axis.z() * axis;
            if (down.norm() > 1e-9) addFloor(X.p + radii[0] * down.normalized());
        }
        return true;
    }

private:
    bool isOverPlate(const Vec3& tip, double radius) const {
        return std::abs(tip.x()) + radius < 0.5 * plate_.width && std::abs(tip.y()) + radius < 0.5 * plate_.depth;
    }

    /// By the golden section.
    template <class Function>
    static double leastBetween(double low, double high, const Function& f) {
        const double share = 0.5 * (std::sqrt(5.0) - 1.0);
        double a = high - share * (high - low), b = low + share * (high - low), at_a = f(a), at_b = f(b);
        while (high - low > 1e-7) {
            if (at_a < at_b) {
                high = b;
                b = a;
                at_b = at_a;
                a = high - share * (high - low);
                at_a = f(a);
            } else {
                low = a;
                a = b;
                at_a = at_b;
                b = low + share * (high - low);
                at_b = f(b);
            }
        }
        return 0.5 * (low + high);
    }

    shape::Peg peg_;
    shape::BorePlate plate_;
    Pose X_WP_;
    std::array<Corner, 3> corners_;
};

}  // namespace

std::unique_ptr<Separation> separationOfPeg(const shape::Shape& held, std::span<const PlacedShape> obstacles) {
    const auto* peg = std::get_if<shape::Peg>(&held);
    if (peg == nullptr || obstacles.size() != 1) return nullptr;
    const auto* plate = std::get_if<shape::BorePlate>(&obstacles.front().first);
    if (plate == nullptr) return nullptr;
    return std::make_unique<PegInBore>(*peg, *plate, obstacles.front().second);
}

}  // namespace passung::truth
