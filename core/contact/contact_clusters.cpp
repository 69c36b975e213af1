#include "core/contact/contact_clusters.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace passung::contact {

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr double kAlike = 0.5;  // cosine of the angle between normals of one patch
constexpr double kFar = 1e9;    // buckets: farther places share those at the border

}  // namespace

ClusterFinder::ClusterFinder(std::size_t capacity)
    : points_(capacity), buckets_(std::bit_ceil(2 * capacity + 1), kNone), cluster_(capacity), clusters_(capacity) {}

/// The bucket of the cube with edge `link` around a point, or of one beside it.
std::size_t ClusterFinder::bucketOf(const Vec3& position, double link, int x, int y, int z) const noexcept {
    const Vec3 place = (position / link).cwiseMax(-kFar).cwiseMin(kFar).array().floor();
    std::uint64_t hash = 0;
    for (const double coordinate : {place.x() + x, place.y() + y, place.z() + z})
        hash = (hash ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(coordinate))) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(hash >> 20) & (buckets_.size() - 1);
}

std::uint32_t ClusterFinder::firstOf(std::uint32_t i) noexcept {
    while (points_[i].group != i) {
        points_[i].group = points_[points_[i].group].group;
        i = points_[i].group;
    }
    return i;
}

void ClusterFinder::collect(const ContactManifold& manifold, double link) noexcept {
    std::fill(buckets_.begin(), buckets_.end(), kNone);
    count_ = 0;
    for (const ContactPoint& contact : manifold) {
        if (!(contact.phi < 0.0) || contact.radius > 0.0 || count_ == points_.size()) continue;
        const auto i = static_cast<std::uint32_t>(count_++);
        std::uint32_t& bucket = buckets_[bucketOf(contact.position, link, 0, 0, 0)];
        points_[i] = {contact.position, contact.normal, contact.area, contact.phi, bucket, i, contact.area > 0.0};
        bucket = i;
    }
}

/// All points that may belong to the patch of point `i`, with their squared distance; some perhaps twice.
template <class Visit>
void ClusterFinder::visitNear(std::uint32_t i, double link, Visit visit) noexcept {
    const Point& point = points_[i];
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                for (std::uint32_t k = buckets_[bucketOf(point.position, link, x, y, z)]; k != kNone;
                     k = points_[k].next) {
                    const double squared = (points_[k].position - point.position).squaredNorm();
                    if (k == i || squared > link * link || points_[k].normal.dot(point.normal) < kAlike) continue;
                    visit(k, squared);
                }
}

void ClusterFinder::joinFaces(double link) noexcept {
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (!points_[i].joins) continue;
        visitNear(i, link, [&](std::uint32_t k, double) {
            if (k > i || !points_[k].joins) return;  // the other one comes later
            const std::uint32_t a = firstOf(i), b = firstOf(k);
            points_[std::max(a, b)].group = std::min(a, b);
        });
    }
}

void ClusterFinder::joinEdges(double link) noexcept {
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (points_[i].joins) continue;
        std::uint32_t nearest = kNone;
        double least = std::numeric_limits<double>::infinity();
        visitNear(i, link, [&](std::uint32_t k, double squared) {
            if (!(points_[k].area > 0.0) || !(squared < least || (squared == least && k < nearest))) return;
            least = squared;
            nearest = k;
        });
        if (nearest == kNone)
            points_[i].joins = true;
        else
            points_[i].group = firstOf(nearest);
    }
    // Those that are alone with others of their kind.
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (!points_[i].joins || points_[i].area > 0.0) continue;
        visitNear(i, link, [&](std::uint32_t k, double) {
            if (k > i || !points_[k].joins || points_[k].area > 0.0) return;
            const std::uint32_t a = firstOf(i), b = firstOf(k);
            points_[std::max(a, b)].group = std::min(a, b);
        });
    }
}

void ClusterFinder::sum() noexcept {
    found_ = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
        if (firstOf(i) != i) continue;
        cluster_[i] = static_cast<std::uint32_t>(found_);
        clusters_[found_++] = {};
    }
    for (std::uint32_t i = 0; i < count_; ++i) {
        const Point& point = points_[i];
        ContactCluster& cluster = clusters_[cluster_[firstOf(i)]];
        if (point.phi < cluster.phi) {
            cluster.phi = point.phi;
            cluster.deepest = point.position;
        }
        ++cluster.points;
        cluster.area += point.area;
        cluster.push += point.area * point.phi * point.normal;
        cluster.volume += point.area * -point.phi;
        cluster.pressure_point += point.area * -point.phi * point.position;
        // Edges count only where there is nothing else.
        if (point.area > 0.0 || points_[firstOf(i)].area == 0.0)
            cluster.normal -= (point.area > 0.0 ? point.area : 1.0) * point.normal;
    }
}

std::span<const ContactCluster> ClusterFinder::find(const ContactManifold& manifold, double link) noexcept {
    collect(manifold, link);
    joinFaces(link);
    joinEdges(link);
    sum();
    for (std::size_t c = 0; c < found_; ++c) {
        ContactCluster& cluster = clusters_[c];
        cluster.normal.normalize();
        cluster.pressure_point = cluster.volume > 0.0 ? Vec3(cluster.pressure_point / cluster.volume) : cluster.deepest;
    }
    const auto end = clusters_.begin() + static_cast<std::ptrdiff_t>(found_);
    const std::size_t listed = std::min(found_, kMostClusters);
    std::partial_sort(clusters_.begin(), clusters_.begin() + static_cast<std::ptrdiff_t>(listed), end,
                      [](const ContactCluster& a, const ContactCluster& b) { return a.phi < b.phi; });
    return {clusters_.data(), listed};
}

}  // namespace passung::contact
