#include "core/model/disk_subset.h"

#include "core/model/mesh.h"

namespace passung::model {

PointBuckets::PointBuckets(std::span<const Vec3> positions, double edge) {
    Bounds bounds;
    for (const Vec3& p : positions) bounds.extend(p);
    if (positions.empty()) bounds = {Vec3::Zero(), Vec3::Zero()};
    low_ = bounds.low;
    const double usable = std::max(edge, bounds.size().maxCoeff() / (kMost - 1));
    inverse_edge_ = 1.0 / usable;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        count_[axis] = static_cast<int>(bounds.size()[static_cast<int>(axis)] * inverse_edge_) + 1;
    }
    first_.assign(indexOf(0, 0, count_[2]), -1);
}

std::array<int, 3> PointBuckets::cellOf(const Vec3& p) const {
    std::array<int, 3> cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int i = static_cast<int>(axis);
        cell[axis] = std::clamp(static_cast<int>((p[i] - low_[i]) * inverse_edge_), 0, count_[axis] - 1);
    }
    return cell;
}

void PointBuckets::insert(const Vec3& p, std::uint32_t index) {
    if (index >= next_.size()) next_.resize(index + 1, -1);
    const std::array<int, 3> c = cellOf(p);
    std::int32_t& head = first_[indexOf(c[0], c[1], c[2])];
    next_[index] = head;
    head = static_cast<std::int32_t>(index);
}

std::vector<std::uint32_t> diskSubset(std::span<const Vec3> positions, std::span<const Vec3> normals, double radius,
                                      std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> chosen;
    PointBuckets buckets(positions, radius);
    const double limit = radius * radius;
    for (const std::uint32_t i : order) {
        bool free = true;
        buckets.visitAround(positions[i], [&](std::uint32_t j) {
            free = free && !((positions[i] - positions[j]).squaredNorm() < limit && facesAlike(normals[i], normals[j]));
        });
        if (!free) continue;
        chosen.push_back(i);
        buckets.insert(positions[i], i);
    }
    return chosen;
}

std::vector<std::uint32_t> assignNearest(std::span<const Vec3> positions, std::span<const Vec3> normals, double radius,
                                         std::span<const std::uint32_t> chosen) {
    PointBuckets buckets(positions, radius);
    for (std::uint32_t k = 0; k < chosen.size(); ++k) buckets.insert(positions[chosen[k]], k);
    std::vector<std::uint32_t> nearest(positions.size(), kNoPoint);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        double best = radius * radius;
        buckets.visitAround(positions[i], [&](std::uint32_t k) {
            if (!facesAlike(normals[i], normals[chosen[k]])) return;
            const double d = (positions[i] - positions[chosen[k]]).squaredNorm();
            if (d < best) {
                best = d;
                nearest[i] = k;
            }
        });
    }
    return nearest;
}

}  // namespace passung::model
