#include "core/model/build_store.h"

#include <bit>
#include <cmath>
#include <cstdio>

#include "core/base/random.h"

namespace passung::model {

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

void ByteWriter::put(double value) { put(std::bit_cast<std::uint64_t>(value), 8); }

std::uint64_t ByteReader::take(int bytes) {
    if (rest_.size() < static_cast<std::size_t>(bytes)) {
        failed_ = true;
        rest_ = {};
        return 0;
    }
    std::uint64_t value = 0;
    for (int i = bytes - 1; i >= 0; --i)
        value = value << 8 | static_cast<unsigned char>(rest_[static_cast<std::size_t>(i)]);
    rest_.remove_prefix(static_cast<std::size_t>(bytes));
    return value;
}

double ByteReader::takeDouble() { return std::bit_cast<double>(take(8)); }

Vec3 ByteReader::takeVec3() {
    const double x = takeDouble(), y = takeDouble(), z = takeDouble();
    return {x, y, z};
}

std::size_t ByteReader::takeCount(std::size_t bytes_each) {
    const std::uint64_t count = take(8);
    if (count <= rest_.size() / bytes_each) return static_cast<std::size_t>(count);
    failed_ = true;
    rest_ = {};
    return 0;
}

std::string toBytes(const PointShell& shell) {
    ByteWriter writer;
    writer.put(shell.total_area);
    writer.put(shell.cover_radius);
    writer.put(shell.rounding);
    writer.put(shell.points.size(), 8);
    for (const SurfacePoint& point : shell.points) {
        writer.put(point.position);
        writer.put(point.normal);
        writer.put(point.area);
        writer.put(point.triangle, 4);
    }
    return writer.take();
}

std::optional<PointShell> shellFrom(std::string_view bytes) {
    ByteReader reader(bytes);
    PointShell shell;
    shell.total_area = reader.takeDouble();
    shell.cover_radius = reader.takeDouble();
    shell.rounding = reader.takeDouble();
    shell.points.resize(reader.takeCount(60));
    bool sound = std::isfinite(shell.total_area);
    for (const double length : {shell.cover_radius, shell.rounding})
        sound = sound && length >= 0.0 && std::isfinite(length);
    for (SurfacePoint& point : shell.points) {
        point.position = reader.takeVec3();
        point.normal = reader.takeVec3();
        point.area = reader.takeDouble();
        point.triangle = static_cast<std::uint32_t>(reader.take(4));
        sound = sound && point.position.allFinite() && std::abs(point.normal.norm() - 1.0) < 1e-6 &&
                point.area >= 0.0 && std::isfinite(point.area);
    }
    if (!sound || !reader.atEnd() || shell.points.empty()) return std::nullopt;
    return shell;
}

}  // namespace passung::model
