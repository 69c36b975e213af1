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
    std::vector<std::uint32_t> found;  // vertices of the cluster at hand
    std::uint32_t mark = 0;

    Builder(ClusterTree& of, const TriangleMesh& triangles) : tree(of), mesh(mergeFlatTriangles(triangles)) {
        order.resize(mesh.faces.size());
        std::iota(order.begin(), order.end(), 0u);
        marks.assign(mesh.vertices.size(), 0);
        summaries.reserve(mesh.faces.size());
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

    void summarise(Cluster& cluster, std::size_t first, std::size_t end) {
        ++mark;
        Bounds box;
        cluster.first = static_cast<std::uint32_t>(tree.x_.size());
        std::size_t corners = 0;
        found.clear();
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
            for (const std::uint32_t v : found) tree.pushCorner(mesh.vertices[v]);
        } else {
            corners = 8;
            tree.pushCornersOf(box);
        }
        for (; corners % kLanes != 0; ++corners) tree.pushCorner({tree.x_.back(), tree.y_.back(), tree.z_.back()});
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

    /// Faces that share corners are one piece.
    void findPieces() {
        std::vector<std::uint32_t> above(mesh.vertices.size());  // towards the vertex that stands for the piece
        std::iota(above.begin(), above.end(), 0u);
        const auto first = [&](std::uint32_t v) {
            while (above[v] != v) v = above[v] = above[above[v]];
            return v;
        };
        for (const ConvexFace& face : mesh.faces)
            for (const std::uint32_t v : face.corners) above[first(v)] = first(face.corners[0]);
        std::vector<std::uint32_t> place(mesh.vertices.size(), 0);  // from 1 on
        for (const ConvexFace& face : mesh.faces) {
            const std::uint32_t piece = first(face.corners[0]);
            if (place[piece] == 0) {
                tree.pieces_.push_back({.corner = mesh.vertices[face.corners[0]], .box = {}});
                place[piece] = static_cast<std::uint32_t>(tree.pieces_.size());
            }
            for (const std::uint32_t v : face.corners) tree.pieces_[place[piece] - 1].box.extend(mesh.vertices[v]);
        }
        std::stable_sort(tree.pieces_.begin(), tree.pieces_.end(), [](const SurfacePiece& a, const SurfacePiece& b) {
            return a.box.size().norm() > b.box.size().norm();
        });
        tree.pieces_.resize(std::min(tree.pieces_.size(), kMostPieces));
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

/// Trees as they are, under clusters of the boxes around them.
struct ClusterTree::Joiner {
    /// A tree, and how many triangles those before it have.
    struct Part {
        PlacedTree placed;
        std::uint32_t triangles = 0;
        Vec3 middle = Vec3::Zero();  // of its box
    };

    ClusterTree& whole;

    void joinAll(std::span<const PlacedTree> trees) {
        std::vector<Part> parts;
        for (const PlacedTree& tree : trees) {
            const Bounds& box = tree.tree->bodies_.front().box;
            parts.push_back(
                {tree, static_cast<std::uint32_t>(whole.triangles_), tree.X * (0.5 * (box.low + box.high))});
            whole.triangles_ += tree.tree->triangles_;
        }
        join(0, parts);
    }

    /// One tree with its root at `self`.
    void place(std::uint32_t self, const Part& of) {
        const PlacedTree& part = of.placed;
        const ClusterTree& tree = *part.tree;
        const auto corners = static_cast<std::uint32_t>(whole.x_.size());
        const auto before = static_cast<std::uint32_t>(whole.clusters_.size()) - 1;  // of all but its root
        const Mat3 R = part.X.q.toRotationMatrix();
        for (std::uint32_t i = 0; i < tree.x_.size(); ++i) whole.pushCorner(R * tree.corner(i) + part.X.p);
        whole.clusters_.resize(whole.clusters_.size() + tree.size() - 1);
        for (std::uint32_t i = 0; i < tree.size(); ++i) {
            Cluster cluster = tree[i];
            cluster.centre = R * cluster.centre + part.X.p;
            cluster.normal = R * cluster.normal;
            cluster.first += corners;
            cluster.triangle += of.triangles;
            if (!cluster.isFace()) cluster.child += before;
            whole.clusters_[i == 0 ? self : before + i] = cluster;
        }
        const auto first = static_cast<std::uint32_t>(whole.faces_.size());
        for (const std::uint32_t face : tree.faces_) whole.faces_.push_back(face == 0 ? self : before + face);
        whole.bodies_.push_back(
            {first, static_cast<std::uint32_t>(whole.faces_.size()), boxAt(tree.bodies_.front().box, R, part.X.p)});
        for (const SurfacePiece& piece : tree.pieces_)
            whole.pieces_.push_back({R * piece.corner + part.X.p, boxAt(piece.box, R, part.X.p)});
    }

    /// Around the box where it lies.
    static Bounds boxAt(const Bounds& box, const Mat3& R, const Vec3& p) {
        const Vec3 centre = R * (0.5 * (box.low + box.high)) + p, half = R.cwiseAbs() * (0.5 * box.size());
        return {centre - half, centre + half};
    }

    /// Those of one half beside those of the other: along the longest side of the box around their middles. So few that
    /// it hardly matters stay in their order.
    static void sortAside(std::span<Part> parts) {
        if (parts.size() <= kInOrder) return;
        Bounds box;
        for (const Part& part : parts) box.extend(part.middle);
        Eigen::Index axis = 0;
        box.size().maxCoeff(&axis);
        std::sort(parts.begin(), parts.end(), [axis](const Part& a, const Part& b) {
            if (a.middle[axis] != b.middle[axis]) return a.middle[axis] < b.middle[axis];
            return a.triangles < b.triangles;
        });
    }
    static constexpr std::size_t kInOrder = 4;

    void join(std::uint32_t self, std::span<Part> parts) {
        if (parts.size() == 1) return place(self, parts.front());
        sortAside(parts);
        const auto child = static_cast<std::uint32_t>(whole.clusters_.size());
        whole.clusters_.resize(whole.clusters_.size() + 2);
        join(child, parts.first(parts.size() / 2));
        join(child + 1, parts.subspan(parts.size() / 2));
        Bounds box;
        for (const std::uint32_t below : {child, child + 1}) {
            const Cluster& cluster = whole.clusters_[below];
            for (std::uint32_t i = 0; i < cluster.count; ++i) box.extend(whole.corner(cluster.first + i));
        }
        Cluster& cluster = whole.clusters_[self];
        cluster.child = child;
        cluster.centre = 0.5 * (box.low + box.high);
        cluster.radius = (box.high - cluster.centre).norm() * (1.0 + 1e-12);
        cluster.first = static_cast<std::uint32_t>(whole.x_.size());
        cluster.count = 8;
        whole.pushCornersOf(box);
    }
};

void ClusterTree::pushCorner(const Vec3& p) {
    x_.push_back(p.x());
    y_.push_back(p.y());
    z_.push_back(p.z());
}

void ClusterTree::pushCornersOf(const Bounds& box) {
    for (int i = 0; i < 8; ++i)
        pushCorner({i & 1 ? box.high.x() : box.low.x(), i & 2 ? box.high.y() : box.low.y(),
                    i & 4 ? box.high.z() : box.low.z()});
}

ClusterTree::ClusterTree(const TriangleMesh& mesh) : triangles_(mesh.triangles.size()) {
    Builder builder(*this, mesh);
    for (const Vec3& v : builder.mesh.vertices) {
        box_.extend(v);
        reach_ = std::max(reach_, v.norm());
    }
    clusters_.resize(1);
    builder.build(0, 0, builder.mesh.faces.size());
    builder.findPieces();
    for (std::uint32_t i = 0; i < clusters_.size(); ++i)
        if (clusters_[i].isFace()) faces_.push_back(i);
    bodies_.push_back({0, static_cast<std::uint32_t>(faces_.size()), box_});
}

ClusterTree::ClusterTree(std::span<const PlacedTree> trees) {
    clusters_.resize(1);
    Joiner{*this}.joinAll(trees);
    for (std::vector<double>* coordinates : {&x_, &y_, &z_}) coordinates->shrink_to_fit();
    clusters_.shrink_to_fit();
    pieces_.shrink_to_fit();
    bodies_.shrink_to_fit();
    faces_.shrink_to_fit();
    for (const Cluster& cluster : clusters_) {
        if (!cluster.isFace()) continue;
        for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
            box_.extend(corner(i));
            reach_ = std::max(reach_, corner(i).norm());
        }
    }
}

}  // namespace passung::geometry
