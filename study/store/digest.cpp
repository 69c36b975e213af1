#include "study/store/digest.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <array>
#include <stdexcept>

#include "study/store/hex_text.h"

namespace passung::store {

std::string sha256Hex(std::string_view bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
        throw std::runtime_error("SHA-256 is not available");
    }
    return hexText(std::span(digest).first(length));
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
    const uLong start = ::crc32_z(0, nullptr, 0);
    return static_cast<std::uint32_t>(::crc32_z(start, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace passung::store
