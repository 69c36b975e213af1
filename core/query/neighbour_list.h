#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/triangle_tree.h"

namespace passung::query {

/// The distances of a few triangles that lie together from a mesh: for them its triangles that may matter are collected
/// once, and looked through instead of the tree. Memory is kept from one use to the next.
class NeighbourList {
public:
    /// Forgets all; from here on closestTo asks `tree`. `rounding`: of the coordinates [m].
    void begin(const geometry::TriangleTree& tree, double rounding);

    /// Collects the triangles that may be nearer than `limit` to any within `box`, no point of which lies less far
    /// along `way` (unit) than `least`, unless there are more than kMost.
    void collect(const geometry::Bounds& box, const Vec3& way, double least, double limit);
    static constexpr std::size_t kMost = 1000;  // beyond, a tree finds them faster

    /// As TriangleTree::closestTo. @pre after collect: `t` lies within its box, and `limit` is not larger than its.
    geometry::TrianglePair closestTo(const geometry::TriangleCorners& t, double limit);

private:
    /// One number of each triangle, for loops over many.
    struct Numbers {
        std::vector<double> end;             // how far it reaches along way_ [m]
        std::vector<double> x, y, z, reach;  // a sphere around it
        void resize(std::size_t count);
    };
    std::size_t findCandidates(const Vec3& middle, double begin, double reach, double limit);

    const geometry::TriangleTree* tree_ = nullptr;
    double rounding_ = 0.0;
    bool collected_ = false;
    std::vector<geometry::TriangleCorners> corners_;
    Numbers of_;                             // corners_
    std::vector<std::uint32_t> candidates_;  // room for all
    Vec3 way_ = Vec3::Zero();                // in which they are measured
    double highest_ = 0.0;                   // how far any of them reaches [m]
    std::vector<std::uint32_t> places_;
};

}  // namespace passung::query
