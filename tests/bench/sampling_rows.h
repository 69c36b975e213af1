#pragma once

#include "tests/bench/contact_rows.h"

namespace passung::bench {

inline constexpr const char* kSamplingGroup = "sampling 131072 surface points";
inline constexpr const char* kFlatArray = "flat array";
inline constexpr const char* kBuildGroup = "building the bunny's field";
inline constexpr const char* kVdbBuild = "OpenVDB level set";

/// Sampling at points of the bunny's surface in Morton order through a rigid transform (the truth there is 0), and
/// building the field: ours beside OpenVDB at the same cell, which is 1/256 of the longest side.
/// Errors: a field cannot be built.
Result<std::vector<Row>> samplingRows(const geometry::TriangleMesh& bunny, const Extent& extent);

}  // namespace passung::bench
