#pragma once

#include <cstdint>

#include "core/surface/hull_distance.h"

namespace passung::surface {

/// Clusters of two trees that are faces.
struct FacePair {
    std::uint32_t held = 0, obstacle = 0;
    bool known = false;
};

/// The nearest points of the held part at `X` and the obstacles, face by face. Nothing as near as `within` [m]: that is
/// the distance told, and there are no points.
NearestHulls nearestFaces(const ClusterTree& held, const ClusterTree& obstacles, const Pose& X, double within = 1e300);

/// The same, from the pair of faces on that was nearest a moment ago, which is noted anew. After `most_faces` pairs of
/// faces the nearest so far is told. rt-safe.
NearestHulls nearestFaces(const ClusterTree& held, const ClusterTree& obstacles, const Pose& X, double within,
                          int most_faces, FacePair& pair) noexcept;

}  // namespace passung::surface
