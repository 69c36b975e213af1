#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/model/distance_field.h"
#include "core/model/point_shell.h"

namespace passung::model {

/// Keeps what took long to build from run to run: names and bytes, somewhere. What comes back is not trusted: see
/// unsealed.
class BuildStore {
public:
    virtual ~BuildStore() = default;
    /// Nothing if there is nothing of that name, or it cannot be read.
    virtual std::optional<std::string> load(const std::string& name) = 0;
    /// All of it or nothing is found later; that it could not be kept is no error.
    virtual void keep(const std::string& name, std::string_view bytes) = 0;
};

/// The name under which what `key` says is kept: letters, digits and a dot.
std::string storeName(std::string_view key);

/// Content with its key, length and a checksum over all.
std::string sealed(std::string_view key, std::string_view content);

/// The content of what sealed() made for the same key; nothing if a bit is wrong, missing or too many, or if the key is
/// another one.
std::optional<std::string_view> unsealed(std::string_view key, std::string_view bytes);

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
    std::uint64_t take(int bytes);
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

/// A point shell as bytes and back, the same bits; nothing if the bytes hold no shell.
std::string toBytes(const PointShell& shell);
std::optional<PointShell> shellFrom(std::string_view bytes);

}  // namespace passung::model
