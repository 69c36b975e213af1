#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/device_description.h"
#include "core/scene/scene_spec.h"
#include "study/plan/study_plan.h"
#include "study/protocol/document.h"
#include "study/protocol/part_surface.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// A scene as read from a tree of values; only for readers in this room.
struct SceneContent {
    scene::SceneSpec scene;
    std::string device;                      // its kind, empty if none is named
    std::optional<plan::DeviceNeeds> needs;  // of the kind "any"
    std::vector<std::string> other_devices;  // likewise of each of the scene's other hands
    double accuracy_budget = 0.0;            // [s] > 0: contact.accuracy is "auto"
    TextPosition accuracy_place;             // of that budget
    bool allow_unstable = false;
    bool parts_sound = false;  // what is said of parts, and the unit
    bool sound = false;        // everything but the device
};

/// What scenes are read with.
struct SceneReading {
    std::span<const DeviceDescription> devices;
    PartGeometries& geometries;                         // what parts are looked up in
    scene::Geometry automatic = scene::Geometry::Auto;  // what a geometry that is left to the program stands for
};

/// Adds a sentence if `scene`, a table of path `path`, has contact.cell_mm and contact.tolerance_um: the first one
/// wins.
void warnOfTolerance(const Node& scene, const std::string& path, std::vector<std::string>& warnings);

/// Reads a scene's table. `ids`: its tables in the key table; `path`: its name in messages ("scene" or "").
/// Adds everything that is wrong to `errors`; the result is meaningful only where it says that it is sound.
SceneContent readSceneNode(const Node& table, std::vector<std::string_view> ids, const std::string& path,
                           const SceneReading& reading, Errors& errors);

/// Reads one part. Lengths are in its own `unit`, else `units_per_metre` make a metre. `other_hands`: names of the
/// scene's hands but the first.
scene::PartSpec readPartNode(const Node& table, const std::string& parent_path, double units_per_metre,
                             std::span<const std::string> other_hands, Errors& errors);

/// Reads a vector of lengths [m]. Errors: farther than 10 m along an axis.
Vec3 readPosition(const TableReader& read, std::string_view key, double units_per_metre);

/// Reads `position_key` (lengths) and `rotation_key` (degrees, R = Rz·Ry·Rx).
Pose readPose(const TableReader& read, std::string_view position_key, std::string_view rotation_key,
              double units_per_metre);

/// What `unit` may name.
struct LengthUnit {
    std::string_view name;
    double per_metre;
};
inline constexpr std::array kLengthUnits{LengthUnit{"um", 1e6}, LengthUnit{"mm", 1e3}, LengthUnit{"cm", 1e2},
                                         LengthUnit{"m", 1.0}, LengthUnit{"in", 1.0 / 0.0254}};

/// How many of a table's `unit` make a metre; `absent` if it names none.
double unitsPerMetre(const TableReader& read, double absent);

}  // namespace passung::protocol
