#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/geometry/mesh.h"

namespace passung::geometry {

/// Appends vertices and triangles; every face is given counter-clockwise as seen from outside.
class TriangleBuilder {
public:
    using Index = std::uint32_t;
    using Ring = std::vector<Index>;  // counter-clockwise seen from +z

    Index vertex(double x, double y, double z);
    void triangle(Index a, Index b, Index c) { mesh_.triangles.push_back({a, b, c}); }
    void quad(Index a, Index b, Index c, Index d);

    /// Circle about the z axis; `segments` divisible by 4.
    Ring ring(double radius, double z, int segments);
    Ring ring(const std::vector<Eigen::Vector2d>& points, double z);
    /// Its corners in the four quadrants, in order.
    Ring rectangle(double half_width, double half_depth, double z);

    /// Fan around a new vertex on the axis, facing up or down.
    void disc(const Ring& rim, double z, bool up);
    /// The band between two rings of equal size; it faces away from the axis if `upper` lies above `lower`, toward the
    /// axis if the two are exchanged.
    void band(const Ring& lower, const Ring& upper);
    /// Rectangle without the polygon `rim` around the axis, of which on_axis[q] begins quadrant q. Each corner must see
    /// the whole rim in its quadrant; one triangle per side of the rectangle joins two quadrants.
    void faceWithHole(const Ring& corners, const Ring& rim, const std::array<std::size_t, 4>& on_axis, bool up);
    /// The same for a rim that is a ring of a circle.
    void faceWithHole(const Ring& corners, const Ring& rim, bool up);

    /// Cosine and sine of 2π k/n, mirrored from the first quarter so that the polygon is exactly symmetric.
    static std::array<double, 2> direction(int k, int n);

    TriangleMesh take() { return std::move(mesh_); }

private:
    TriangleMesh mesh_;
};

}  // namespace passung::geometry
