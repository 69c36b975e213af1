#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/mesh.h"

namespace passung::bench {

/// κ of all wrenches [N/m³].
inline constexpr double kAreaStiffness = 1e9;

/// One pose and what is true there, by means that share nothing with the contact core.
struct TruePose {
    Pose X_FS;                    // of the tool (shell) in the bunny (field)
    double shell_in_field = 0.0;  // smallest signed distance of the tool's surface from the bunny [m]; negative: depth
    double field_in_shell = 0.0;  // the other way round [m]
    double uncertainty = 0.0;     // of both, deeper [m]
    Wrench one_way;               // on the tool, its surface in the bunny
    Wrench two_way;               // mean of that and of the reaction to the bunny's surface in the tool
};

/// Bunny and torus tool, with poses at which the tool is pressed in by 1 mm and poses 1 mm apart.
struct ContactScene {
    geometry::TriangleMesh bunny;  // Loop-subdivided twice, longest side 0.15 m, centred
    geometry::TriangleMesh tool;   // torus, R 20 mm, r 6 mm, 12 000 triangles, axis z
    std::vector<TruePose> pressed, apart;
};

/// The bunny of `file` (OFF) as above.
Result<geometry::TriangleMesh> loadBunny(const std::string& file);

geometry::TriangleMesh torusTool();

/// `count` poses of each kind: the tool, turned at random, comes along a random line towards the middle of the bunny;
/// bisection finds where it is 1 mm apart (FCL's distance), and where its surface first reaches 1 mm deep (branch and
/// bound over all of it). The same seed gives the same poses. Takes seconds a pose: see true_poses.h.
ContactScene makeContactScene(geometry::TriangleMesh bunny, std::size_t count, std::uint64_t seed);

/// What is true at one pose of the scene: how the poses of makeContactScene were judged.
TruePose truthAt(const ContactScene& scene, const Pose& X_FS);

}  // namespace passung::bench
