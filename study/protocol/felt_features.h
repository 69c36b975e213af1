#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/scene_spec.h"
#include "study/protocol/document.h"
#include "study/protocol/part_surface.h"

namespace passung::protocol {

/// No disc on a face that is wider than this, per spacing, is without a sample of the point shell: what samplePoints
/// reaches (tests/core/shape/thin_features_test.cpp holds it).
inline constexpr double kCoverShare = 0.9;

/// What contact takes where a protocol does not say it.
struct ContactDefaults {
    double spacing = 1e-3;     // [m]
    double tolerance = 20e-6;  // [m]
};

/// Spacing and tolerance that follow the size of the held part, a fiftieth and 1/2500 of it, and the smallest feature
/// of any obstacle where contact is sampled, rounded to 1, 2 or 5 times a power of ten; of a part of 50 mm 1 mm and 20
/// µm. They do not fall below what makes more than about kDefaultPoints points of the held part, or a field of more
/// than a few million cells.
ContactDefaults defaultsFor(const scene::SceneSpec& scene, PartGeometries& geometries);
inline constexpr double kDefaultPoints = 4e4;

/// Are the obstacles free of ends that slip between the held part's points, with the scene's spacing? True where
/// contact is not sampled. Else contact has to be looked for both ways.
bool oneWayFeelsAll(const scene::SceneSpec& scene, PartGeometries& geometries);

/// Adds an error at the obstacle's table for every pin, fin, wall or edge that contact as `scene` asks for it will not
/// feel; of relief a sentence to `warnings`. `table`: of the scene, of path `path`.
///   Points: one way, what slips between the held part's points; both ways, only where the obstacle's own points find
///   nothing either, since the held part is thinner than half their gap, or is lost in its own field.
///   Field: what is thinner than interpolation smooths away. With cells of one edge h the trilinear value at c is at
///   most φ(c) + √3/2 h, the farthest that a corner of the cell is from c; refined to a tolerance, φ(c) + tolerance. So
///   a feature is felt if a ball of that radius has room. A sheet is felt in front of its surface.
void checkFelt(const Node& table, const std::string& path, const scene::SceneSpec& scene, PartGeometries& geometries,
               Errors& errors, std::vector<std::string>& warnings);

/// No such error.
bool feelsEverything(const scene::SceneSpec& scene, PartGeometries& geometries);

}  // namespace passung::protocol
