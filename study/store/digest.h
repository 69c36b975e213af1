#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace passung::store {

/// SHA-256 as 64 lower-case hex digits.
std::string sha256Hex(std::string_view bytes);

/// The same of bytes that come one after another; throws if it is not available.
class Sha256 {
public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;

    void update(std::string_view bytes);
    std::string hex();  // ends it

private:
    void* context_;
};

/// The same of a file's bytes; throws if it cannot be read.
std::string sha256OfFile(const std::string& path);

/// So many random bytes of the system's generator, as hex digits: for what nobody may guess, never for data.
std::string randomHex(std::size_t bytes);

/// A zlib stream of the bytes, quickly made.
std::vector<std::byte> deflated(std::span<const std::byte> bytes);
/// The `size` bytes of a zlib stream; empty if it is damaged or holds another number.
std::vector<std::byte> inflated(std::span<const std::byte> stream, std::size_t size);

/// CRC-32 as zlib computes it (polynomial 0xEDB88320, as in gzip and PNG).
std::uint32_t crc32(std::span<const std::byte> bytes);

}  // namespace passung::store
