#pragma once

#include <array>
#include <cstddef>

namespace passung::model {

/// What a cube of 8³ cells sees of a surface, x fastest.
struct SurfaceBlock {
    static constexpr int kCells = 8;
    static constexpr int kNodes = kCells + 1;
    static constexpr std::size_t kAllCells = std::size_t{kCells} * kCells * kCells;
    static constexpr std::size_t kAllNodes = std::size_t{kNodes} * kNodes * kNodes;

    std::array<double, kAllNodes> node;    // φ at the nodes [m]; without a sign if the surface has no inside
    std::array<double, kAllCells> centre;  // distance from each cell's centre [m], without a sign
    /// In each cell φ differs from a linear function by one with this Lipschitz constant; 1: nothing better is known.
    std::array<double, kAllCells> slack;
};

}  // namespace passung::model
