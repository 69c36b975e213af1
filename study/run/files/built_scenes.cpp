#include "study/run/files/built_scenes.h"

namespace passung::run {

Result<BuiltScenes> buildScenes(const std::vector<session::RenderedScene>& rendered, scene::PartCache& parts) {
    BuiltScenes built;
    built.scenes.reserve(rendered.size());
    built.models.reserve(rendered.size());
    for (const session::RenderedScene& scene : rendered) {
        auto made = scene::buildScene(scene.spec, parts);
        if (!made) return made.errors();
        built.scenes.push_back(std::move(*made));
        built.models.push_back(tick::makeModel(built.scenes.back()));
        built.turns.push_back({&built.models.back(), scene.periods});
    }
    return built;
}

}  // namespace passung::run
