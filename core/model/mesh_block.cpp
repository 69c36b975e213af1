#include "core/model/mesh_block.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/model/instructions.h"
#include "core/model/interpolation.h"
#include "core/model/parallel.h"

namespace passung::model {

namespace {

using Flat = MeshBlockSampler::Flat;

constexpr int kCells = SurfaceBlock::kCells;
constexpr int kNodes = SurfaceBlock::kNodes;
constexpr std::size_t kLane = 8;                 // points are measured in groups of so many
constexpr std::size_t kMostLanes = 32;           // 27 nodes of a part, in whole groups
constexpr double kSlackRounding = 1e-7;          // of the sine of a small angle from its cosine
constexpr double kFlattest = 1e-10;              // height over longest edge of a triangle that has a normal
constexpr double kCoordinateRounding = 0x1p-50;  // of the corners of a cube, by coordinates
constexpr double kRelativeRounding = 1e-12;
constexpr double kInFront = 1e-6;  // of an edge: where a triangle is asked what it parts
constexpr std::array<int, 3> kStride{1, kNodes, kNodes* kNodes};
/// Lines are counted along this far beside the nodes, in cells, in a direction of no meaning: edges of parts often lie
/// on nodes, and what crosses at an edge would have to be told by rounding.
constexpr double kShift = 1e-7;
const Vec3 kShiftDirection(0.72, 0.41, 0.56);  // of about unit length

/// Points as arrays, in whole groups: what is beyond `count` is the last point again.
struct Lanes {
    std::array<double, kMostLanes> x, y, z;
    std::size_t count = 0, whole = 0;

    void add(const Vec3& p) {
        if (count == whole) whole += kLane;
        for (std::size_t i = count; i < whole; ++i) {
            x[i] = p.x();
            y[i] = p.y();
            z[i] = p.z();
        }
        ++count;
    }
    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

}  // namespace

/// A triangle prepared for distances: corners, edges, what points from each edge into the triangle, unit normal.
struct MeshBlockSampler::Flat {
    std::array<Vec3, 3> corner, edge, inward;
    std::array<double, 3> inverse_square;  // of each edge's length
    Vec3 normal;                           // 0 if the triangle has no area to speak of: then it is its edges

    explicit Flat(const TriangleTree::Corners& t) : corner{t.a, t.b, t.c} {
        double longest = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            edge[k] = corner[(k + 1) % 3] - corner[k];
            const double square = edge[k].squaredNorm();
            inverse_square[k] = square > 0.0 ? 1.0 / square : 0.0;
            longest = std::max(longest, square);
        }
        const Vec3 area = edge[0].cross(edge[1]);
        const double size = area.norm();
        normal = size > kFlattest * longest ? Vec3(area / size) : Vec3(Vec3::Zero());
        for (std::size_t k = 0; k < 3; ++k) inward[k] = normal.cross(edge[k]);
    }
};

namespace {

/// An edge and what lies beside it, in numbers of their own that a loop can keep in registers.
struct FlatEdge {
    double px, py, pz, ex, ey, ez, ix, iy, iz, inverse_square;

    FlatEdge(const Flat& t, std::size_t k)
        : px(t.corner[k][0]),
          py(t.corner[k][1]),
          pz(t.corner[k][2]),
          ex(t.edge[k][0]),
          ey(t.edge[k][1]),
          ez(t.edge[k][2]),
          ix(t.inward[k][0]),
          iy(t.inward[k][1]),
          iz(t.inward[k][2]),
          inverse_square(t.inverse_square[k]) {}

    struct Found {
        double x, y, z, square;  // from the nearest point of the edge
        double side;             // positive on the triangle's side
    };
    PASSUNG_INLINE Found from(double x, double y, double z) const {
        const double rx = x - px, ry = y - py, rz = z - pz;
        const double along = (rx * ex + ry * ey + rz * ez) * inverse_square;
        const double positive = along > 0.0 ? along : 0.0;
        const double on = positive < 1.0 ? positive : 1.0;
        const double dx = rx - on * ex, dy = ry - on * ey, dz = rz - on * ez;
        return {dx, dy, dz, dx * dx + dy * dy + dz * dz, rx * ix + ry * iy + rz * iz};
    }
};

/// Where a triangle is seen from points: squared distances, and the ways from its nearest points if wanted.
struct Seen {
    double* square;
    double *x, *y, *z;  // null: not wanted
};

/// To the triangle's plane above its inside, else to the nearest of its edges.
template <bool kWays>
PASSUNG_INLINE void measureOne(const Flat& t, const double* __restrict x, const double* __restrict y,
                               const double* __restrict z, double* __restrict square, double* __restrict way_x,
                               double* __restrict way_y, double* __restrict way_z) {
    const FlatEdge e0(t, 0), e1(t, 1), e2(t, 2);
    const double nx = t.normal[0], ny = t.normal[1], nz = t.normal[2];
    for (std::size_t i = 0; i < kLane; ++i) {
        const auto a = e0.from(x[i], y[i], z[i]), b = e1.from(x[i], y[i], z[i]), c = e2.from(x[i], y[i], z[i]);
        const double ab_square = a.square < b.square ? a.square : b.square;
        const double edges = ab_square < c.square ? ab_square : c.square;
        const double ab_side = a.side < b.side ? a.side : b.side, inside = ab_side < c.side ? ab_side : c.side;
        const double height = (x[i] - e0.px) * nx + (y[i] - e0.py) * ny + (z[i] - e0.pz) * nz;
        square[i] = inside > 0.0 ? height * height : edges;
        if constexpr (kWays) {
            const bool by_a = a.square < b.square, by_ab = ab_square < c.square;
            const double abx = by_a ? a.x : b.x, aby = by_a ? a.y : b.y, abz = by_a ? a.z : b.z;
            const double edge_x = by_ab ? abx : c.x, edge_y = by_ab ? aby : c.y, edge_z = by_ab ? abz : c.z;
            way_x[i] = inside > 0.0 ? height * nx : edge_x;
            way_y[i] = inside > 0.0 ? height * ny : edge_y;
            way_z[i] = inside > 0.0 ? height * nz : edge_z;
        }
    }
}

using Choice = std::vector<const Flat*>;
using Group = std::array<double, kLane>;

/// Of each point.
struct Nearest {
    std::array<double, kMostLanes> square;
    std::array<std::size_t, kMostLanes> triangle;
};

template <bool kWays>
PASSUNG_INLINE void measureEach(const Choice& triangles, const Lanes& points, const Seen& seen, Nearest& nearest) {
    for (std::size_t first = 0; first < points.whole; first += kLane) {
        Group smallest, which{};
        smallest.fill(std::numeric_limits<double>::infinity());
        for (std::size_t k = 0; k < triangles.size(); ++k) {
            const std::size_t at = k * points.whole + first;
            double* square = seen.square + at;
            measureOne<kWays>(*triangles[k], &points.x[first], &points.y[first], &points.z[first], square,
                              kWays ? seen.x + at : nullptr, kWays ? seen.y + at : nullptr,
                              kWays ? seen.z + at : nullptr);
            const double number = static_cast<double>(k);
            for (std::size_t i = 0; i < kLane; ++i) {
                const bool nearer = square[i] < smallest[i];
                smallest[i] = nearer ? square[i] : smallest[i];
                which[i] = nearer ? number : which[i];
            }
        }
        for (std::size_t i = 0; i < kLane; ++i) {
            nearest.square[first + i] = smallest[i];
            nearest.triangle[first + i] = static_cast<std::size_t>(which[i]);
        }
    }
}

PASSUNG_INLINE void measureAll(const Choice& triangles, const Lanes& points, const Seen& seen, Nearest& nearest) {
    if (seen.x == nullptr)
        measureEach<false>(triangles, points, seen, nearest);
    else
        measureEach<true>(triangles, points, seen, nearest);
}

/// Distances from a triangle at the corners of a cube: above[corner][lane].
PASSUNG_INLINE void cornersAll(const Flat& triangle, const Vec3& centre, double half, std::size_t lane,
                               std::array<Group, 8>& above) {
    Group x, y, z, square;
    for (std::size_t i = 0; i < kLane; ++i) {
        x[i] = centre[0] + (i & 1 ? half : -half);
        y[i] = centre[1] + (i & 2 ? half : -half);
        z[i] = centre[2] + (i & 4 ? half : -half);
    }
    measureOne<false>(triangle, x.data(), y.data(), z.data(), square.data(), nullptr, nullptr, nullptr);
    for (std::size_t i = 0; i < kLane; ++i) above[i][lane] = std::sqrt(square[i]);
}

/// For eight cubes around the points of `seen`: how far the support of each triangle's distance lies above `above` at
/// the corner where that is least.
PASSUNG_INLINE void excessAll(const Seen& seen, std::size_t triangles, double half, const std::array<Group, 8>& above,
                              double* __restrict excess) {
    const double* __restrict square = seen.square;
    const double* __restrict way_x = seen.x;
    const double* __restrict way_y = seen.y;
    const double* __restrict way_z = seen.z;
    const std::array<Group, 8> u = above;
    for (std::size_t k = 0; k < triangles; ++k, square += kLane, way_x += kLane, way_y += kLane, way_z += kLane) {
        for (std::size_t i = 0; i < kLane; ++i) {
            const double value = std::sqrt(square[i]);
            // At distance 0 the ways are 0 too.
            const double unit = half / (value + std::numeric_limits<double>::min());
            const double x = unit * way_x[i], y = unit * way_y[i], z = unit * way_z[i];
            const double xy = x + y, yx = y - x;
            const double room0 = u[0][i] + (xy + z), room1 = u[1][i] + (yx + z);
            const double room2 = u[2][i] - (yx - z), room3 = u[3][i] - (xy - z);
            const double room4 = u[4][i] + (xy - z), room5 = u[5][i] + (yx - z);
            const double room6 = u[6][i] - (yx + z), room7 = u[7][i] - (xy + z);
            const double a = room0 > room1 ? room0 : room1, b = room2 > room3 ? room2 : room3;
            const double c = room4 > room5 ? room4 : room5, d = room6 > room7 ? room6 : room7;
            const double ab = a > b ? a : b, cd = c > d ? c : d;
            excess[k * kLane + i] = value - (ab > cd ? ab : cd);
        }
    }
}

struct Kernels {
    void (*measure)(const Choice&, const Lanes&, const Seen&, Nearest&);
    void (*corners)(const Flat&, const Vec3&, double, std::size_t, std::array<Group, 8>&);
    void (*excess)(const Seen&, std::size_t, double, const std::array<Group, 8>&, double*);
};

void measureBaseline(const Choice& t, const Lanes& p, const Seen& s, Nearest& n) { measureAll(t, p, s, n); }
PASSUNG_V3 void measureV3(const Choice& t, const Lanes& p, const Seen& s, Nearest& n) { measureAll(t, p, s, n); }
PASSUNG_V4 void measureV4(const Choice& t, const Lanes& p, const Seen& s, Nearest& n) { measureAll(t, p, s, n); }
void cornersBaseline(const Flat& t, const Vec3& c, double half, std::size_t lane, std::array<Group, 8>& above) {
    cornersAll(t, c, half, lane, above);
}
PASSUNG_V3 void cornersV3(const Flat& t, const Vec3& c, double half, std::size_t lane, std::array<Group, 8>& above) {
    cornersAll(t, c, half, lane, above);
}
PASSUNG_V4 void cornersV4(const Flat& t, const Vec3& c, double half, std::size_t lane, std::array<Group, 8>& above) {
    cornersAll(t, c, half, lane, above);
}
void excessBaseline(const Seen& s, std::size_t n, double half, const std::array<Group, 8>& above, double* e) {
    excessAll(s, n, half, above, e);
}
PASSUNG_V3 void excessV3(const Seen& s, std::size_t n, double half, const std::array<Group, 8>& above, double* e) {
    excessAll(s, n, half, above, e);
}
PASSUNG_V4 void excessV4(const Seen& s, std::size_t n, double half, const std::array<Group, 8>& above, double* e) {
    excessAll(s, n, half, above, e);
}

const Kernels kKernels = bestInstructions() == Instructions::V4 ? Kernels{measureV4, cornersV4, excessV4}
                         : bestInstructions() == Instructions::V3
                             ? Kernels{measureV3, cornersV3, excessV3}
                             : Kernels{measureBaseline, cornersBaseline, excessBaseline};

/// Triangles as seen from points; with `ways` those points are the centres of eight cubes.
class View {
public:
    View(const Choice& triangles, const Lanes& points, bool ways, std::vector<double>& scratch)
        : triangles_(triangles), points_(points) {
        const std::size_t size = triangles.size() * points.whole;
        scratch.resize(std::max(scratch.size(), 5 * size));
        double* const all = scratch.data();
        seen_ = {all, nullptr, nullptr, nullptr};
        if (ways) seen_ = {all, all + size, all + 2 * size, all + 3 * size};
        excess_ = all + 4 * size;
        kKernels.measure(triangles, points, seen_, nearest_);
    }
    double least(std::size_t lane) const { return std::sqrt(nearest_.square[lane]); }

    /// Asks which triangles may be nearest to some point of the cubes with half edge `half` around the points c. Above
    /// is the distance u from the triangle nearest to c, convex, hence nowhere above its values at the corners
    /// interpolated; below is the support s of the distance from a triangle T at c, linear. Where s > u at all corners
    /// T is nowhere nearest.
    void judge(double half) {
        std::array<Group, 8> above;
        for (std::size_t i = 0; i < kLane; ++i) {
            kKernels.corners(*triangles_[nearest_.triangle[i]], points_[i], half, i, above);
            rounding_[i] =
                kRelativeRounding * (least(i) + half) + kCoordinateRounding * points_[i].cwiseAbs().maxCoeff();
        }
        kKernels.excess(seen_, triangles_.size(), half, above, excess_);
    }
    bool mayBeNearest(std::size_t triangle, std::size_t lane) const {
        return triangle == nearest_.triangle[lane] || excess_[triangle * kLane + lane] <= rounding_[lane];
    }

private:
    const Choice& triangles_;
    const Lanes& points_;
    Seen seen_;  // triangle by triangle
    Nearest nearest_;
    double* excess_;
    Group rounding_;
};

/// On which side of the line through p and q the point r lies, all projected along one axis. The corners come in one
/// order for both triangles at an edge, so that they agree about every point, whatever the rounding.
bool isLeft(const Vec3& p, const Vec3& q, double r1, double r2, int axis1, int axis2) {
    const bool swapped = std::pair(p[axis1], p[axis2]) > std::pair(q[axis1], q[axis2]);
    const Vec3 &a = swapped ? q : p, &b = swapped ? p : q;
    const double twice_area = (b[axis1] - a[axis1]) * (r2 - a[axis2]) - (b[axis2] - a[axis2]) * (r1 - a[axis1]);
    return (twice_area > 0.0) != swapped;
}

class Sampling {
public:
    Sampling(const TriangleTree& tree, const std::vector<Flat>& flats, const Vec3& low, double cell,
             SurfaceBlock& block)
        : tree_(tree),
          flats_(flats),
          low_(low),
          lines_(low + kShift * cell * kShiftDirection),
          cell_(cell),
          block_(block) {}

    void run(bool closed);

private:
    Vec3 at(double x, double y, double z) const { return low_ + cell_ * Vec3(x, y, z); }
    Choice near(const Vec3& p, double reach) const;
    void sampleOctant(const Vec3& first, const Choice& triangles);
    void samplePart(const Vec3& first, const Choice& triangles);
    double slackOf(const Choice& triangles, const View& judged, std::size_t lane) const;
    void countAlong(const Choice& triangles, int axis, int rows1, int rows2);
    void giveSigns(const Choice& triangles);
    bool consistent() const;

    const TriangleTree& tree_;
    const std::vector<Flat>& flats_;
    const Vec3 low_, lines_;
    const double cell_;
    SurfaceBlock& block_;
    std::vector<double> node_scratch_, centre_scratch_;
    std::array<int, SurfaceBlock::kAllNodes> winding_{};
};

void Sampling::run(bool closed) {
    const double half = 0.5 * kCells;
    const double nearest = tree_.closest(low_ + Vec3::Constant(half * cell_)).distance;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 first = half * cornerAt(i), centre = low_ + cell_ * (first + Vec3::Constant(0.5 * half));
        // Those within d(c) and the diagonal, for d(p) ≤ d(c) + |p - c| and d(c, T) ≤ d(p, T) + |p - c|.
        const double diagonal = std::sqrt(3.0) * half * cell_;
        const double limit = (nearest + 0.5 * diagonal) * (1.0 + kRelativeRounding);
        sampleOctant(first, near(centre, tree_.closest(centre, limit).distance + diagonal));
    }
    if (closed) giveSigns(near(low_ + Vec3::Constant(half * cell_), std::sqrt(3.0) * (half + kShift) * cell_));
}

/// The triangles whose box comes within `reach` of a point.
Choice Sampling::near(const Vec3& p, double reach) const {
    std::vector<std::uint32_t> found;
    tree_.findNear(p, reach * (1.0 + kRelativeRounding), found);
    Choice triangles;
    for (const std::uint32_t i : found) triangles.push_back(&flats_[i]);
    return triangles;
}

/// Samples the eight parts of an octant.
void Sampling::sampleOctant(const Vec3& first, const Choice& triangles) {
    constexpr double half = 2.0;
    Lanes centres;
    for (std::size_t i = 0; i < 8; ++i)
        centres.add(low_ + cell_ * (first + half * cornerAt(i) + Vec3::Constant(0.5 * half)));
    View view(triangles, centres, true, centre_scratch_);
    view.judge(0.5 * half * cell_);
    std::array<Choice, kLane> kept;
    for (std::size_t k = 0; k < triangles.size(); ++k)
        for (std::size_t i = 0; i < kLane; ++i)
            if (view.mayBeNearest(k, i)) kept[i].push_back(triangles[k]);
    for (std::size_t i = 0; i < kLane; ++i) samplePart(first + half * cornerAt(i), kept[i]);
}

/// Nodes and cells of a part, a cube of two cells; its triangles hold the nearest one of each of its points. Nodes
/// between parts belong to the later one.
void Sampling::samplePart(const Vec3& first, const Choice& triangles) {
    const std::array<int, 3> begin{static_cast<int>(first.x()), static_cast<int>(first.y()),
                                   static_cast<int>(first.z())};
    const auto end = [&](std::size_t axis) { return begin[axis] + (begin[axis] + 2 == kCells ? 3 : 2); };
    Lanes nodes, centres;
    std::array<std::size_t, kMostLanes> place;
    for (int z = begin[2]; z < end(2); ++z)
        for (int y = begin[1]; y < end(1); ++y)
            for (int x = begin[0]; x < end(0); ++x) {
                place[nodes.count] = static_cast<std::size_t>((z * kNodes + y) * kNodes + x);
                nodes.add(low_ + cell_ * Vec3(x, y, z));
            }
    for (std::size_t c = 0; c < 8; ++c) centres.add(low_ + cell_ * (first + cornerAt(c) + Vec3::Constant(0.5)));
    const View at_nodes(triangles, nodes, false, node_scratch_);
    View at_centres(triangles, centres, true, centre_scratch_);
    at_centres.judge(0.5 * cell_);
    for (std::size_t i = 0; i < nodes.count; ++i) block_.node[place[i]] = at_nodes.least(i);
    for (std::size_t c = 0; c < 8; ++c) {
        const auto at = [&](std::size_t axis) { return static_cast<std::size_t>(begin[axis]) + (c >> axis & 1); };
        const std::size_t cell = (at(2) * kCells + at(1)) * kCells + at(0);
        block_.centre[cell] = at_centres.least(c);
        block_.slack[cell] = slackOf(triangles, at_centres, c);
    }
}

/// How little ∇φ turns in a cell.
///   Where φ has a gradient, the nearest point x(p) lies on a triangle that may be nearest. As every triangle parts
///   outside
/// from inside (where solids overlap or contain each other there are faces from which φ falls on both sides), ∇φ(p), of
/// unit length, lies in the cone of their outward normals n: one normal above a face, those of the faces that meet
/// above an edge or corner. Let m be the normalised sum of the normals and n·m ≥ cos α > 0 for all: the same holds for
/// all unit vectors of the cone, so |∇φ - m cos α|² ≤ 1 - 2 cos² α + cos² α = sin² α, and φ - (m cos α)·p has the
/// Lipschitz constant sin α.
double Sampling::slackOf(const Choice& triangles, const View& judged, std::size_t lane) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < triangles.size(); ++k)
        if (judged.mayBeNearest(k, lane)) sum += triangles[k]->normal;
    const double length = sum.norm();
    if (!(length > 0.0)) return 1.0;
    double cosine = 1.0;
    for (std::size_t k = 0; k < triangles.size(); ++k)
        if (judged.mayBeNearest(k, lane)) cosine = std::min(cosine, triangles[k]->normal.dot(sum) / length);
    if (!(cosine > 0.0)) return 1.0;
    return std::min(1.0, std::sqrt(1.0 - cosine * cosine) + kSlackRounding);
}

/// Winding numbers of the nodes of `rows1` × `rows2` lines along an axis, from that of each line's first node: less by
/// 1 behind a triangle that is left through its front, more by 1 behind one that is entered.
void Sampling::countAlong(const Choice& triangles, int axis, int rows1, int rows2) {
    const int axis1 = (axis + 1) % 3, axis2 = (axis + 2) % 3;
    const auto node = [&](int i1, int i2, int j) {
        return static_cast<std::size_t>(j * kStride[static_cast<std::size_t>(axis)] +
                                        i1 * kStride[static_cast<std::size_t>(axis1)] +
                                        i2 * kStride[static_cast<std::size_t>(axis2)]);
    };
    for (int i2 = 0; i2 < rows2; ++i2)
        for (int i1 = 0; i1 < rows1; ++i1)
            for (int j = 1; j < kNodes; ++j) winding_[node(i1, i2, j)] = winding_[node(i1, i2, 0)];
    for (const Flat* const triangle : triangles) {
        const Flat& t = *triangle;
        const auto& [a, b, c] = t.corner;
        const Vec3 low = (a.cwiseMin(b).cwiseMin(c) - lines_) / cell_;
        const Vec3 high = (a.cwiseMax(b).cwiseMax(c) - lines_) / cell_;
        if (low[axis] > kCells || high[axis] < 0.0) continue;
        const auto begin = [&](int k) { return static_cast<int>(std::clamp(std::floor(low[k]), 0.0, 1.0 * kNodes)); };
        const auto end = [&](int k, int rows) {
            return static_cast<int>(std::clamp(std::ceil(high[k]) + 1.0, 0.0, static_cast<double>(rows)));
        };
        for (int i2 = begin(axis2); i2 < end(axis2, rows2); ++i2)
            for (int i1 = begin(axis1); i1 < end(axis1, rows1); ++i1) {
                const double r1 = lines_[axis1] + cell_ * i1, r2 = lines_[axis2] + cell_ * i2;
                const bool left = isLeft(a, b, r1, r2, axis1, axis2);
                if (isLeft(b, c, r1, r2, axis1, axis2) != left || isLeft(c, a, r1, r2, axis1, axis2) != left) continue;
                const double rise = t.normal[axis1] * (r1 - a[axis1]) + t.normal[axis2] * (r2 - a[axis2]);
                const double crossing = (a[axis] - rise / t.normal[axis] - lines_[axis]) / cell_;
                // Of a triangle along the line the crossing is lost in rounding, or no number.
                const double place = crossing > low[axis] ? std::min(crossing, high[axis]) : low[axis];
                if (!(place > 0.0)) continue;
                for (int j = kCells; j > place; --j) winding_[node(i1, i2, j)] += left ? -1 : 1;
            }
    }
}

void Sampling::giveSigns(const Choice& triangles) {
    winding_[0] = static_cast<int>(std::lround(tree_.windingNumber(lines_)));
    countAlong(triangles, 2, 1, 1);
    countAlong(triangles, 1, kNodes, 1);
    countAlong(triangles, 0, kNodes, kNodes);
    const bool counted = consistent();
    for (std::size_t i = 0; i < SurfaceBlock::kAllNodes; ++i) {
        // The lines pass the nodes by.
        if (counted && !(block_.node[i] > 0.0 && block_.node[i] < 2.0 * kShift * cell_)) continue;
        const int n = static_cast<int>(i);
        winding_[i] = tree_.inside(at(n % kNodes, n / kNodes % kNodes, n / (kNodes * kNodes))) ? 1 : 0;
    }
    if (!counted) block_.slack.fill(1.0);
    for (std::size_t i = 0; i < SurfaceBlock::kAllNodes; ++i)
        if (winding_[i] > 0) block_.node[i] = -block_.node[i];
}

/// Neighbours on different sides of the surface are no farther from it, together, than from each other.
bool Sampling::consistent() const {
    const double most = cell_ * (1.0 + 4.0 * kShift);
    for (std::size_t i = 0; i < SurfaceBlock::kAllNodes; ++i)
        for (const int stride : kStride) {
            if (static_cast<int>(i) / stride % kNodes == kCells) continue;
            const std::size_t next = i + static_cast<std::size_t>(stride);
            if ((winding_[i] > 0) != (winding_[next] > 0) && block_.node[i] + block_.node[next] > most) return false;
        }
    return true;
}

}  // namespace

MeshBlockSampler::MeshBlockSampler(std::shared_ptr<const TriangleTree> tree, bool closed, bool uncrossed)
    : tree_(std::move(tree)), closed_(closed), simple_(closed && uncrossed) {
    auto flats = std::make_shared<std::vector<Flat>>();
    flats->reserve(tree_->corners().size());
    for (const auto& corners : tree_->corners()) flats->emplace_back(corners);
    flats_ = std::move(flats);
    if (!simple_) return;
    std::atomic<bool> all_walls = true;
    parallelFor(flats_->size(), [&](std::size_t i) {
        const Flat& t = (*flats_)[i];
        const Vec3 middle = (t.corner[0] + t.corner[1] + t.corner[2]) / 3.0;
        const Vec3 front = middle + kInFront * t.edge[0].norm() * t.normal;
        if (all_walls && std::lround(tree_->windingNumber(front)) != 0) all_walls = false;
    });
    simple_ = all_walls;
}

void MeshBlockSampler::sample(const Vec3& low, double cell, SurfaceBlock& block) const {
    Sampling(*tree_, *flats_, low, cell, block).run(closed_);
    if (!simple_) block.slack.fill(1.0);
}

}  // namespace passung::model
