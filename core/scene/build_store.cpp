#include "core/scene/build_store.h"

#include <cstdint>
#include <cstdio>

#include "core/base/bytes.h"
#include "core/base/random.h"

namespace passung::scene {

namespace {

constexpr std::string_view kMagic = "passung build 1\n";

std::string littleEndian(std::uint64_t value) {
    ByteWriter writer;
    writer.put(value, 8);
    return writer.take();
}

/// FNV-1a takes a byte at a time; fields are tens of megabytes. The same steps on words of eight bytes, and on the
/// rest.
std::uint64_t checksum(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    ByteReader reader(bytes);
    for (std::size_t i = 0; i + 8 <= bytes.size(); i += 8) {
        hash = (hash ^ reader.take(8)) * 0x100000001b3u;
        hash ^= hash >> 32;  // else the upper half of a word would reach the lower bits of the sum nowhere
    }
    return hash ^ fnv1a64(bytes.substr(bytes.size() / 8 * 8));
}

}  // namespace

std::string storeName(std::string_view key) {
    char text[32];
    std::snprintf(text, sizeof text, "%016llx.build", static_cast<unsigned long long>(fnv1a64(key)));
    return text;
}

std::string sealed(std::string_view key, std::string_view content) {
    std::string bytes;
    bytes.reserve(kMagic.size() + 24 + key.size() + content.size());
    bytes.append(kMagic).append(littleEndian(key.size())).append(littleEndian(content.size()));
    bytes.append(key).append(content);
    return bytes.append(littleEndian(checksum(bytes)));
}

std::optional<std::string_view> unsealed(std::string_view key, std::string_view bytes) {
    const std::size_t head = kMagic.size() + 16;
    if (bytes.size() < head + key.size() + 8 || bytes.substr(0, kMagic.size()) != kMagic) return std::nullopt;
    ByteReader lengths(bytes.substr(kMagic.size(), 16));
    if (lengths.take(8) != key.size() || lengths.take(8) != bytes.size() - head - key.size() - 8) return std::nullopt;
    if (bytes.substr(head, key.size()) != key) return std::nullopt;
    ByteReader sum(bytes.substr(bytes.size() - 8));
    if (sum.take(8) != checksum(bytes.substr(0, bytes.size() - 8))) return std::nullopt;
    return bytes.substr(head + key.size(), bytes.size() - head - key.size() - 8);
}

}  // namespace passung::scene
