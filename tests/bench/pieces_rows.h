#pragma once

#include "tests/bench/contact_rows.h"

namespace passung::bench {

inline constexpr const char* kPiecesGroup = "pieces";

/// What a query is made of, timed by Google Benchmark: one point by mode, the proven bound, one visited node of the
/// tree with the points tested for it, and the steps of a build. Times only: these pieces err as the rows of the
/// whole say. Errors: a part cannot be built.
Result<std::vector<Row>> piecesRows(const ContactScene& scene, const Extent& extent);

}  // namespace passung::bench
