#include "core/scene/scene.h"

#include <cstdio>

#include "core/scene/contact_geometry.h"

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
        const bool obstacle = !part.held || spec.handCount() > 1;
        auto built = cache.get(part, {.field = fields && (obstacle || spec.contact.two_way),
                                      .shell = fields && (part.held || spec.contact.two_way),
                                      .clusters = geometry == Geometry::Surface,
                                      .tolerance = spec.contact.tolerance,
                                      .cell = spec.contact.cell,
                                      .spacing = spec.contact.spacing});
        if (!built) return built.errors();
        scene.parts.push_back(std::move(*built));
    }
    scene.held = spec.heldBy(0);
    return scene;
}

}  // namespace passung::scene
