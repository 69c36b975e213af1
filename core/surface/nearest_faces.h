#pragma once

#include "core/surface/hull_distance.h"

namespace passung::surface {

/// The nearest points of the held part at `X` and the obstacles, face by face. For preparing, not for the tick.
NearestHulls nearestFaces(const ClusterTree& held, const ClusterTree& obstacles, const Pose& X);

}  // namespace passung::surface
