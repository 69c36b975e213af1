#include "study/plan/scene_parts.h"

namespace passung::protocol {
namespace {

template <class Condition>
const model::PartSpec* findPart(const model::SceneSpec& scene, Condition condition) {
    for (const model::PartSpec& part : scene.parts)
        if (condition(part)) return &part;
    return nullptr;
}

}  // namespace

const model::PartSpec* heldPart(const model::SceneSpec& scene) {
    return findPart(scene, [](const model::PartSpec& part) { return part.held; });
}

const model::PartSpec* partNamed(const model::SceneSpec& scene, std::string_view name) {
    return findPart(scene, [name](const model::PartSpec& part) { return part.name == name; });
}

}  // namespace passung::protocol
