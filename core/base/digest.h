#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace passung {

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

}  // namespace passung
