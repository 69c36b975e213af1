#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace passung::store {

/// SHA-256 as 64 lower-case hex digits.
std::string sha256Hex(std::string_view bytes);

/// CRC-32 as zlib computes it (polynomial 0xEDB88320, as in gzip and PNG).
std::uint32_t crc32(std::span<const std::byte> bytes);

}  // namespace passung::store
