#pragma once

#include "core/closed_form/solid.h"

namespace passung::closed_form {

/// Bolts and nuts with their flanks as helicoids and their edges as spirals: those along the crests, and those where
/// end faces and chamfers cut ridges. All of it is exact.
///
/// Flanks touch at edges only, or hardly overlap before an edge does:
///   A flank is ruled by straight lines across it, from its crest's edge to its root. Across the other part's flank,
///   along such a line, the gap's second derivative is at most m²/k with m = lead cos α / r² (the twist of a helicoid)
///   and k = sin α / r (its bend around the axis), whatever the parts' poses; across planes, hollow cylinders and cones
///   it is not above 0. So between two places where edges keep the gap at 0 or more, w apart, it is at least
///   -(m²/k) w²/8. A flank is w = 0.625 pitch long: -0.0019 pitch⁴/r³, 0.12 µm of an M8; steeper ones must be lower
///   (ThreadForm::mostBetweenEdges). A minimum between edges needs
///   besides that the sum of both mean curvatures is positive, where facing flanks' cancel; so much was never seen.
SmoothSolid threadSolid(const shape::ThreadBolt& bolt);
SmoothSolid threadSolid(const shape::ThreadNut& nut);

}  // namespace passung::closed_form
