#pragma once

#include <optional>
#include <string>

#include "core/geometry/mass_properties.h"
#include "core/import/mesh_import.h"
#include "core/scene/part.h"
#include "core/shape/shape.h"

namespace passung::scene {

/// Mass, centre of mass and inertia of parts of one density [kg/m³], part frame. Nothing where a part encloses no
/// volume: a sheet, or a mesh that `isClosed` denies.

/// Exact for all shapes but keyed ones and threads; of these, of triangles that are 10 ppm of the radius off their
/// round faces, which takes up to 20 ppm from mass.
std::optional<geometry::MassProperties> massOf(const shape::Shape& shape, double density);

/// Of the shape, or of the triangles.
std::optional<geometry::MassProperties> massOf(const Part& part, double density);

/// True if a mesh encloses a volume as its file says it. One with holes does not: contact closes them, but how much
/// the part is behind them the file leaves open.
bool isClosed(const importer::MeshReport& report);

/// What the weight of a held part does to its hand and its proxy.
struct HeldWeight {
    geometry::MassProperties body;
    double force = 0.0;      // [N]
    double torque = 0.0;     // about the part's origin, at the orientation where it is largest [N·m]
    bool has_proxy = false;  // which hangs from the hand, in the air, by
    double sag = 0.0;        // [m]
    double turn = 0.0;       // at most [rad]
};

/// Of a held part with these properties; nothing where the scene has no gravity, or the part no mass.
std::optional<HeldWeight> weigh(const SceneSpec& scene, const geometry::MassProperties& body);

/// "of 62 g weighs 0.61 N, up to 0.015 Nm about its origin; in the air it hangs 0.61 mm from the hand, turned by up to
/// 0.9 deg"
std::string describe(const HeldWeight& weight);

}  // namespace passung::scene
