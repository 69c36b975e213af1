#pragma once

#include <string>

#include "core/base/result.h"
#include "core/model/scene_spec.h"

namespace passung::cli {

/// "m", "cm", "mm", "um" or "in" as metres.
Result<double> metresPerUnit(const std::string& unit);

/// A part named on the command line: a mesh file, or a .toml file with one [[part]].
Result<model::PartSpec> partArgument(const std::string& path, const std::string& unit);

}  // namespace passung::cli
