#include <algorithm>
#include <cmath>

#include "core/field/distance_field.h"

/// How fast the values of a field change from place to place.
namespace passung::field {

namespace {

constexpr double kDiagonal = 1.7320508075688775;  // √3
constexpr double kMoreThanRounding = 1.0 + 1e-6;
// Next to sample(), sampleMany is off by this much of the span of a brick's values, and of a value.
constexpr double kSpanShare = 0x1p-20, kValueShare = 0x1p-23;
constexpr double kFacesCrossed = 3.0;  // on a way that is shorter than a brick

/// The sign that all of some values have, 0 if they do not agree, and the least of their sizes.
struct Common {
    int sign = 0;
    double least = 0.0;
    bool any = false;

    void add(double value) noexcept {
        const int here = value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
        sign = !any || sign == here ? here : 0;
        least = any ? std::min(least, std::abs(value)) : std::abs(value);
        any = true;
    }
    double size() const noexcept { return sign == 0 ? 0.0 : least; }
};

}  // namespace

/// The corners of a cell of the coarse grid.
template <class Take>
void DistanceField::takeCorners(const std::array<int, 3>& cell, Take take) const {
    for (int k = 0; k < 8; ++k)
        take(static_cast<double>(coarse_[coarseNode(cell[0] + (k & 1), cell[1] + (k >> 1 & 1), cell[2] + (k >> 2))]));
}

/// The nodes of a brick on the face, edge or corner towards `side`, per axis -1, 0 or 1.
template <class Take>
void DistanceField::takeBorder(std::size_t brick, const std::array<int, 3>& side, Take take) const {
    std::array<int, 3> low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = side[axis] > 0 ? kBrickCells : 0;
        high[axis] = side[axis] < 0 ? 0 : kBrickCells;
    }
    for (int z = low[2]; z <= high[2]; ++z)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int x = low[0]; x <= high[0]; ++x) {
                const auto node =
                    (static_cast<std::size_t>(z) * kBrickNodes + static_cast<std::size_t>(y)) * kBrickNodes +
                    static_cast<std::size_t>(x);
                take(bricks_[brick].low + bricks_[brick].step * samples_[brick * kBrickSamples + node]);
            }
}

/// The least size of what is read outside the bricks and on their border, if each connected part of that has one sign.
double DistanceField::leastOutsideBricks() const {
    double least = brick_edge_;
    const auto isInGrid = [&](const std::array<int, 3>& cell) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (cell[axis] < 0 || cell[axis] >= coarse_cells_[axis]) return false;
        return true;
    };
    std::array<int, 3> cell;
    for (cell[2] = 0; cell[2] < coarse_cells_[2]; ++cell[2])
        for (cell[1] = 0; cell[1] < coarse_cells_[1]; ++cell[1])
            for (cell[0] = 0; cell[0] < coarse_cells_[0]; ++cell[0]) {
                const std::int32_t brick = brick_of_cell_[coarseCell(cell[0], cell[1], cell[2])];
                bool at_border = false;
                if (brick < 0) {
                    Common corners;
                    takeCorners(cell, [&](double value) { corners.add(value); });
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        at_border = at_border || cell[axis] == 0 || cell[axis] + 1 == coarse_cells_[axis];
                    if (at_border && corners.sign < 0) return 0.0;  // beyond, the distance to the box is read
                    least = std::min(least, corners.size());
                    continue;
                }
                for (int k = 0; k < 27; ++k) {
                    const std::array<int, 3> side{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
                    const std::array<int, 3> beside{cell[0] + side[0], cell[1] + side[1], cell[2] + side[2]};
                    if (!isInGrid(beside)) return 0.0;
                    if (brick_of_cell_[coarseCell(beside[0], beside[1], beside[2])] >= 0) continue;
                    Common border;
                    takeBorder(static_cast<std::size_t>(brick), side, [&](double value) { border.add(value); });
                    takeCorners(beside, [&](double value) { border.add(value); });
                    least = std::min(least, border.size());
                }
            }
    return least;
}

void DistanceField::measureChange() {
    const bool of_one_size =
        std::all_of(bricks_.begin(), bricks_.end(), [](const Brick& b) { return b.level == 0 && !b.refined; });
    if (!bound_proven_ || !of_one_size) return;
    double step = 0.0;
    for (const Brick& brick : bricks_) step = std::max(step, brick.step);
    change_.within = leastOutsideBricks();
    change_.steepest = kDiagonal * (1.0 + step / largest_cell_) * kMoreThanRounding;
    change_.jump =
        kFacesCrossed * step + 2.0 * (kSpanShare * 65535.0 * step + kValueShare * change_.within) + 2.0 * arithmetic_;
}

}  // namespace passung::field
