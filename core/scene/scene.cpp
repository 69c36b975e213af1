#include "core/scene/scene.h"

#include <cstdio>

#include "core/scene/contact_geometry.h"
#include "core/scene/number_text.h"
#include "core/scene/part_mass.h"

namespace passung::scene {

namespace {

void append(std::string& key, double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%a ", value);  // exact
    key += text;
}

std::string cacheKey(const PartSpec& spec, const PartNeeds& needs) {
    std::string key;
    if (const auto* shape = std::get_if<shape::Shape>(&spec.geometry)) {
        key = std::string(shape::kindName(*shape)) + " ";
        for (const double value : shape::dimensions(*shape)) append(key, value);
    } else {
        const auto& file = std::get<MeshFile>(spec.geometry);
        key = "file " + file.path + " ";
        append(key, file.metres_per_unit);
    }
    key += needs.field ? "field " : "";
    key += needs.shell ? "shell " : "";
    key += needs.clusters ? "clusters " : "";
    for (const double value : {needs.tolerance, needs.cell, needs.depth, needs.spacing}) append(key, value);
    return key;
}

/// What is wrong with the density of a part that is built.
std::optional<Error> weightProblem(const SceneSpec& spec, const PartSpec& part, const Part& built) {
    if (!(part.density > 0.0)) return std::nullopt;
    const auto wrong = [&](std::string message) {
        return Error{.message = std::move(message), .key = "part " + part.name + ": density"};
    };
    if (!built.shape && !isClosed(built.report)) return wrong("needs a mesh without holes, which encloses a volume");
    if (built.shape && std::holds_alternative<shape::Sheet>(*built.shape)) return wrong("a sheet encloses no volume");
    if (!part.moves() || spec.effects.weight.gravity.isZero(0.0)) return std::nullopt;
    const auto weight = weigh(spec, *massOf(built, part.density));
    if (weight && weight->turn > kMostHangingTurn)
        return wrong("the weight would turn the part by " + number("%.2g", weight->turn) +
                     " rad against the rotational stiffness: at most " + number("%.2g", kMostHangingTurn));
    return std::nullopt;
}

}  // namespace

Result<std::shared_ptr<const Part>> PartCache::get(const PartSpec& spec, const PartNeeds& needs) {
    auto& entry = parts_[cacheKey(spec, needs)];
    if (!entry) {
        auto part = buildPart(spec, needs, store_);
        if (!part) return part.errors();
        entry = std::make_shared<const Part>(std::move(*part));
    }
    return entry;
}

Result<Scene> buildScene(const SceneSpec& spec, PartCache& cache) {
    if (auto errors = spec.validate(); !errors.empty()) return errors;
    Scene scene;
    scene.spec = spec;
    const Geometry geometry = geometryOf(spec).geometry;
    const bool fields = geometry == Geometry::Field;
    for (std::size_t i = 0; i < spec.parts.size(); ++i) {
        const PartSpec& part = spec.parts[i];
        const bool obstacle = !part.held || part.pickable || spec.handCount() > 1;
        auto built = cache.get(
            part, {.field = fields && (obstacle || spec.contact.two_way),
                   .shell = fields && (part.moves() || spec.contact.two_way),
                   .clusters = geometry == Geometry::Surface || (part.moves() && spec.effects.keep_apart.any()),
                   .tolerance = spec.contact.tolerance,
                   .cell = spec.contact.cell,
                   .spacing = spec.contact.spacing});
        if (!built) return built.errors();
        if (const auto problem = weightProblem(spec, part, **built)) return *problem;
        scene.parts.push_back(std::move(*built));
    }
    scene.held = spec.heldBy(0);
    return scene;
}

}  // namespace passung::scene
