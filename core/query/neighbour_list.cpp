#include "core/query/neighbour_list.h"

#include <algorithm>
#include <limits>

namespace passung::query {

using geometry::TriangleCorners;

void NeighbourList::begin(const geometry::TriangleTree& tree, double rounding) {
    tree_ = &tree;
    rounding_ = rounding;
    collected_ = false;
}

void NeighbourList::collect(const geometry::Bounds& box, const Vec3& way, double least, double limit) {
    const double reach = limit + rounding_;
    places_.clear();
    tree_->findAbove({box.low - Vec3::Constant(reach), box.high + Vec3::Constant(reach)}, way, least - reach, places_);
    if (places_.size() > kMost) return;
    collected_ = true;
    way_ = way;
    highest_ = -std::numeric_limits<double>::infinity();
    neighbours_.clear();
    for (const std::uint32_t place : places_) {
        const auto& [a, b, c, needle] = tree_->corners()[place];
        const TriangleCorners t{a, b, c};
        const Vec3 middle = geometry::centroid(t);
        const double end = std::max({way.dot(a), way.dot(b), way.dot(c)});
        highest_ = std::max(highest_, end);
        neighbours_.push_back({end, middle, geometry::farthestCorner(middle, t), t});
    }
}

geometry::TrianglePair NeighbourList::closestTo(const TriangleCorners& t, double limit) const {
    if (!collected_) return tree_->closestTo(t, limit);
    geometry::TrianglePair best{limit, t[0], t[0]};
    const double begin = std::min({way_.dot(t[0]), way_.dot(t[1]), way_.dot(t[2])});
    if (begin - highest_ > limit + rounding_) return best;
    const Vec3 middle = geometry::centroid(t);
    const double reach = geometry::farthestCorner(middle, t) + rounding_;
    for (const Neighbour& other : neighbours_) {
        if (begin - other.end > best.distance + rounding_) continue;
        const double span = best.distance + reach + other.reach;
        if ((middle - other.middle).squaredNorm() > span * span) continue;
        const geometry::TrianglePair pair = geometry::closestPair(t, other.corners, best.distance);
        if (pair.distance < best.distance) best = pair;
    }
    return best;
}

}  // namespace passung::query
