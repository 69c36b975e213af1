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
    corners_.clear();
    corners_.reserve(places_.size());
    of_.resize(places_.size());
    candidates_.resize(places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const auto& [a, b, c, needle] = tree_->corners()[places_[i]];
        const TriangleCorners t{a, b, c};
        const Vec3 middle = geometry::centroid(t);
        of_.end[i] = std::max({way.dot(a), way.dot(b), way.dot(c)});
        of_.x[i] = middle.x();
        of_.y[i] = middle.y();
        of_.z[i] = middle.z();
        of_.reach[i] = geometry::farthestCorner(middle, t);
        highest_ = std::max(highest_, of_.end[i]);
        corners_.push_back(t);
    }
}

void NeighbourList::Numbers::resize(std::size_t count) {
    for (auto* numbers : {&end, &x, &y, &z, &reach}) numbers->resize(count);
}

/// Those that may be nearer than `limit` to a triangle with a sphere about `middle`, which begins at `begin` along the
/// way: without a jump, so that several are looked at at once.
std::size_t NeighbourList::findCandidates(const Vec3& middle, double begin, double reach, double limit) {
    const double *const end = of_.end.data(), *const x = of_.x.data(), *const y = of_.y.data(), *const z = of_.z.data();
    const double* const reaches = of_.reach.data();
    const double mx = middle.x(), my = middle.y(), mz = middle.z(), least_end = begin - limit - rounding_;
    std::uint32_t* const found = candidates_.data();
    std::size_t count = 0;
    for (std::size_t i = 0, all = corners_.size(); i < all; ++i) {
        const double dx = x[i] - mx, dy = y[i] - my, dz = z[i] - mz, span = limit + reach + reaches[i];
        found[count] = static_cast<std::uint32_t>(i);
        count += (dx * dx + dy * dy + dz * dz <= span * span ? 1u : 0u) & (end[i] >= least_end ? 1u : 0u);
    }
    return count;
}

geometry::TrianglePair NeighbourList::closestTo(const TriangleCorners& t, double limit) {
    if (!collected_) return tree_->closestTo(t, limit);
    geometry::TrianglePair best{limit, t[0], t[0]};
    const double begin = std::min({way_.dot(t[0]), way_.dot(t[1]), way_.dot(t[2])});
    if (begin - highest_ > limit + rounding_) return best;
    const Vec3 middle = geometry::centroid(t);
    const double reach = geometry::farthestCorner(middle, t) + rounding_;
    const std::size_t count = findCandidates(middle, begin, reach, limit);
    for (std::size_t i = 0; i < count; ++i) {
        const geometry::TrianglePair pair = geometry::closestPair(t, corners_[candidates_[i]], best.distance);
        if (pair.distance < best.distance) best = pair;
    }
    return best;
}

}  // namespace passung::query
