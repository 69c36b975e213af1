#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace passung::field {

/// What was last read of a field at each of a shell's points: the cell around the point, and the values at its corners.
/// As long as a point stays in its cell, DistanceField::sampleKnown computes with these and the field's own memory,
/// which is far larger than a cache, is left alone; the same bits come out. Sized once. Belongs to one field.
struct CellMemory {
    explicit CellMemory(std::size_t points = 0)
        : cells(points, kUnknown),
          low(points),
          step(points),
          edge(points),
          slack(points),
          most(points),
          cell{std::vector<std::int32_t>(points), std::vector<std::int32_t>(points), std::vector<std::int32_t>(points)},
          pair{std::vector<std::uint32_t>(points), std::vector<std::uint32_t>(points),
               std::vector<std::uint32_t>(points), std::vector<std::uint32_t>(points)} {}

    static constexpr float kUnknown = 0.0f;

    std::vector<float> cells;                         // of this size along a largest brick; or kUnknown
    std::vector<float> low, step, edge, slack, most;  // of the brick: see DistanceField
    std::array<std::vector<std::int32_t>, 3> cell;    // counted from the corner of the largest brick
    std::array<std::vector<std::uint32_t>, 4> pair;   // two neighbours along x each
};

}  // namespace passung::field
