#pragma once

#include <optional>

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

}  // namespace passung::scene
