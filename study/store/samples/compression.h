#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace passung::store {

/// A zlib stream of the bytes, quickly made.
std::vector<std::byte> deflated(std::span<const std::byte> bytes);
/// The `size` bytes of a zlib stream; empty if it is damaged or holds another number.
std::vector<std::byte> inflated(std::span<const std::byte> stream, std::size_t size);

/// CRC-32 as zlib computes it (polynomial 0xEDB88320, as in gzip and PNG).
std::uint32_t crc32(std::span<const std::byte> bytes);

}  // namespace passung::store
