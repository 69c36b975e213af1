#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/types.h"

namespace passung {

/// Little-endian bytes of numbers.
class ByteWriter {
public:
    void put(std::uint64_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) bytes_.push_back(static_cast<char>(value >> (8 * i) & 0xffu));
    }
    void put(double value);
    void put(const Vec3& value) {
        for (const double coordinate : value) put(coordinate);
    }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

/// Reads them back. Behind the end everything is 0 and `failed` is true.
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : rest_(bytes) {}
    std::uint64_t take(int bytes) {
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
    double takeDouble();
    Vec3 takeVec3();
    /// A number of items that take at least `bytes_each` bytes; fails if there are not so many left.
    std::size_t takeCount(std::size_t bytes_each);
    bool failed() const { return failed_; }
    bool atEnd() const { return rest_.empty() && !failed_; }

private:
    std::string_view rest_;
    bool failed_ = false;
};

}  // namespace passung
