#include "core/query/triangle_spheres.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace passung::query {

namespace {

constexpr std::uint32_t kLeafTriangles = 4;  // of a node that is not halved
constexpr std::size_t kSmallNode = 64;       // triangles: the spheres of larger ones may be larger
constexpr int kSphereSteps = 24;
constexpr std::size_t kFirstNodes = 32;  // a search would open those above anyway

/// Of the farthest point from the origin [m].
double reachOf(const model::TriangleMesh& mesh) {
    const model::Bounds bounds = model::boundsOf(mesh);
    return bounds.low.cwiseAbs().cwiseMax(bounds.high.cwiseAbs()).norm();
}

/// Moves the centre towards the farthest corner again and again, by shorter and shorter ways (M. Badoiu, K. Clarkson
/// 2003), which ends near the smallest sphere; then sets the radius.
void shrinkSphere(const model::TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
                  TriangleSpheres::Node& node) {
    const auto farthest = [&] {
        Vec3 corner = node.centre;
        double squared = 0.0;
        for (const std::uint32_t i : triangles)
            for (const std::uint32_t v : mesh.triangles[i]) {
                const double d = (mesh.vertices[v] - node.centre).squaredNorm();
                if (!(d > squared)) continue;
                squared = d;
                corner = mesh.vertices[v];
            }
        return corner;
    };
    const int steps = triangles.size() <= kSmallNode ? kSphereSteps : 0;
    for (int i = 2; i < 2 + steps; ++i) node.centre += (farthest() - node.centre) / static_cast<double>(i + 2);
    node.centre = node.centre.cast<float>().cast<double>();
    node.radius = (farthest() - node.centre).norm();
}

}  // namespace

TriangleSpheres::TriangleSpheres(const model::TriangleMesh& mesh)
    : float_rounding(0x1p-24 * (1.0 + 1e-9) * reachOf(mesh)) {
    std::vector<std::uint32_t> order;  // of the triangles, as the leaves hold them
    buildNodes(mesh, order);
    copyTriangles(mesh, order);
    findFirst();
}

struct TriangleSpheres::Range {
    std::uint32_t node, begin, end;
};

void TriangleSpheres::buildNodes(const model::TriangleMesh& mesh, std::vector<std::uint32_t>& order) {
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
        model::Bounds corners, centres;
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            centres.extend(middles[order[i]]);
            for (const std::uint32_t v : mesh.triangles[order[i]]) corners.extend(mesh.vertices[v]);
        }
        Node node{0.5 * (corners.low + corners.high), 0.0, range.begin, range.end - range.begin};
        shrinkSphere(mesh, std::span<const std::uint32_t>(order).subspan(range.begin, range.end - range.begin), node);
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

void TriangleSpheres::findFirst() {
    first.assign(1, 0);
    for (std::size_t i = 0; i < first.size() && first.size() < kFirstNodes;) {
        const Node& node = nodes[first[i]];
        if (node.count > 0) {
            ++i;
            continue;
        }
        first.erase(first.begin() + static_cast<std::ptrdiff_t>(i));
        first.push_back(node.first);
        first.push_back(node.first + 1);
    }
}

/// Keeps what lies side by side close together in memory.
void TriangleSpheres::copyTriangles(const model::TriangleMesh& mesh, const std::vector<std::uint32_t>& order) {
    constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::vector<std::uint32_t> place(mesh.vertices.size(), kNone);
    faces.reserve(order.size());
    for (const std::uint32_t triangle : order) {
        model::Triangle face = mesh.triangles[triangle];
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
