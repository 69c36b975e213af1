#include "core/geometry/cluster_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace passung::geometry {

namespace {

constexpr std::size_t kFewCorners = 48;  // of a hull that is kept as it is
constexpr std::size_t kByNormals = 128;  // faces: fewer are split where their normals differ most

}  // namespace

struct ClusterTree::Builder {
    /// What the tree is split by.
    struct FaceSummary {
        Vec3 centre, normal;
    };

    ClusterTree& tree;
    ConvexFaces mesh;
    std::vector<FaceSummary> summaries;
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> marks;  // per vertex: the last cluster that has it
    std::uint32_t mark = 0;

    Builder(ClusterTree& of, const TriangleMesh& triangles) : tree(of), mesh(mergeFlatTriangles(triangles)) {
        order.resize(mesh.faces.size());
        std::iota(order.begin(), order.end(), 0u);
        marks.assign(mesh.vertices.size(), 0);
        for (const ConvexFace& face : mesh.faces) {
            Bounds box;
            Vec3 area = Vec3::Zero();
            const Vec3& origin = mesh.vertices[face.corners[0]];
            for (std::size_t i = 0; i < face.corners.size(); ++i) {
                box.extend(mesh.vertices[face.corners[i]]);
                if (i + 2 < face.corners.size())
                    area += (mesh.vertices[face.corners[i + 1]] - origin)
                                .cross(mesh.vertices[face.corners[i + 2]] - origin);
            }
            summaries.push_back({0.5 * (box.low + box.high), area.norm() > 0.0 ? Vec3(area.normalized()) : area});
        }
    }

    void pushCorner(const Vec3& p) {
        tree.x_.push_back(p.x());
        tree.y_.push_back(p.y());
        tree.z_.push_back(p.z());
    }

    void summarise(Cluster& cluster, std::size_t first, std::size_t end) {
        ++mark;
        Bounds box;
        cluster.first = static_cast<std::uint32_t>(tree.x_.size());
        std::size_t corners = 0;
        std::vector<std::uint32_t> found;
        for (std::size_t k = first; k < end; ++k)
            for (const std::uint32_t v : mesh.faces[order[k]].corners) {
                if (marks[v] == mark) continue;
                marks[v] = mark;
                found.push_back(v);
                box.extend(mesh.vertices[v]);
            }
        cluster.centre = 0.5 * (box.low + box.high);
        for (const std::uint32_t v : found)
            cluster.radius = std::max(cluster.radius, (mesh.vertices[v] - cluster.centre).norm());
        cluster.radius *= 1.0 + 1e-12;
        corners = found.size();
        if (corners <= kFewCorners || end - first == 1) {
            for (const std::uint32_t v : found) pushCorner(mesh.vertices[v]);
        } else {
            corners = 8;
            for (int i = 0; i < 8; ++i)
                pushCorner({i & 1 ? box.high.x() : box.low.x(), i & 2 ? box.high.y() : box.low.y(),
                            i & 4 ? box.high.z() : box.low.z()});
        }
        for (; corners % kLanes != 0; ++corners) pushCorner({tree.x_.back(), tree.y_.back(), tree.z_.back()});
        cluster.count = static_cast<std::uint32_t>(corners);
    }

    /// Where to part the faces between; sorts them.
    std::size_t part(std::size_t first, std::size_t end) {
        Bounds centres, normals;
        for (std::size_t k = first; k < end; ++k) {
            centres.extend(summaries[order[k]].centre);
            normals.extend(summaries[order[k]].normal);
        }
        Eigen::Index axis, turn;
        centres.size().maxCoeff(&axis);
        const bool by_normals = end - first <= kByNormals && normals.size().maxCoeff(&turn) > 0.7;
        const auto from = order.begin() + static_cast<std::ptrdiff_t>(first),
                   to = order.begin() + static_cast<std::ptrdiff_t>(end);
        if (by_normals) {
            const double middle = 0.5 * (normals.low[turn] + normals.high[turn]);
            const auto cut =
                std::stable_partition(from, to, [&](std::uint32_t f) { return summaries[f].normal[turn] < middle; });
            return static_cast<std::size_t>(cut - order.begin());
        }
        const auto cut = from + (to - from) / 2;
        std::nth_element(from, cut, to, [&](std::uint32_t a, std::uint32_t b) {
            const double p = summaries[a].centre[axis], q = summaries[b].centre[axis];
            return p < q || (p == q && a < b);
        });
        return static_cast<std::size_t>(cut - order.begin());
    }

    void build(std::uint32_t self, std::size_t first, std::size_t end) {
        summarise(tree.clusters_[self], first, end);
        if (end - first == 1) {
            tree.clusters_[self].normal = summaries[order[first]].normal;
            tree.clusters_[self].triangle = mesh.faces[order[first]].triangle;
            return;
        }
        const std::size_t middle = part(first, end);
        const auto child = static_cast<std::uint32_t>(tree.clusters_.size());
        tree.clusters_[self].child = child;
        tree.clusters_.resize(tree.clusters_.size() + 2);
        build(child, first, middle);
        build(child + 1, middle, end);
    }
};

ClusterTree::ClusterTree(const TriangleMesh& mesh) {
    Builder builder(*this, mesh);
    faces_ = builder.mesh.faces.size();
    for (const Vec3& v : builder.mesh.vertices) {
        box_.extend(v);
        reach_ = std::max(reach_, v.norm());
    }
    clusters_.resize(1);
    builder.build(0, 0, faces_);
}

}  // namespace passung::geometry
