#include "study/plan/scene_parts.h"

namespace passung::plan {
namespace {

template <class Condition>
const scene::PartSpec* findPart(const scene::SceneSpec& scene, Condition condition) {
    for (const scene::PartSpec& part : scene.parts)
        if (condition(part)) return &part;
    return nullptr;
}

}  // namespace

const scene::PartSpec* heldPart(const scene::SceneSpec& scene) {
    return findPart(scene, [](const scene::PartSpec& part) { return part.held && part.hand == 0; });
}

Pose startPose(const scene::SceneSpec& scene, std::size_t hand) {
    const std::size_t held = scene.heldBy(hand);
    return held < scene.parts.size() ? scene.parts[held].X_WP : scene.hand(hand).start_gate.X_WH;
}

const scene::PartSpec* partNamed(const scene::SceneSpec& scene, std::string_view name) {
    return findPart(scene, [name](const scene::PartSpec& part) { return part.name == name; });
}

}  // namespace passung::plan
