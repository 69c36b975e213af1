#pragma once

#include "tests/bench/contact_rows.h"

namespace passung::bench {

inline constexpr const char* kBoreGroup = "bore 10 mm, peg 9.9 mm";
inline constexpr const char* kDefectGroup = "bunny with defects";

/// Fields of hard parts against exact truth.
///   Bore: points within 0.2 mm of the plate's surface, a third of them at the bore's rims, against the closed form;
///   `contacts_mean` counts, of 6 000 points of a peg in the bore's middle, those that the field takes for inside.
///   Defects: `wrong_signs_percent` of points 1-20 mm from the intact surface, against its ray parity.
/// Errors: a part cannot be built.
Result<std::vector<Row>> partRows(const geometry::TriangleMesh& bunny, const Extent& extent);

}  // namespace passung::bench
