#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/scene/scene_spec.h"

namespace passung::scene {

/// What contact is computed from (never Geometry::Auto), and why.
struct GeometryChoice {
    Geometry geometry = Geometry::Field;
    const char* reason = "";
};

/// Of the held part with one obstacle. Auto: fields for the penalty; for god objects the closed form where both parts
/// have one (of threads a bolt with a nut) and nothing but threads rubs, else the surfaces, and fields where those
/// cannot do it: a proxy with a low-pass.
GeometryChoice geometryOfPair(const PartSpec& held, const PartSpec& obstacle, const ContactSpec& contact);

/// Of a scene, whose pairs all have one: that which each of them can have.
GeometryChoice geometryOf(const SceneSpec& scene);

/// What has to hold for the geometry that the scene names or gets, as a requirement; nothing if it does.
std::optional<std::string> geometryProblem(const SceneSpec& scene);

/// "penalty", "god_object_heuristic", "god_object".
const char* methodName(ContactMethod method);
/// "auto", "closed_form", "surface", "field".
const char* geometryName(Geometry geometry);
/// Nothing for another text.
std::optional<Geometry> geometryNamed(std::string_view name);

}  // namespace passung::scene
