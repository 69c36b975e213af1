#include "study/run/files/built_scenes.h"

namespace passung::run {

Result<BuiltScenes> buildScenes(const std::vector<session::RenderedScene>& rendered, scene::PartCache& parts) {
    BuiltScenes built;
    built.scenes.reserve(rendered.size());
    for (const session::RenderedScene& scene : rendered) {
        auto made = scene::buildScene(scene.spec, parts);
        if (!made) return made.errors();
        built.scenes.push_back(std::move(*made));
    }
    built.models = tick::SceneModels(built.scenes);
    for (std::size_t i = 0; i < rendered.size(); ++i) built.turns.push_back({&built.models[i], rendered[i].periods});
    return built;
}

}  // namespace passung::run
