#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace passung::store {

// Columns of values, one after the other, in an order of their bytes that packs well. A value is 4 or 8 bytes, by
// `widths`; `rows` values make a column.

/// Neighbouring ticks differ little, and so do their differences: of each column, taken as integers of its width modulo
/// 2^bits, differences are taken 0 to 3 times, as often as leaves the fewest bits; a difference d becomes 2 d, a
/// negative one -2 d - 1, so that small ones have leading zeros. What is left stands byte by byte: plane b of a column
/// holds byte b of each value. In front of the planes a byte for each column says how often differences were taken.
std::vector<std::byte> toDifferencePlanes(std::span<const std::byte> columns, std::span<const std::size_t> widths,
                                          std::size_t rows);
/// Undoes it; nothing for bytes that are no such planes.
std::optional<std::vector<std::byte>> fromDifferencePlanes(std::span<const std::byte> bytes,
                                                           std::span<const std::size_t> widths, std::size_t rows);

/// Of planes of the values themselves. @pre as many bytes as the columns have
std::vector<std::byte> fromPlanes(std::span<const std::byte> planes, std::span<const std::size_t> widths,
                                  std::size_t rows);

}  // namespace passung::store
