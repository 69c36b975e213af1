#pragma once

#include <string>

#include "core/base/result.h"
#include "core/scene/scene_spec.h"

namespace passung::cli {

/// A part named on the command line: a mesh file, or a .toml file with one [[part]]. `unit`: "m", "cm", "mm", "um" or
/// "in", for files that say none.
Result<scene::PartSpec> partArgument(const std::string& path, const std::string& unit);

}  // namespace passung::cli
