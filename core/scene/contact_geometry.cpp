#include "core/scene/contact_geometry.h"

#include <algorithm>

namespace passung::scene {

namespace {

/// Its faces and edges bound a solid (closed_form::solidOf); a sheet has no inside.
bool hasClosedForm(const PartSpec& part) {
    const auto* shape = std::get_if<shape::Shape>(&part.geometry);
    return shape != nullptr && !std::holds_alternative<shape::Sheet>(*shape);
}

bool isThread(const PartSpec& part) {
    const auto* shape = std::get_if<shape::Shape>(&part.geometry);
    return shape != nullptr &&
           (std::holds_alternative<shape::ThreadBolt>(*shape) || std::holds_alternative<shape::ThreadNut>(*shape));
}

/// Only of a bolt with a nut are edges all that can touch: round parts would meet their crests between edges.
bool isThreadAlone(const PartSpec& a, const PartSpec& b) {
    if (!isThread(a) && !isThread(b)) return false;
    return !isThread(a) || !isThread(b) ||
           std::get<shape::Shape>(a.geometry).index() == std::get<shape::Shape>(b.geometry).index();
}

bool rub(const PartSpec& a, const PartSpec& b) { return a.friction > 0.0 && b.friction > 0.0; }

/// Why the pair has no closed form; nothing if it has one.
const char* closedFormProblem(const PartSpec& held, const PartSpec& obstacle, const ContactSpec& contact) {
    if (contact.method == ContactMethod::Penalty)
        return "closed_form needs a god object: the penalty is a sum over sample points";
    if (!hasClosedForm(held) || !hasClosedForm(obstacle))
        return "closed_form needs parts that are parametric shapes, without a mesh or sheet";
    if (isThreadAlone(held, obstacle)) return "closed_form needs a thread_bolt with a thread_nut, or no thread";
    if (!rub(held, obstacle)) return nullptr;
    if (!isThread(held)) return "closed_form needs parts without friction, or a thread_bolt with a thread_nut";
    if (contact.proxy_filter > 0.0)
        return "closed_form with friction needs a proxy without low-pass (contact.proxy_filter_hz)";
    return nullptr;
}

/// Why a scene has no contact of surfaces; nothing if it has.
const char* surfaceProblem(const ContactSpec& contact) {
    if (contact.method == ContactMethod::Penalty)
        return "surface needs a god object: the penalty is a sum over sample points";
    if (contact.proxy_filter > 0.0) return "surface needs a proxy without low-pass (contact.proxy_filter_hz)";
    return nullptr;
}

/// Calls `f` with each part that hands hold or may hold and each part that it can meet. Of those two meet twice, once
/// as either's.
template <class F>
void eachPair(const SceneSpec& scene, F f) {
    for (const PartSpec& held : scene.parts)
        for (const PartSpec& obstacle : scene.parts)
            if (held.moves() && &held != &obstacle) f(held, obstacle);
}

}  // namespace

GeometryChoice geometryOfPair(const PartSpec& held, const PartSpec& obstacle, const ContactSpec& contact) {
    if (contact.geometry != Geometry::Auto) return {contact.geometry, "contact.geometry names it"};
    if (closedFormProblem(held, obstacle, contact) == nullptr)
        return {Geometry::ClosedForm, "a god object, and parts that are parametric shapes"};
    if (const char* problem = surfaceProblem(contact)) return {Geometry::Field, problem};
    return {Geometry::Surface,
            "a god object, and parts that rub, or one that is a mesh, a sheet or a thread without its counterpart"};
}

GeometryChoice geometryOf(const SceneSpec& scene) {
    std::optional<GeometryChoice> all;
    eachPair(scene, [&](const PartSpec& held, const PartSpec& obstacle) {
        const GeometryChoice choice = geometryOfPair(held, obstacle, scene.contact);
        const bool coarser = all && (choice.geometry == Geometry::Field ||
                                     (choice.geometry == Geometry::Surface && all->geometry == Geometry::ClosedForm));
        if (!all || coarser) all = choice;
    });
    return all.value_or(GeometryChoice{Geometry::Field, "the scene has no obstacle"});
}

std::optional<std::string> geometryProblem(const SceneSpec& scene) {
    const Geometry asked = scene.contact.geometry;
    const auto thread = std::find_if(scene.parts.begin(), scene.parts.end(), isThread);
    if (thread != scene.parts.end() && scene.parts.size() > 1 && geometryOf(scene).geometry == Geometry::Field)
        return "must not be distance fields with a thread, whose field would take minutes: needs a god object without "
               "proxy_filter_hz (" +
               thread->name + ")";
    if (asked != Geometry::ClosedForm && asked != Geometry::Surface) return std::nullopt;
    std::optional<std::string> first;
    eachPair(scene, [&](const PartSpec& held, const PartSpec& obstacle) {
        const char* const problem = asked == Geometry::Surface ? surfaceProblem(scene.contact)
                                                               : closedFormProblem(held, obstacle, scene.contact);
        if (!first && problem != nullptr) first = std::string(problem) + " (" + held.name + ", " + obstacle.name + ")";
    });
    return first;
}

const char* methodName(ContactMethod method) {
    switch (method) {
        case ContactMethod::Penalty:
            return "penalty";
        case ContactMethod::GodObjectHeuristic:
            return "god_object_heuristic";
        case ContactMethod::GodObject:
            break;
    }
    return "god_object";
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

std::optional<Geometry> geometryNamed(std::string_view name) {
    for (const Geometry geometry : {Geometry::Auto, Geometry::ClosedForm, Geometry::Surface, Geometry::Field})
        if (name == geometryName(geometry)) return geometry;
    return std::nullopt;
}

}  // namespace passung::scene
