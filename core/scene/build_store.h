#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace passung::scene {

/// What of a part is being built, and how far it is.
struct BuildStep {
    std::string part;
    std::string what;    // "distance field, level 2"
    double share = 0.0;  // of this step; 0: not known
};

/// Keeps what took long to build from run to run: names and bytes, somewhere. What comes back is not trusted: see
/// unsealed.
class BuildStore {
public:
    virtual ~BuildStore() = default;
    /// Nothing if there is nothing of that name, or it cannot be read.
    virtual std::optional<std::string> load(const std::string& name) = 0;
    /// All of it or nothing is found later; that it could not be kept is no error.
    virtual void keep(const std::string& name, std::string_view bytes) = 0;
    /// Told while something is built, by any thread, but one at a time.
    virtual void building(const BuildStep&) {}
};

/// The name under which what `key` says is kept: letters, digits and a dot.
std::string storeName(std::string_view key);

/// Content with its key, length and a checksum over all.
std::string sealed(std::string_view key, std::string_view content);

/// The content of what sealed() made for the same key; nothing if a bit is wrong, missing or too many, or if the key is
/// another one.
std::optional<std::string_view> unsealed(std::string_view key, std::string_view bytes);

}  // namespace passung::scene
