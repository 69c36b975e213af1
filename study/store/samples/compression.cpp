#include "study/store/samples/compression.h"

#include <zlib.h>

#include <stdexcept>

namespace passung::store {

std::vector<std::byte> deflated(std::span<const std::byte> bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::vector<std::byte> stream(size);
    const int result = compress2(reinterpret_cast<Bytef*>(stream.data()), &size,
                                 reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 1);
    if (result != Z_OK) throw std::runtime_error("zlib cannot pack the samples");
    stream.resize(size);
    return stream;
}

std::vector<std::byte> inflated(std::span<const std::byte> stream, std::size_t size) {
    std::vector<std::byte> bytes(size);
    uLongf found = static_cast<uLongf>(size);
    const int result = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &found,
                                  reinterpret_cast<const Bytef*>(stream.data()), static_cast<uLong>(stream.size()));
    if (result != Z_OK || found != size) bytes.clear();
    return bytes;
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
    const uLong start = ::crc32_z(0, nullptr, 0);
    return static_cast<std::uint32_t>(::crc32_z(start, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace passung::store
