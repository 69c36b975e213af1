#include "core/field/mesh_block_kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/field/instructions.h"

namespace passung::field {

namespace {

constexpr double kFlattest = 1e-10;  // height over longest edge of a triangle that has a normal
/// Of the way to the farthest corner and across the block: single precision makes some forty roundings (2⁻²⁴ each) of
/// it; what is taken for outside by the margin is no farther from an edge than that.
constexpr double kError = 0x1p-17;
constexpr double kMargin = 0x1p-19;
constexpr float kSupportErrors = 5.0f;  // of a support at the corners of a cube, in errors of the distance

float toFloat(double value) { return static_cast<float>(value); }

FrameEdge edgeOf(double x, double y, bool has_inside) {
    const double square = x * x + y * y;
    const double share = square > 0.0 ? 1.0 / square : 0.0, unit = has_inside ? std::sqrt(share) : 0.0;
    return {toFloat(x), toFloat(y), toFloat(x * share), toFloat(y * share), toFloat(-y * unit), toFloat(x * unit)};
}

}  // namespace

FlatTriangle::FlatTriangle(const geometry::TriangleTree::Corners& t) : corner{t.a, t.b, t.c} {
    double longest = 0.0;
    std::size_t base = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        edge[k] = corner[(k + 1) % 3] - corner[k];
        const double square = edge[k].squaredNorm();
        inverse_square[k] = square > 0.0 ? 1.0 / square : 0.0;
        if (square > longest) {
            longest = square;
            base = k;
        }
    }
    const Vec3 area = edge[0].cross(edge[1]);
    const double size = area.norm();
    normal = size > kFlattest * longest ? Vec3(area / size) : Vec3(Vec3::Zero());
    for (std::size_t k = 0; k < 3; ++k) inward[k] = normal.cross(edge[k]);

    origin = corner[base];
    length = std::sqrt(longest);
    const Vec3 u = longest > 0.0 ? Vec3(edge[base] / length) : Vec3(Vec3::UnitX());
    const Vec3 n = normal.isZero(0.0) ? u.unitOrthogonal() : normal;
    const Vec3 v = n.cross(u);
    axis = {u.cast<float>(), v.cast<float>(), n.cast<float>()};
    const Vec3 beside = corner[(base + 2) % 3] - origin;
    const double x = u.dot(beside), y = v.dot(beside);
    second = edgeOf(x - length, y, !normal.isZero(0.0));
    third = edgeOf(x, y, !normal.isZero(0.0));
}

double FlatTriangle::squaredDistance(const Vec3& p) const {
    double edges = std::numeric_limits<double>::infinity(), inside = edges;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 r = p - corner[k];
        const double along = (r[0] * edge[k][0] + r[1] * edge[k][1] + r[2] * edge[k][2]) * inverse_square[k];
        const double on = std::min(std::max(along, 0.0), 1.0);
        const double x = r[0] - on * edge[k][0], y = r[1] - on * edge[k][1], z = r[2] - on * edge[k][2];
        edges = std::min(edges, x * x + y * y + z * z);
        inside = std::min(inside, r[0] * inward[k][0] + r[1] * inward[k][1] + r[2] * inward[k][2]);
    }
    if (!(inside > 0.0)) return edges;
    const Vec3 r = p - corner[0];
    const double height = r[0] * normal[0] + r[1] * normal[1] + r[2] * normal[2];
    return height * height;
}

NearTriangle::NearTriangle(const FlatTriangle& t, const Vec3& centre, double cells_per_metre) : flat(&t) {
    const Vec3 way = (centre - t.origin) * cells_per_metre;
    const auto coordinate = [&](const Eigen::Vector3f& axis) {
        return std::array<float, 4>{axis[0], axis[1], axis[2], toFloat(axis.cast<double>().dot(way))};
    };
    u = coordinate(t.axis[0]);
    v = coordinate(t.axis[1]);
    n = coordinate(t.axis[2]);
    const float scale = toFloat(cells_per_metre), inverse = toFloat(1.0 / cells_per_metre);
    const auto scaled = [&](const FrameEdge& e) {
        return FrameEdge{scale * e.x, scale * e.y, inverse * e.share_x, inverse * e.share_y, e.inward_x, e.inward_y};
    };
    const double end = t.length * cells_per_metre;
    length = toFloat(end);
    second = scaled(t.second);
    third = scaled(t.third);
    const double size = way.norm() + end + kReach;
    error = toFloat(kError * size);
    margin = toFloat(kMargin * size);
}

namespace {

struct Seen {
    float* distance;
    float *x, *y, *z;  // from the nearest point, of unit length; null: not wanted
};

/// The nearest triangle so far of each lane. (Loops over the lanes do much at once: small ones would be unrolled before
/// they become vector instructions.)
struct Nearest {
    Group upper;  // of its distance
    std::array<std::int32_t, kLanes> triangle;

    Nearest() {
        upper.fill(std::numeric_limits<float>::infinity());
        triangle.fill(0);
    }
};

template <bool kWays>
PASSUNG_INLINE void measureOne(const NearTriangle& t, std::size_t number, const PointGroup& p, const Seen& seen,
                               Nearest& nearest) {
    const auto [ux, uy, uz, u0] = t.u;
    const auto [vx, vy, vz, v0] = t.v;
    const auto [nx, ny, nz, n0] = t.n;
    const FrameEdge s = t.second, e = t.third;
    const float length = t.length, margin = t.margin, error = t.error;
    const auto k = static_cast<std::int32_t>(number);
    const float* __restrict px = p.x.data();
    const float* __restrict py = p.y.data();
    const float* __restrict pz = p.z.data();
    float* __restrict distance = seen.distance;
    float* __restrict way_x = seen.x;
    float* __restrict way_y = seen.y;
    float* __restrict way_z = seen.z;
    float* __restrict upper = nearest.upper.data();
    std::int32_t* __restrict triangle = nearest.triangle.data();
    for (std::size_t i = 0; i < kLanes; ++i) {
        const float x = ux * px[i] + uy * py[i] + uz * pz[i] + u0;
        const float y = vx * px[i] + vy * py[i] + vz * pz[i] + v0;
        const float z = nx * px[i] + ny * py[i] + nz * pz[i] + n0;
        const float positive = x > 0.0f ? x : 0.0f;
        const float ax = x - (positive < length ? positive : length);
        const float a = ax * ax + y * y;
        const float r = x - length;
        const float s_along = r * s.share_x + y * s.share_y, s_positive = s_along > 0.0f ? s_along : 0.0f;
        const float s_on = s_positive < 1.0f ? s_positive : 1.0f;
        const float bx = r - s_on * s.x, by = y - s_on * s.y, b = bx * bx + by * by;
        const float b_side = r * s.inward_x + y * s.inward_y;
        const float e_along = x * e.share_x + y * e.share_y, e_positive = e_along > 0.0f ? e_along : 0.0f;
        const float e_on = e_positive < 1.0f ? e_positive : 1.0f;
        const float cx = x - e_on * e.x, cy = y - e_on * e.y, c = cx * cx + cy * cy;
        const float c_side = -(x * e.inward_x + y * e.inward_y);  // this edge is walked from its end
        const float ab = a < b ? a : b, abc = ab < c ? ab : c;
        const float ab_side = y < b_side ? y : b_side, side = ab_side < c_side ? ab_side : c_side;
        const float d = std::sqrt((side > margin ? 0.0f : abc) + z * z);
        distance[i] = d;
        const bool nearer = d + error < upper[i];
        upper[i] = nearer ? d + error : upper[i];
        triangle[i] = nearer ? k : triangle[i];
        if constexpr (kWays) {
            const float unit = 1.0f / (d + std::numeric_limits<float>::min());
            const float abx = a < b ? ax : bx, aby = a < b ? y : by;
            const float wx = unit * (side > margin ? 0.0f : ab < c ? abx : cx);
            const float wy = unit * (side > margin ? 0.0f : ab < c ? aby : cy), wz = unit * z;
            way_x[i] = wx * ux + wy * vx + wz * nx;
            way_y[i] = wx * uy + wy * vy + wz * ny;
            way_z[i] = wx * uz + wy * vz + wz * nz;
        }
    }
}

PASSUNG_INLINE std::uint32_t bitOf(std::size_t k) { return std::uint32_t{1} << k % 32; }

PASSUNG_INLINE void nearestAll(const Choice& triangles, const PointGroup* groups, std::size_t count,
                               std::vector<float>& scratch, Chosen& chosen) {
    const std::size_t size = triangles.size(), lanes = kLanes * count;
    scratch.resize(std::max(scratch.size(), lanes * size));
    chosen.lanes = lanes;
    chosen.words.assign((size + 31) / 32 * lanes, 0);
    float* const distances = scratch.data();
    std::array<float, kMostGroups * kLanes> upper;
    for (std::size_t g = 0; g < count; ++g) {
        Nearest nearest;
        for (std::size_t k = 0; k < size; ++k)
            measureOne<false>(*triangles[k], k, groups[g],
                              {distances + lanes * k + kLanes * g, nullptr, nullptr, nullptr}, nearest);
        std::copy(nearest.upper.begin(), nearest.upper.end(), upper.begin() + static_cast<std::ptrdiff_t>(kLanes * g));
    }
    for (std::size_t k = 0; k < size; ++k) {
        const float error = triangles[k]->error;
        const std::uint32_t bit = bitOf(k);
        const float* __restrict distance = distances + lanes * k;
        std::uint32_t* __restrict word = chosen.words.data() + k / 32 * lanes;
        for (std::size_t i = 0; i < lanes; ++i) word[i] |= distance[i] - error <= upper[i] ? bit : 0;
    }
}

PASSUNG_INLINE void judgeAll(const Choice& triangles, const PointGroup& centres, float half,
                             std::vector<float>& scratch, Chosen& cubes, Chosen& points) {
    const std::size_t size = triangles.size();
    scratch.resize(std::max(scratch.size(), 4 * kLanes * size));
    float* const all = scratch.data();
    const auto seenBy = [&](std::size_t k) {
        float* const first = all + 4 * kLanes * k;
        return Seen{first, first + kLanes, first + 2 * kLanes, first + 3 * kLanes};
    };
    Nearest nearest;
    for (std::size_t k = 0; k < size; ++k) measureOne<true>(*triangles[k], k, centres, seenBy(k), nearest);

    std::array<Group, 8> above;
    Group error;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        PointGroup corners;
        for (std::size_t i = 0; i < kLanes; ++i) {
            corners.x[i] = centres.x[lane] + (i & 1 ? half : -half);
            corners.y[i] = centres.y[lane] + (i & 2 ? half : -half);
            corners.z[i] = centres.z[lane] + (i & 4 ? half : -half);
        }
        const NearTriangle& t = *triangles[static_cast<std::size_t>(nearest.triangle[lane])];
        Group distance;
        Nearest unused;
        measureOne<false>(t, 0, corners, {distance.data(), nullptr, nullptr, nullptr}, unused);
        for (std::size_t i = 0; i < 8; ++i) above[i][lane] = distance[i];
        error[lane] = t.error;
    }

    cubes.lanes = points.lanes = kLanes;
    cubes.words.assign((size + 31) / 32 * kLanes, 0);
    points.words.assign((size + 31) / 32 * kLanes, 0);
    for (std::size_t k = 0; k < size; ++k) {
        const Seen seen = seenBy(k);
        const float of_distance = triangles[k]->error, of_support = kSupportErrors * of_distance;
        const std::uint32_t bit = bitOf(k);
        std::uint32_t* __restrict cube = cubes.words.data() + k / 32 * kLanes;
        std::uint32_t* __restrict point = points.words.data() + k / 32 * kLanes;
        for (std::size_t i = 0; i < kLanes; ++i) {
            const float x = half * seen.x[i], y = half * seen.y[i], z = half * seen.z[i];
            const float xy = x + y, yx = y - x;
            const float room0 = above[0][i] + (xy + z), room1 = above[1][i] + (yx + z);
            const float room2 = above[2][i] - (yx - z), room3 = above[3][i] - (xy - z);
            const float room4 = above[4][i] + (xy - z), room5 = above[5][i] + (yx - z);
            const float room6 = above[6][i] - (yx + z), room7 = above[7][i] - (xy + z);
            const float a = room0 > room1 ? room0 : room1, b = room2 > room3 ? room2 : room3;
            const float c = room4 > room5 ? room4 : room5, d = room6 > room7 ? room6 : room7;
            const float ab = a > b ? a : b, cd = c > d ? c : d;
            const float excess = seen.distance[i] - (ab > cd ? ab : cd);
            cube[i] |= excess - of_support <= error[i] ? bit : 0;
            point[i] |= seen.distance[i] - of_distance <= nearest.upper[i] ? bit : 0;
        }
    }
    for (std::size_t i = 0; i < kLanes; ++i) {
        const auto k = static_cast<std::size_t>(nearest.triangle[i]);
        cubes.words[k / 32 * kLanes + i] |= bitOf(k);
    }
}

using Scratch = std::vector<float>;
void nearestBaseline(const Choice& t, const PointGroup* p, std::size_t n, Scratch& s, Chosen& c) {
    nearestAll(t, p, n, s, c);
}
PASSUNG_V3 void nearestV3(const Choice& t, const PointGroup* p, std::size_t n, Scratch& s, Chosen& c) {
    nearestAll(t, p, n, s, c);
}
PASSUNG_V4 void nearestV4(const Choice& t, const PointGroup* p, std::size_t n, Scratch& s, Chosen& c) {
    nearestAll(t, p, n, s, c);
}
void judgeBaseline(const Choice& t, const PointGroup& c, float half, Scratch& s, Chosen& cubes, Chosen& points) {
    judgeAll(t, c, half, s, cubes, points);
}
PASSUNG_V3 void judgeV3(const Choice& t, const PointGroup& c, float half, Scratch& s, Chosen& cubes, Chosen& points) {
    judgeAll(t, c, half, s, cubes, points);
}
PASSUNG_V4 void judgeV4(const Choice& t, const PointGroup& c, float half, Scratch& s, Chosen& cubes, Chosen& points) {
    judgeAll(t, c, half, s, cubes, points);
}
}  // namespace

const BlockKernels& blockKernels() {
    static const BlockKernels kernels = bestInstructions() == Instructions::V4 ? BlockKernels{nearestV4, judgeV4}
                                        : bestInstructions() == Instructions::V3
                                            ? BlockKernels{nearestV3, judgeV3}
                                            : BlockKernels{nearestBaseline, judgeBaseline};
    return kernels;
}

}  // namespace passung::field
