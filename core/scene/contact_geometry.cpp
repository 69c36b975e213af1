#include "core/scene/contact_geometry.h"

#include <algorithm>

namespace passung::scene {

namespace {

// What this version can compute contact from, beside fields and closed forms.
constexpr bool kSurfaceBuilt = false;

/// Its faces and edges bound a solid (closed_form::solidOf); a sheet has no inside.
bool hasClosedForm(const PartSpec& part) {
    const auto* shape = std::get_if<shape::Shape>(&part.geometry);
    return shape != nullptr && !std::holds_alternative<shape::Sheet>(*shape);
}

bool rub(const PartSpec& a, const PartSpec& b) { return a.friction > 0.0 && b.friction > 0.0; }

/// Why the pair has no closed form; nothing if it has one.
const char* closedFormProblem(const PartSpec& held, const PartSpec& obstacle, const ContactSpec& contact) {
    if (contact.method == ContactMethod::Penalty)
        return "closed_form needs a god object: the penalty is a sum over sample points";
    if (!hasClosedForm(held) || !hasClosedForm(obstacle))
        return "closed_form needs parts that are parametric shapes, without a mesh or sheet";
    if (rub(held, obstacle)) return "closed_form needs parts without friction";
    return nullptr;
}

const PartSpec* heldPart(const SceneSpec& scene) {
    const auto held = std::find_if(scene.parts.begin(), scene.parts.end(), [](const auto& part) { return part.held; });
    return held == scene.parts.end() ? nullptr : &*held;
}

}  // namespace

GeometryChoice geometryOfPair(const PartSpec& held, const PartSpec& obstacle, const ContactSpec& contact) {
    if (contact.geometry != Geometry::Auto) return {contact.geometry, "contact.geometry names it"};
    if (const char* problem = closedFormProblem(held, obstacle, contact)) return {Geometry::Field, problem};
    return {Geometry::ClosedForm, "a god object, and parts that are parametric shapes"};
}

GeometryChoice geometryOf(const SceneSpec& scene) {
    const PartSpec* held = heldPart(scene);
    std::optional<GeometryChoice> all;
    for (const PartSpec& part : scene.parts) {
        if (held == nullptr || part.held) continue;
        const GeometryChoice choice = geometryOfPair(*held, part, scene.contact);
        if (!all || choice.geometry == Geometry::Field) all = choice;
    }
    return all.value_or(GeometryChoice{Geometry::Field, "the scene has no obstacle"});
}

std::optional<std::string> geometryProblem(const SceneSpec& scene) {
    if (scene.contact.geometry == Geometry::Surface && !kSurfaceBuilt) return "is not built in this version";
    const PartSpec* held = heldPart(scene);
    if (scene.contact.geometry != Geometry::ClosedForm || held == nullptr) return std::nullopt;
    for (const PartSpec& part : scene.parts) {
        if (part.held) continue;
        if (const char* problem = closedFormProblem(*held, part, scene.contact))
            return std::string(problem) + " (" + held->name + ", " + part.name + ")";
    }
    return std::nullopt;
}

const char* geometryName(Geometry geometry) {
    switch (geometry) {
        case Geometry::Auto:
            return "auto";
        case Geometry::ClosedForm:
            return "closed_form";
        case Geometry::Surface:
            return "surface";
        case Geometry::Field:
            break;
    }
    return "field";
}

}  // namespace passung::scene
