#pragma once

#include <span>

#include "core/base/types.h"
#include "core/shell/point_shell.h"

namespace passung::shell {

struct Ball {
    Vec3 centre = Vec3::Zero();
    double radius = 0.0;
};

/// The smallest ball around the positions of `points`; its radius is 1e-12 of itself too large, so that rounding leaves
/// no point outside. @pre at least one point.
///   By pivoting (B. Gärtner, Fast and robust smallest enclosing balls, 1999): the farthest point joins the few that
/// hold the ball, and the smallest ball of these at most five decides which of them hold the next one. The radius grows
/// from step to step, so that it ends; after kMostPivots steps, which rounding could ask for, the ball still encloses
/// all points.
Ball enclosingBall(std::span<const SurfacePoint> points);
inline constexpr int kMostPivots = 64;

}  // namespace passung::shell
