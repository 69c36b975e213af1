#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "analysis/truth/separation.h"
#include "core/geometry/mesh.h"

namespace passung::test {

/// Where two closed polyhedra are kept apart, by their features: vertices of one over faces of the other, and edges
/// that cross, each a condition of its own, exact where its feature is the nearest one. No convexity is asked for. Of a
/// face the triangles are looked at one by one; an edge between two of the same plane is none, and one that faces lie
/// on from outside never touches first. Truth: the definition of contact between polyhedra (Donald 1985: type A, B and
/// C contacts).
class MeshSeparation : public truth::Separation {
public:
    /// `X_WO`: the obstacle's pose.
    MeshSeparation(const geometry::TriangleMesh& held, const geometry::TriangleMesh& obstacle, const Pose& X_WO = {})
        : held_(held, {}), obstacle_(obstacle, X_WO) {}

    /// They are kept apart by so much from now on [m].
    void keepGap(double gap) { gap_ = gap; }

    bool rowsAt(const Pose& X_WG, double rho, double reach, std::vector<truth::FreedomRow>& rows) const override {
        const Body held = held_.movedTo(X_WG);
        findNear(held, X_WG, reach);
        const auto add = [&](const Vec3& n, const Vec3& place, double gap) {
            truth::FreedomRow row;
            row.along << n, (place - X_WG.p).cross(n) / rho;
            row.gap = gap - gap_;
            rows.push_back(row);
        };
        for (const auto& [v, t] : near_.held_over_faces)
            if (const auto gap = overFace(held.corners[v], obstacle_.faces[t], reach))
                add(obstacle_.faces[t].normal, held.corners[v].p, *gap);
        for (const auto& [v, t] : near_.faces_over_fixed)
            if (const auto gap = overFace(obstacle_.corners[v], held.faces[t], reach))
                add(-held.faces[t].normal, obstacle_.corners[v].p, *gap);
        for (const auto& [e, f] : near_.edges) {
            const Edge &a = held.edges[e], &b = obstacle_.edges[f];
            const Vec3 d = a.q - a.p, c = b.q - b.p, across = d.cross(c), apart = b.p - a.p;
            const double square = across.squaredNorm();
            if (square < 1e-8 * d.squaredNorm() * c.squaredNorm()) continue;  // parallel: their ends tell
            const double s = apart.cross(c).dot(across) / square, t = apart.cross(d).dot(across) / square;
            if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) continue;
            Vec3 n = across / std::sqrt(square);
            if (n.dot(b.first + b.second) < 0.0) n = -n;
            const Vec3 place = a.p + s * d;
            const double gap = n.dot(place - b.p - t * c);
            // Edges that go through each other are a crossing, whatever lies beside; edges that have gone past each
            // other are none unless nothing lies beyond them.
            const double beside = gap >= 0.0 ? kSlope : kBeside;
            if (std::abs(gap) <= reach && b.holds(n, beside) && a.holds(-n, beside)) add(n, place, gap);
        }
        return true;
    }

private:
    static constexpr double kSlope = 0.1;    // that a feature may be turned until it is the nearest one [rad]
    static constexpr double kBeside = 1e-6;  // a normal beside an edge's cone [rad]
    static constexpr double kRoom = 1e-3;    // way of the held part after which near pairs are found anew [m]
    static constexpr double kFlat = 1e-6;    // between normals of one plane
    static constexpr double kSame = 1e-9;    // vertices nearer than this are one [m]

    struct Corner {
        Vec3 p;
        std::vector<Vec3> along;  // unit, to its neighbours
    };
    struct Face {
        Vec3 a, b, c, normal;
    };
    struct Edge {
        Vec3 p, q, first, second;  // ends; outward normals of both faces

        /// May the other body lie beyond, in direction `n`? In the edge's normal cone, or so much beside it.
        bool holds(const Vec3& n, double beside) const {
            const Vec3 along = (q - p).normalized();
            Vec3 in_first = along.cross(first), in_second = along.cross(second);
            if (in_first.dot(second) > 0.0) in_first = -in_first;  // each from the edge into its face
            if (in_second.dot(first) > 0.0) in_second = -in_second;
            return n.dot(in_first) < beside && n.dot(in_second) < beside;
        }
    };
    struct Body {
        std::vector<Corner> corners;
        std::vector<Face> faces;
        std::vector<Edge> edges;  // convex ones alone
    };

    struct Solid : Body {
        double radius = 0.0;

        Solid(const geometry::TriangleMesh& mesh, const Pose& X) {
            // Vertices at one place are one.
            std::map<std::array<std::int64_t, 3>, std::size_t> places;
            std::vector<std::size_t> corner_of;
            for (const Vec3& v : mesh.vertices) {
                const Vec3 p = X * v;
                std::array<std::int64_t, 3> key{};
                for (std::size_t i = 0; i < 3; ++i) key[i] = std::llround(p[static_cast<Eigen::Index>(i)] / kSame);
                const auto [at, fresh] = places.try_emplace(key, this->corners.size());
                if (fresh) this->corners.push_back({p, {}});
                corner_of.push_back(at->second);
                radius = std::max(radius, v.norm());
            }
            std::map<std::pair<std::size_t, std::size_t>, std::vector<std::pair<Vec3, Vec3>>> sides;
            for (const auto& t : mesh.triangles) {
                const std::array<std::size_t, 3> at{corner_of[t[0]], corner_of[t[1]], corner_of[t[2]]};
                if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
                const auto corner = [&](std::size_t i) { return this->corners[at[i % 3]].p; };
                const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
                this->faces.push_back({corner(0), corner(1), corner(2), normal});
                for (std::size_t i = 0; i < 3; ++i)
                    sides[std::minmax(at[i], at[(i + 1) % 3])].emplace_back(normal, corner(i + 2));
            }
            for (const auto& [ends, both] : sides) {
                if (both.size() != 2) continue;
                const Vec3 p = this->corners[ends.first].p, q = this->corners[ends.second].p;
                this->corners[ends.first].along.push_back((q - p).normalized());
                this->corners[ends.second].along.push_back((p - q).normalized());
                const Vec3 &first = both[0].first, &second = both[1].first;
                if ((first - second).norm() < kFlat || first.dot(both[1].second - p) >= 0.0) continue;
                this->edges.push_back({p, q, first, second});
            }
        }

        Body movedTo(const Pose& X) const {
            Body there = *this;
            for (Corner& corner : there.corners) {
                corner.p = X * corner.p;
                for (Vec3& along : corner.along) along = X.q * along;
            }
            for (Face& face : there.faces) face = {X * face.a, X * face.b, X * face.c, X.q * face.normal};
            for (Edge& edge : there.edges) edge = {X * edge.p, X * edge.q, X.q * edge.first, X.q * edge.second};
            return there;
        }
    };

    /// The corner's height over the face's plane [m], where it is over the face and the face may be what it meets
    /// first.
    static std::optional<double> overFace(const Corner& corner, const Face& face, double reach) {
        const double height = face.normal.dot(corner.p - face.a);
        if (std::abs(height) > reach) return std::nullopt;
        const std::array<Vec3, 3> at{face.a, face.b, face.c};
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 side = at[(i + 1) % 3] - at[i];
            if (face.normal.cross(side).dot(corner.p - at[i]) < -1e-9 * side.norm()) return std::nullopt;
        }
        for (const Vec3& along : corner.along)
            if (face.normal.dot(along) < -kSlope) return std::nullopt;
        return height;
    }

    /// Pairs of features that come within `reach` of each other before the held part has moved by kRoom.
    void findNear(const Body& held, const Pose& X, double reach) const {
        const double way = (X.p - near_.X.p).norm() + held_.radius * rotationVector(X.q * near_.X.q.conjugate()).norm();
        if (near_.found && way <= kRoom && reach <= near_.reach) return;
        near_ = {true, X, reach, {}, {}, {}};
        const double far = reach + kRoom;
        const auto boxOf = [far](std::initializer_list<Vec3> points) {
            geometry::Bounds box;
            for (const Vec3& p : points) box.extend(p);
            box.low -= Vec3::Constant(far);
            box.high += Vec3::Constant(far);
            return box;
        };
        const auto meet = [](const geometry::Bounds& a, const Vec3& low, const Vec3& high) {
            return (a.low.array() <= high.array()).all() && (a.high.array() >= low.array()).all();
        };
        const auto pairs = [&](const std::vector<Corner>& corners, const std::vector<Face>& faces, auto& into) {
            for (std::size_t t = 0; t < faces.size(); ++t) {
                const auto box = boxOf({faces[t].a, faces[t].b, faces[t].c});
                for (std::size_t v = 0; v < corners.size(); ++v)
                    if (meet(box, corners[v].p, corners[v].p)) into.emplace_back(v, t);
            }
        };
        pairs(held.corners, obstacle_.faces, near_.held_over_faces);
        pairs(obstacle_.corners, held.faces, near_.faces_over_fixed);
        for (std::size_t e = 0; e < held.edges.size(); ++e) {
            const Edge& a = held.edges[e];
            const auto box = boxOf({a.p, a.q});
            for (std::size_t f = 0; f < obstacle_.edges.size(); ++f) {
                const Edge& b = obstacle_.edges[f];
                if (meet(box, b.p.cwiseMin(b.q), b.p.cwiseMax(b.q))) near_.edges.emplace_back(e, f);
            }
        }
    }

    using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
    struct Near {
        bool found = false;
        Pose X;
        double reach = 0.0;
        Pairs held_over_faces, faces_over_fixed, edges;
    };

    Solid held_, obstacle_;
    double gap_ = 0.0;   // that is kept [m]
    mutable Near near_;  // of the last look
};

}  // namespace passung::test
