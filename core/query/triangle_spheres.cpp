#include "core/query/triangle_spheres.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace passung::query {

namespace {

constexpr std::uint32_t kLeafTriangles = 8;  // of a node that is not halved

/// Of the farthest point from the origin [m].
double reachOf(const geometry::TriangleMesh& mesh) {
    const geometry::Bounds bounds = geometry::boundsOf(mesh);
    return bounds.low.cwiseAbs().cwiseMax(bounds.high.cwiseAbs()).norm();
}

}  // namespace

TriangleSpheres::TriangleSpheres(const geometry::TriangleMesh& mesh)
    : float_rounding(0x1p-24 * (1.0 + 1e-9) * reachOf(mesh)) {
    std::vector<std::uint32_t> order;  // of the triangles, as the leaves hold them
    buildNodes(mesh, order);
    copyTriangles(mesh, order);
}

struct TriangleSpheres::Range {
    std::uint32_t node, begin, end;
};

void TriangleSpheres::buildNodes(const geometry::TriangleMesh& mesh, std::vector<std::uint32_t>& order) {
    std::vector<Vec3> middles;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        middles.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
        order.push_back(i);
    }
    double leaves = 0.0;
    nodes.resize(1);
    std::vector<Range> tasks{{0, 0, static_cast<std::uint32_t>(order.size())}};
    while (!tasks.empty()) {
        const Range range = tasks.back();
        tasks.pop_back();
        geometry::Bounds corners, centres;
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            centres.extend(middles[order[i]]);
            for (const std::uint32_t v : mesh.triangles[order[i]]) corners.extend(mesh.vertices[v]);
        }
        const Vec3 centre = (0.5 * (corners.low + corners.high)).cast<float>().cast<double>();
        Node node{centre, 0.0, range.begin, range.end - range.begin};
        for (std::uint32_t i = range.begin; i < range.end; ++i)
            for (const std::uint32_t v : mesh.triangles[order[i]])
                node.radius = std::max(node.radius, (mesh.vertices[v] - centre).norm());
        if (node.count > kLeafTriangles) {
            int axis = 0;
            centres.size().maxCoeff(&axis);
            const std::uint32_t middle = range.begin + node.count / 2;
            std::nth_element(order.begin() + range.begin, order.begin() + middle, order.begin() + range.end,
                             [&](std::uint32_t i, std::uint32_t j) {
                                 return std::pair(middles[i][axis], i) < std::pair(middles[j][axis], j);
                             });
            node.first = static_cast<std::uint32_t>(nodes.size());
            node.count = 0;
            nodes.resize(nodes.size() + 2);
            tasks.push_back({node.first, range.begin, middle});
            tasks.push_back({node.first + 1, middle, range.end});
        }
        if (node.count > 0) {
            leaf_radius += node.radius;
            leaves += 1.0;
        }
        nodes[range.node] = node;
    }
    leaf_radius /= leaves;
}

/// Keeps what lies side by side close together in memory.
void TriangleSpheres::copyTriangles(const geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& order) {
    constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::vector<std::uint32_t> place(mesh.vertices.size(), kNone);
    faces.reserve(order.size());
    for (const std::uint32_t triangle : order) {
        geometry::Triangle face = mesh.triangles[triangle];
        for (std::uint32_t& v : face) {
            if (place[v] == kNone) {
                place[v] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back({mesh.vertices[v]});
            }
            v = place[v];
        }
        faces.push_back(face);
    }
}

}  // namespace passung::query
