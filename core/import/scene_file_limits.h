#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace passung::importer {

/// glTF and 3MF are read by another library, which trusts what a file says of itself. What could exhaust it is judged
/// here before: how deep a file is, what it says it holds, how often its objects stand in one another.
struct SceneFileLimits {
    static constexpr int kMostDepth = 64;          // of JSON and XML
    static constexpr double kMostInstances = 1e5;  // of objects and nodes, those in others counted each time
    static constexpr double kMostCorners = 1.5e8;  // of all triangles together, instances counted each time
    static constexpr int kMostNesting = 256;       // of objects in objects
    /// Bytes that a package of `size` bytes may hold unpacked.
    static constexpr std::uintmax_t unpacked(std::uintmax_t size) {
        return std::max(std::uintmax_t{256} << 20, 16 * size);
    }
};

/// What is wrong with a glTF file (`binary`: .glb); `sizeOf` gives the size of a file that it names, by its URI.
std::optional<Error> beyondGltfLimits(std::string_view bytes, bool binary, const std::string& file,
                                      const std::function<std::optional<std::uintmax_t>(const std::string&)>& sizeOf);

/// What is wrong with the 3MF package at `path`, of `size` bytes.
std::optional<Error> beyond3mfLimits(const std::string& path, std::uintmax_t size);

/// Objects that stand in one another.
class Nesting {
public:
    struct Object {
        double corners = 0.0;  // of its own triangles
        std::vector<std::size_t> inner;
    };
    /// The number of the object of this name, which is made if there is none.
    std::size_t number(const std::string& name);
    Object& operator[](std::size_t object) { return objects_[object]; }
    /// Why what stands in `object` is too much: it contains itself, is too deep, or holds too many.
    std::optional<std::string> tooMuch(std::size_t object) const;

private:
    std::map<std::string, std::size_t> numbers_;
    std::vector<Object> objects_;
};

}  // namespace passung::importer
