#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace passung {

/// Most bytes of a file of text or a picture that a user names.
inline constexpr std::uintmax_t kMostTextBytes = std::uintmax_t{64} << 20;

/// Most bytes of a mesh with the files that it names.
inline constexpr std::uintmax_t kMostMeshBytes = std::uintmax_t{4} << 30;

/// The whole file as bytes. It must be a regular one of at most `most_bytes`: a pipe or a device may keep its reader
/// waiting, or never end, and is not even opened. Errors: there is none that may be opened; no regular file; larger;
/// cannot be read.
Result<std::string> readRegularFile(const std::string& path, std::uintmax_t most_bytes);

/// A file of text or a picture: readRegularFile() of at most kMostTextBytes.
Result<std::string> readFile(const std::string& path);

/// Why something that exists must not be opened as a file: it is a pipe, a device, a socket, a folder or a circle of
/// links. Nothing for a regular file, and where nothing exists.
std::optional<std::string> whyNoRegularFile(const std::string& path);

}  // namespace passung
