#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace passung::field {

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
    /// The numbers of the triangles that may be nearest to some point of a cell: those of all cells, and where each
    /// cell's begin and end; empty where the source has none.
    std::vector<std::uint32_t> triangles;
    std::array<std::uint32_t, kAllCells> first{}, last{};

    std::span<const std::uint32_t> trianglesOf(std::size_t cell) const {
        return std::span(triangles).subspan(first[cell], last[cell] - first[cell]);
    }
};

}  // namespace passung::field
