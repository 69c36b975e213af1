#include "core/base/bytes.h"

#include <bit>

namespace passung {

void ByteWriter::put(double value) { put(std::bit_cast<std::uint64_t>(value), 8); }

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

}  // namespace passung
