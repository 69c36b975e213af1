#include "core/tick/guide_way.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace passung::tick {

GuideWay::GuideWay(const Pose& start, std::span<const Pose> on, double radius) : radius_(radius), end_(start) {
    pieces_.reserve(on.size());
    for (const Pose& X : on) {
        const Vec3 move = X.p - end_.p, turn = rotationVector(X.q * end_.q.conjugate());
        const double length = std::sqrt(move.squaredNorm() + radius * radius * turn.squaredNorm());
        if (length > 0.0) {
            const double begin = this->length();
            pieces_.push_back({end_, move, turn, begin, begin + length});
        }
        end_ = X;
    }
}

double GuideWay::shareOf(const Piece& piece, double gone) const noexcept {
    return std::clamp((gone - piece.begin) / (piece.end - piece.begin), 0.0, 1.0);
}

Pose GuideWay::at(double gone) const noexcept {
    const auto piece =
        std::upper_bound(pieces_.begin(), pieces_.end(), gone, [](double at, const Piece& p) { return at < p.end; });
    return piece == pieces_.end() ? end_ : piece->at(shareOf(*piece, gone));
}

double GuideWay::nearest(const Pose& X, double from, double to) const noexcept {
    double best = std::clamp(from, 0.0, length()), least = std::numeric_limits<double>::infinity();
    for (const Piece& piece : pieces_) {
        if (piece.end < from || piece.begin > to) continue;
        const double length = piece.end - piece.begin;
        const Vec3 turned = rotationVector(X.q * piece.X.q.conjugate());
        const double along =
            (piece.move.dot(X.p - piece.X.p) + radius_ * radius_ * piece.turn.dot(turned)) / (length * length);
        const double t = std::clamp(along, shareOf(piece, from), shareOf(piece, to));
        const Pose there = piece.at(t);
        const double away =
            (X.p - there.p).squaredNorm() + radius_ * radius_ * rotationVector(X.q * there.q.conjugate()).squaredNorm();
        if (!(away < least)) continue;
        least = away;
        best = piece.begin + t * length;
    }
    return best;
}

}  // namespace passung::tick
