#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// A zip archive with its entries stored, not compressed: enough for a package file made by a test.
namespace passung::test {

inline std::uint32_t crc32Of(const std::string& bytes) {
    std::uint32_t crc = ~0u;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
    }
    return ~crc;
}

inline std::string storedZip(const std::vector<std::pair<std::string, std::string>>& entries) {
    std::string archive, directory;
    const auto put = [](std::string& out, std::uint32_t value, int bytes) {
        for (int k = 0; k < bytes; ++k) out += static_cast<char>(value >> (8 * k) & 255u);
    };
    for (const auto& [name, content] : entries) {
        const auto offset = static_cast<std::uint32_t>(archive.size());
        const auto length = static_cast<std::uint32_t>(content.size());
        std::string common;  // version, flags, method, time, date, CRC, two sizes, name length, extra length
        put(common, 20, 2);
        put(common, 0, 2);
        put(common, 0, 2);
        put(common, 0, 2);
        put(common, 0x21, 2);
        put(common, crc32Of(content), 4);
        put(common, length, 4);
        put(common, length, 4);
        put(common, static_cast<std::uint32_t>(name.size()), 2);
        put(common, 0, 2);
        archive += "PK\x03\x04" + common + name + content;
        directory += "PK\x01\x02";
        put(directory, 20, 2);
        directory += common;
        put(directory, 0, 2);  // comment
        put(directory, 0, 2);  // disk
        put(directory, 0, 2);  // internal attributes
        put(directory, 0, 4);  // external attributes
        put(directory, offset, 4);
        directory += name;
    }
    const auto start = static_cast<std::uint32_t>(archive.size());
    archive += directory + "PK\x05\x06";
    put(archive, 0, 4);
    put(archive, static_cast<std::uint32_t>(entries.size()), 2);
    put(archive, static_cast<std::uint32_t>(entries.size()), 2);
    put(archive, static_cast<std::uint32_t>(directory.size()), 4);
    put(archive, start, 4);
    put(archive, 0, 2);
    return archive;
}

}  // namespace passung::test
