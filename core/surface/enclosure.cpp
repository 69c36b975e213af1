#include "core/surface/enclosure.h"

#include <cmath>
#include <numbers>

#include "core/geometry/triangle_distance.h"

namespace passung::surface {

namespace {

constexpr double kNowhere = 1e300;
constexpr double kSlack = 1e-5;   // [m]: beyond the way that is enough
constexpr double kOnFace = 1e-9;  // [m]: a corner as near as this goes along the face's normal

/// Of the triangle a, b, c around the origin (van Oosterom and Strackee 1983) [sr].
double solidAngle(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// Where the ray from the origin along `d` meets the triangle [|d|]; kNowhere: nowhere.
double hitOf(const Vec3& d, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
    const Vec3 n = (b - a).cross(c - a);
    const double along = n.dot(d);
    if (along == 0.0) return kNowhere;
    const double t = n.dot(a) / along;
    const Vec3 p = t * d;
    const bool in =
        n.dot((b - a).cross(p - a)) >= 0.0 && n.dot((c - b).cross(p - b)) >= 0.0 && n.dot((a - c).cross(p - c)) >= 0.0;
    return t > 0.0 && in ? t : kNowhere;
}

}  // namespace

/// A piece of one part, and a body of the other.
struct EnclosureSearch::Pair {
    const ClusterTree& outer;
    const geometry::TreeMesh& body;
    const geometry::SurfacePiece& piece;
    Placement X;  // of the piece in the body's frame
    Vec3 corner;  // the piece's own [m]; this and what follows: the body's frame
    Vec3 hand;    // how far the piece would go to the hand [m]
    bool of_held;

    /// How far the piece has to go along `d` for all of it to be where its corner was.
    double trail(const Vec3& d) const noexcept {
        const Vec3 own = X.R.transpose() * d;
        const Vec3 middle = 0.5 * (piece.box.low + piece.box.high);
        return own.dot(piece.corner - middle) + 0.5 * own.cwiseAbs().dot(piece.box.size());
    }
};

void EnclosureSearch::restart() noexcept {
    pair_ = face_ = 0;
    found_ = false;
    angle_ = 0.0;
    shortest_ = hits_ = kNowhere;
}

/// First each piece of the held part with each body, then each of the obstacles with each of the held part.
EnclosureSearch::Pair EnclosureSearch::pairOf(std::size_t i, const Placement& X) const noexcept {
    const std::size_t held = held_->pieces().size() * obstacles_->bodies().size();
    if (i < held) {
        const auto& piece = held_->pieces()[i / obstacles_->bodies().size()];
        return {*obstacles_, obstacles_->bodies()[i % obstacles_->bodies().size()], piece, X, X * piece.corner, hand_,
                true};
    }
    const auto& piece = obstacles_->pieces()[(i - held) / held_->bodies().size()];
    Placement back;
    back.R = X.R.transpose();
    back.p = -(back.R * X.p);
    const Vec3 corner = back * piece.corner;
    return {*held_, held_->bodies()[(i - held) % held_->bodies().size()], piece, back, corner, -(back.R * hand_),
            false};
}

void EnclosureSearch::lookAt(const Pair& pair, const Cluster& face) noexcept {
    const Vec3 a = pair.outer.corner(face.first) - pair.corner;
    for (std::uint32_t i = face.first + 1; i + 1 < face.first + face.count; ++i) {
        const Vec3 b = pair.outer.corner(i) - pair.corner, c = pair.outer.corner(i + 1) - pair.corner;
        if (b == c) return;  // the last corner stands there again
        angle_ += solidAngle(a, b, c);
        if (pair.hand.squaredNorm() > 0.0) hits_ = std::min(hits_, hitOf(pair.hand, a, b, c));
        const Vec3 q = geometry::closestOnTriangle(Vec3::Zero(), a, b, c);
        const double away = q.norm();
        if (away >= shortest_) continue;
        const Vec3 d = away > kOnFace ? Vec3(q / away) : face.normal;
        const double length = away + pair.trail(d);
        if (length >= shortest_) continue;
        shortest_ = length;
        nearest_ = length * d;
    }
}

bool EnclosureSearch::advance(const Placement& X, const Vec3& hand, int& work, int budget) noexcept {
    const std::size_t pairs =
        held_->pieces().size() * obstacles_->bodies().size() + obstacles_->pieces().size() * held_->bodies().size();
    if (pair_ == 0 && face_ == 0) hand_ = hand;
    for (; pair_ < pairs && !found_; ++pair_) {
        const Pair pair = pairOf(pair_, X);
        ++work;
        const geometry::Bounds& box = pair.body.box;
        if (((pair.corner - box.low).array() < 0.0).any() || ((box.high - pair.corner).array() < 0.0).any()) continue;
        for (; pair.body.first + face_ < pair.body.end; ++face_) {
            if (work >= budget) return false;
            const Cluster& face = pair.outer[pair.outer.faces()[pair.body.first + face_]];
            lookAt(pair, face);
            work += kWorkOfFace + static_cast<int>(face.count);
        }
        if (angle_ > 2.0 * std::numbers::pi) {
            found_ = true;
            const double length = pair.hand.norm();
            if (hits_ < 1.0 && hits_ * length + pair.trail(pair.hand / length) <= length)
                nearest_ = (hits_ + pair.trail(pair.hand / length) / length) * pair.hand;
            nearest_ += kSlack * nearest_.normalized();
            way_out_ = pair.of_held ? nearest_ : Vec3(-(X.R * nearest_));
        }
        face_ = 0;
        angle_ = 0.0;
        shortest_ = hits_ = kNowhere;
    }
    return true;
}

}  // namespace passung::surface
