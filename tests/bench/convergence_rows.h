#pragma once

#include "tests/bench/contact_rows.h"

namespace passung::bench {

inline constexpr const char* kConvergenceGroup = "order of convergence";
inline constexpr const char* kCellOnSmooth = "field by cell, smooth";
inline constexpr const char* kCellAtEdges = "field by cell, edges, not refined";
inline constexpr const char* kSpacingOnSmooth = "shell by spacing, smooth";
inline constexpr const char* kSpacingAtEdges = "shell by spacing, obstacle's edge";

/// How fast errors fall when the resolution h is halved, against closed forms; `order` is log2 of the ratio of two
/// errors, a mean over three resolutions. Derived:
///   Trilinear value of a function with second derivatives M: |error| ≤ 3/8 M h², thus order 2 on smooth surfaces. At
///   an edge the gradient of φ turns within one cell: error of order h, order 1. Points s apart on a ball of radius R
///   pressed onto a face: the depth falls as d² / 2R with the distance d from the deepest point, so the surface that is
///   off by less than e has an area ~ R e; there lies one point if that is ~ s², thus e ~ s² / R, order 2. On an
///   obstacle's edge the depth has a kink across it: it falls as |x| + y² / 2R, the area is ~ e sqrt(R e), thus e ~
///   s^(4/3) R^(-1/3), order 4/3 (1 on an edge as straight as the obstacle's).
/// The mean error over many points or poses decides, since the largest depends on where a sample happens to lie.
/// Errors: a part cannot be built.
Result<std::vector<Row>> convergenceRows(const Extent& extent);

}  // namespace passung::bench
