#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/field/distance_field.h"

namespace passung::field {

namespace {

static_assert(std::endian::native == std::endian::little);  // two numbers are read as one word

constexpr std::size_t kBlock = 64;
constexpr std::size_t kSmallIndex = 4096;

template <class Number>
using Lane = std::array<Number, kBlock>;

/// 1 or 0 without a jump, which would keep a loop from becoming vector instructions.
PASSUNG_INLINE int isWithin(double value, double low, double high) {
    return static_cast<int>(value >= low) & static_cast<int>(value < high);
}

constexpr float kFloatSlackUnit = 1.0f / 255.0f * (1.0f + 0x1p-20f);
/// More than single precision adds to a value of a brick, in steps, with the half step of storing it.
constexpr float kStepMargin = 0.6f;
/// What some roundings in single precision change a number by, relatively.
constexpr float kMore = 1.0f + 0x1p-19f, kLess = 1.0f - 0x1p-19f;

}  // namespace

/// Some points as arrays, so that plain loops over them become vector instructions.
struct DistanceField::Block {
    std::array<Lane<double>, 3> place;  // in largest bricks
    Lane<std::int32_t> cube;            // of the index
    Lane<std::int32_t> outside;
    Lane<std::int32_t> brick;
    Lane<Head> head;
    Lane<float> low, step;
    Lane<float> slack, most, edge;  // for bounds
    std::array<Lane<float>, 3> u;
    Lane<std::int32_t> node;
    std::array<Lane<std::uint32_t>, 4> pair;  // two neighbours along x each

    /// Where each point lies, and in which cube of the index.
    PASSUNG_INLINE void placeAll(const Placement& m, const float* x, const float* y, const float* z,
                                 std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const double px = static_cast<double>(x[i]), py = static_cast<double>(y[i]), pz = static_cast<double>(z[i]);
            const double gx = m.turn[0] * px + m.turn[1] * py + m.turn[2] * pz + m.shift[0];
            const double gy = m.turn[3] * px + m.turn[4] * py + m.turn[5] * pz + m.shift[1];
            const double gz = m.turn[6] * px + m.turn[7] * py + m.turn[8] * pz + m.shift[2];
            // A comparison with a NaN is false: such a point is outside too.
            const int in_x = isWithin(gx, m.low[0], m.high[0]);
            const int in_y = isWithin(gy, m.low[1], m.high[1]);
            const int in_z = isWithin(gz, m.low[2], m.high[2]);
            const double sx = in_x != 0 ? gx : m.low[0], sy = in_y != 0 ? gy : m.low[1], sz = in_z != 0 ? gz : m.low[2];
            place[0][i] = sx;
            place[1][i] = sy;
            place[2][i] = sz;
            const auto cx = static_cast<std::int32_t>(sx * m.cubes) - m.first[0];
            const auto cy = static_cast<std::int32_t>(sy * m.cubes) - m.first[1];
            const auto cz = static_cast<std::int32_t>(sz * m.cubes) - m.first[2];
            cube[i] = cz * m.slab + cy * m.row + cx;
            outside[i] = 1 - (in_x & in_y & in_z);
        }
    }

    /// The cell of each point and the place in it.
    PASSUNG_INLINE void cellAll(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const double cells = static_cast<double>(std::abs(head[i].cells));
            const double fx = place[0][i] * cells, fy = place[1][i] * cells, fz = place[2][i] * cells;
            const auto cx = static_cast<std::int32_t>(fx), cy = static_cast<std::int32_t>(fy),
                       cz = static_cast<std::int32_t>(fz);
            low[i] = head[i].low;
            step[i] = head[i].step;
            u[0][i] = static_cast<float>(fx - cx);
            u[1][i] = static_cast<float>(fy - cy);
            u[2][i] = static_cast<float>(fz - cz);
            constexpr std::int32_t kIn = kBrickCells - 1, kRow = kBrickNodes;
            node[i] = head[i].first + ((cz & kIn) * kRow + (cy & kIn)) * kRow + (cx & kIn);
        }
    }

    /// The number stored at a corner of a point's cell, on the left or on the right of a pair.
    PASSUNG_INLINE float left(std::size_t k, std::size_t i) const {
        return static_cast<float>(static_cast<std::int32_t>(pair[k][i] & 0xffffu));
    }
    PASSUNG_INLINE float right(std::size_t k, std::size_t i) const {
        return static_cast<float>(static_cast<std::int32_t>(pair[k][i] >> 16));
    }

    /// Between eight corners, along x, y, z.
    PASSUNG_INLINE static float between(const std::array<float, 8>& c, float x, float y, float z) {
        const float x00 = c[0] + x * (c[1] - c[0]), x10 = c[2] + x * (c[3] - c[2]);
        const float x01 = c[4] + x * (c[5] - c[4]), x11 = c[6] + x * (c[7] - c[6]);
        const float y0 = x00 + y * (x10 - x00), y1 = x01 + y * (x11 - x01);
        return y0 + z * (y1 - y0);
    }

    PASSUNG_INLINE std::array<float, 8> corners(std::size_t i) const {
        return {left(0, i), right(0, i), left(1, i), right(1, i), left(2, i), right(2, i), left(3, i), right(3, i)};
    }

    PASSUNG_INLINE void interpolateAll(float* phi, std::size_t count) const {
        for (std::size_t i = 0; i < count; ++i)
            phi[i] = low[i] + step[i] * between(corners(i), u[0][i], u[1][i], u[2][i]);
    }

    /// As lowerBound(): near the surface and far from it.
    PASSUNG_INLINE void boundAll(float offset, float arithmetic, float within, float* bound, std::size_t count) const {
        for (std::size_t i = 0; i < count; ++i) {
            const float x = u[0][i], y = u[1][i], z = u[2][i];
            const std::array<float, 8> c = corners(i);
            const float spread = edge[i] * edge[i] * (x * (1.0f - x) + y * (1.0f - y) + z * (1.0f - z)) * kMore;
            const float margin = kStepMargin * step[i] + arithmetic;
            const float value = low[i] + step[i] * between(c, x, y, z);
            const float size = value < 0.0f ? -value : value;
            const float by_slack = slack[i] * std::sqrt(spread);
            const float most_here = size <= within ? most[i] : by_slack;
            const float near =
                value - (by_slack < most_here ? by_slack : most_here) * kMore - margin - size * (1.0f - kLess);
            const float zero = low[i] + offset - margin;
            std::array<float, 8> square;
            for (std::size_t k = 0; k < 8; ++k) {
                const float d = zero + step[i] * c[k];
                const float outside_only = d > 0.0f ? d : 0.0f;
                square[k] = outside_only * outside_only;
            }
            const float rest = between(square, x, y, z) * kLess - spread;
            const float far = std::sqrt(rest > 0.0f ? rest : 0.0f) * kLess - offset - margin;
            bound[i] = rest > 0.0f && far > near ? far : near;
        }
    }

    /// The octant of the brick around a point, with so many half bricks along a largest one.
    PASSUNG_INLINE std::size_t octant(std::size_t i, double halves) const {
        const auto bit = [&](std::size_t axis) {
            return static_cast<unsigned>(static_cast<std::int32_t>(place[axis][i] * halves)) & 1u;
        };
        return bit(0) | bit(1) << 1 | bit(2) << 2;
    }

    /// The smallest brick of each point; where the index knows none the point is left to sample().
    template <bool kBounds>
    PASSUNG_INLINE void brickAll(const DistanceField& field, std::size_t count) {
        const float largest_brick = static_cast<float>(field.largest_cell_ * kBrickCells);
        // Points of a surface lie in bricks far apart in memory: what is needed of many is fetched at once.
        for (std::size_t i = 0; i < count; ++i)
            __builtin_prefetch(&field.index_.brick[static_cast<std::size_t>(cube[i])]);
        for (std::size_t i = 0; i < count; ++i) {
            const std::int32_t found = field.index_.brick[static_cast<std::size_t>(cube[i])];
            outside[i] |= found < 0;
            brick[i] = std::max(found, 0);
            __builtin_prefetch(&field.heads_[static_cast<std::size_t>(brick[i])]);
        }
        for (std::size_t i = 0; i < count; ++i) {
            auto k = static_cast<std::size_t>(brick[i]);
            head[i] = field.heads_[k];
            if (head[i].cells < 0.0f) {
                while (field.bricks_[k].refined) {
                    const double halves = static_cast<double>(2 << field.bricks_[k].level);
                    const std::int32_t child = field.bricks_[k].child[octant(i, halves)];
                    if (child < 0) break;
                    k = static_cast<std::size_t>(child);
                }
                head[i] = field.heads_[k];
            }
            if constexpr (kBounds) {
                const float cells = std::abs(head[i].cells);  // a power of two times those of a largest brick
                const float held = static_cast<float>(field.slacks_[k][octant(i, 0.25 * static_cast<double>(cells))]) *
                                   kFloatSlackUnit;
                edge[i] = largest_brick / cells;
                slack[i] = field.bounded_within_ >= 0.0 ? 1.0f : held;
                most[i] = field.bounded_within_ >= 0.0 ? held * held * edge[i] : std::numeric_limits<float>::infinity();
            }
        }
    }

    PASSUNG_INLINE void pairAll(const std::uint16_t* samples, std::size_t count) {
        constexpr std::size_t kRow = kBrickNodes, kSlab = kRow * kBrickNodes;
        for (std::size_t i = 0; i < count; ++i) {
            __builtin_prefetch(samples + node[i]);
            __builtin_prefetch(samples + node[i] + kSlab);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint16_t* at = samples + node[i];
            std::memcpy(&pair[0][i], at, sizeof(std::uint32_t));
            std::memcpy(&pair[1][i], at + kRow, sizeof(std::uint32_t));
            std::memcpy(&pair[2][i], at + kSlab, sizeof(std::uint32_t));
            std::memcpy(&pair[3][i], at + kSlab + kRow, sizeof(std::uint32_t));
        }
    }

    PASSUNG_INLINE bool anyOutside(std::size_t count) const {
        std::int32_t any = 0;
        for (std::size_t i = 0; i < count; ++i) any |= outside[i];
        return any != 0;
    }

    template <bool kBounds>
    PASSUNG_INLINE static void runAll(const DistanceField& field, const Placement& S, const float* x, const float* y,
                                      const float* z, float* result, std::size_t total) {
        const auto offset = static_cast<float>(field.sheet_offset_) * kMore;
        const auto arithmetic = static_cast<float>(2.0 * field.arithmetic_);
        const auto within = static_cast<float>(field.bounded_within_);
        Block block;
        for (std::size_t start = 0; start < total; start += kBlock) {
            const std::size_t count = std::min(kBlock, total - start);
            block.placeAll(S, x + start, y + start, z + start, count);
            block.brickAll<kBounds>(field, count);
            block.cellAll(count);
            block.pairAll(field.samples_.data(), count);
            if constexpr (kBounds)
                block.boundAll(offset, arithmetic, within, result + start, count);
            else
                block.interpolateAll(result + start, count);
            if (!block.anyOutside(count)) continue;
            for (std::size_t i = 0; i < count; ++i) {
                if (block.outside[i] == 0) continue;
                const Vec3 p_F = S.X_FS * Vec3(static_cast<double>(x[start + i]), static_cast<double>(y[start + i]),
                                               static_cast<double>(z[start + i]));
                result[start + i] = kBounds ? below(field.lowerBound(p_F))
                                            : static_cast<float>(field.sample(p_F, FieldMode::Trilinear).phi);
            }
        }
    }

    /// The largest float that is not above a number.
    static float below(double value) {
        const auto rounded = static_cast<float>(value);
        return static_cast<double>(rounded) > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity())
                                                    : rounded;
    }

    using Run = void (*)(const DistanceField&, const Placement&, const float*, const float*, const float*, float*,
                         std::size_t);
    template <bool kBounds>
    static void baseline(const DistanceField& f, const Placement& S, const float* x, const float* y, const float* z,
                         float* result, std::size_t count) {
        runAll<kBounds>(f, S, x, y, z, result, count);
    }
    template <bool kBounds>
    PASSUNG_V3 static void v3(const DistanceField& f, const Placement& S, const float* x, const float* y,
                              const float* z, float* result, std::size_t count) {
        runAll<kBounds>(f, S, x, y, z, result, count);
    }
    template <bool kBounds>
    PASSUNG_V4 static void v4(const DistanceField& f, const Placement& S, const float* x, const float* y,
                              const float* z, float* result, std::size_t count) {
        runAll<kBounds>(f, S, x, y, z, result, count);
    }
    template <bool kBounds>
    static Run runWith(Instructions instructions) {
        return instructions == Instructions::V4   ? v4<kBounds>
               : instructions == Instructions::V3 ? v3<kBounds>
                                                  : baseline<kBounds>;
    }
};

DistanceField::Placement DistanceField::place(const Pose& X_FS) const noexcept {
    Placement S{};
    S.X_FS = X_FS;
    S.cubes = static_cast<double>(1 << index_.level);
    const Mat3 turn = X_FS.q.toRotationMatrix() * inverse_brick_edge_;
    const Vec3 shift = (X_FS.p - origin_) * inverse_brick_edge_;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        for (std::size_t b = 0; b < 3; ++b) S.turn[3 * a + b] = turn(axis, static_cast<Eigen::Index>(b));
        S.shift[a] = shift[axis];
        S.first[a] = index_.low[a];
        S.low[a] = index_.low[a] / S.cubes;
        S.high[a] = (index_.low[a] + index_.size[a]) / S.cubes;
    }
    S.row = index_.size[0];
    S.slab = index_.size[0] * index_.size[1];
    return S;
}

void DistanceField::sampleMany(const Placement& S, std::span<const float> x, std::span<const float> y,
                               std::span<const float> z, std::span<float> phi,
                               Instructions instructions) const noexcept {
    Block::runWith<false>(instructions)(*this, S, x.data(), y.data(), z.data(), phi.data(), phi.size());
}

void DistanceField::lowerBounds(const Placement& S, std::span<const float> x, std::span<const float> y,
                                std::span<const float> z, std::span<float> bound,
                                Instructions instructions) const noexcept {
    if (bound_proven_) {
        Block::runWith<true>(instructions)(*this, S, x.data(), y.data(), z.data(), bound.data(), bound.size());
        return;
    }
    for (std::size_t i = 0; i < bound.size(); ++i)
        bound[i] = Block::below(
            lowerBound(S.X_FS * Vec3(static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i]))));
}

void DistanceField::fillIndex() {
    heads_.clear();
    heads_.reserve(bricks_.size());
    for (std::size_t k = 0; k < bricks_.size(); ++k) {
        const Brick& brick = bricks_[k];
        const auto cells = static_cast<float>(kBrickCells << brick.level);
        heads_.push_back({static_cast<float>(brick.low), static_cast<float>(brick.step),
                          static_cast<std::int32_t>(k * kBrickSamples), brick.refined ? -cells : cells});
    }
    std::array<int, 3> low = coarse_cells_, high{};  // of the largest bricks
    for (int z = 0; z < coarse_cells_[2]; ++z)
        for (int y = 0; y < coarse_cells_[1]; ++y)
            for (int x = 0; x < coarse_cells_[0]; ++x) {
                if (brick_of_cell_[coarseCell(x, y, z)] < 0) continue;
                const std::array<int, 3> place{x, y, z};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    low[axis] = std::min(low[axis], place[axis]);
                    high[axis] = std::max(high[axis], place[axis] + 1);
                }
            }
    int deepest = 0;
    for (const Brick& brick : bricks_) deepest = std::max(deepest, static_cast<int>(brick.level));
    const auto cubesAt = [&](int level) {
        std::size_t cubes = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) cubes *= static_cast<std::size_t>(high[axis] - low[axis]) << level;
        return cubes;
    };
    const std::size_t most = std::max(kSmallIndex, kIndexPerBrick * bricks_.size());
    index_.level = 0;
    while (index_.level < deepest && cubesAt(index_.level + 1) <= most) ++index_.level;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        index_.low[axis] = low[axis] << index_.level;
        index_.size[axis] = (high[axis] - low[axis]) << index_.level;
    }
    index_.brick.assign(cubesAt(index_.level), -1);
    for (int z = low[2]; z < high[2]; ++z)
        for (int y = low[1]; y < high[1]; ++y)
            for (int x = low[0]; x < high[0]; ++x)
                if (const std::int32_t root = brick_of_cell_[coarseCell(x, y, z)]; root >= 0)
                    indexBrick(root, {x, y, z});
}

/// Enters a brick, or those that replace it; `place` in edges of its level, from the corner of the coarse grid.
void DistanceField::indexBrick(std::int32_t id, const std::array<int, 3>& place) {
    const Brick& brick = bricks_[static_cast<std::size_t>(id)];
    const int finer = index_.level - brick.level;
    if (finer == 0 || !brick.refined) return enterIndex(id, place, finer);
    for (std::size_t octant = 0; octant < 8; ++octant) {
        const std::array<int, 3> half{2 * place[0] + static_cast<int>(octant & 1),
                                      2 * place[1] + static_cast<int>(octant >> 1 & 1),
                                      2 * place[2] + static_cast<int>(octant >> 2)};
        if (brick.child[octant] >= 0)
            indexBrick(brick.child[octant], half);
        else
            enterIndex(id, half, finer - 1);
    }
}

/// Enters `id` in all cubes of the one at `place`, which is `finer` levels above those of the index.
void DistanceField::enterIndex(std::int32_t id, const std::array<int, 3>& place, int finer) {
    const int cubes = 1 << finer;
    std::array<int, 3> start{};
    for (std::size_t axis = 0; axis < 3; ++axis) start[axis] = place[axis] * cubes - index_.low[axis];
    for (int z = 0; z < cubes; ++z)
        for (int y = 0; y < cubes; ++y) {
            const auto first = (static_cast<std::size_t>(start[2] + z) * static_cast<std::size_t>(index_.size[1]) +
                                static_cast<std::size_t>(start[1] + y)) *
                                   static_cast<std::size_t>(index_.size[0]) +
                               static_cast<std::size_t>(start[0]);
            std::fill_n(index_.brick.begin() + static_cast<std::ptrdiff_t>(first), cubes, id);
        }
}

}  // namespace passung::field
