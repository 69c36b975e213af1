#pragma once

#include "core/surface/hull_distance.h"

namespace passung::surface {

/// The nearest points of the held part at `X` and the obstacles, face by face. Nothing as near as `within` [m]: that is
/// the distance told, and there are no points. For preparing, not for the tick.
NearestHulls nearestFaces(const ClusterTree& held, const ClusterTree& obstacles, const Pose& X, double within = 1e300);

}  // namespace passung::surface
