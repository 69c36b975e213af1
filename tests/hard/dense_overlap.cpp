#include "tests/hard/dense_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace passung::hard {

namespace {

constexpr std::size_t kBlock = 16;     // points that rest and wake together
constexpr double kFineChord = 5e-6;    // of a circle, per size of the body: 700 samples a turn
constexpr double kCoarseChord = 1e-3;  // for faces
constexpr double kFeature = 0.94;      // cosine of the angle of a sharp edge: 20°
constexpr double kEdgeSpacing = 5e-3;  // per size
constexpr double kOnSurface = 1e-6;    // per size
constexpr double kBallChord = 1e-4;    // bodies without edges are sampled by vertices alone

void sampleSegment(const Vec3& a, const Vec3& b, double spacing, std::vector<Vec3>& points) {
    const int n = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
    for (int i = 0; i <= n; ++i) points.push_back(a + (b - a) * (static_cast<double>(i) / n));
}

Vec3 normalOf(const geometry::TriangleMesh& mesh, const geometry::Triangle& t) {
    return (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).normalized();
}

struct Edge {
    int triangles = 0;
    Vec3 normal = Vec3::Zero();  // of the first
    bool sharp = false;
};

/// Vertices with the same place count as one.
std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edgesOf(const geometry::TriangleMesh& mesh) {
    std::map<std::array<double, 3>, std::uint32_t> first;
    std::vector<std::uint32_t> same(mesh.vertices.size());
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec3& v = mesh.vertices[i];
        same[i] = first.emplace(std::array{v.x(), v.y(), v.z()}, i).first->second;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges;
    for (const geometry::Triangle& t : mesh.triangles) {
        const Vec3 n = normalOf(mesh, t);
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(same[t[k]], same[t[(k + 1) % 3]]);
            Edge& edge = edges[{a, b}];
            if (edge.triangles++ == 0) {
                edge.normal = n;
            } else {
                edge.sharp = edge.sharp || n.dot(edge.normal) < kFeature;
            }
        }
    }
    for (auto& [ends, edge] : edges) edge.sharp = edge.sharp || edge.triangles == 1;
    return edges;
}

void sampleFaces(const geometry::TriangleMesh& mesh, double spacing, std::vector<Vec3>& points) {
    for (const auto& [ends, edge] : edgesOf(mesh))
        sampleSegment(mesh.vertices[ends.first], mesh.vertices[ends.second], spacing, points);
    for (const geometry::Triangle& t : mesh.triangles) {
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
        const double height = (b - a).cross(c - a).norm() / longest;
        if (height < spacing) continue;
        const int n = static_cast<int>(std::ceil(longest / spacing));
        for (int i = 1; i < n; ++i)
            for (int k = 1; i + k < n; ++k) points.push_back(a + (b - a) * i / n + (c - a) * k / n);
    }
}

}  // namespace

DenseBody denseBody(const shape::Shape& shape, double spacing) {
    const double size = boundsOf(shape::tessellate(shape, 1e-3)).size().maxCoeff();
    DenseBody body;
    const geometry::TriangleMesh fine = shape::tessellate(
        shape, size * (std::holds_alternative<shape::Sphere>(shape) || std::holds_alternative<shape::Torus>(shape)
                           ? kBallChord
                           : kFineChord));
    const bool edgeless = std::holds_alternative<shape::Sphere>(shape) || std::holds_alternative<shape::Torus>(shape);
    if (edgeless) {
        body.points = fine.vertices;
    } else {
        for (const auto& [ends, edge] : edgesOf(fine))
            if (edge.sharp)
                sampleSegment(fine.vertices[ends.first], fine.vertices[ends.second],
                              std::min(kEdgeSpacing * size, spacing), body.points);
        sampleFaces(shape::tessellate(shape, size * kCoarseChord), spacing, body.points);
    }
    body.distance = [shape](const Vec3& p) { return shape::signedDistance(shape, p); };
    // What lies on a chord of a round face is off the surface, of a bore even in the air.
    std::erase_if(body.points, [&](const Vec3& p) { return std::abs(body.distance(p)) > kOnSurface * size; });
    return body;
}

DenseDistance::DenseDistance(DenseBody moving, std::vector<std::pair<DenseBody, Pose>> fixed)
    : moving_(std::move(moving)), fixed_(std::move(fixed)) {
    for (const Vec3& p : moving_.points) reach_ = std::max(reach_, p.norm());
    const auto unknown = [](const std::vector<Vec3>& points) {
        return std::vector<double>((points.size() + kBlock - 1) / kBlock, -std::numeric_limits<double>::infinity());
    };
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
        const DenseBody& other = fixed_[i].first;
        sides_.push_back({&moving_.points, &other.distance, i, true, unknown(moving_.points)});
        sides_.push_back({&other.points, &moving_.distance, i, false, unknown(other.points)});
    }
}

double DenseDistance::least(const Pose& X_WM, double enough) {
    if (placed_) path_ += (X_WM.p - last_.p).norm() + reach_ * rotationVector(X_WM.q * last_.q.conjugate()).norm();
    last_ = X_WM;
    placed_ = true;
    for (Side& side : sides_) {
        const Pose X_FM = fixed_[side.fixed].second.inverse() * X_WM;
        const Pose X = side.moving ? X_FM : X_FM.inverse();
        const Mat3 R = X.q.toRotationMatrix();
        for (std::size_t b = 0; b < side.bound.size(); ++b) {
            if (side.bound[b] - path_ >= enough) continue;
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t i = kBlock * b; i < std::min(kBlock * (b + 1), side.points->size()); ++i)
                least = std::min(least, (*side.distance)(R * (*side.points)[i] + X.p));
            side.bound[b] = path_ + least;
            enough = std::min(enough, least);
        }
    }
    return enough;
}

}  // namespace passung::hard
