#include "study/protocol/distinct_conditions.h"

#include <algorithm>

#include "study/protocol/plan_json.h"

namespace passung::protocol {
namespace {

/// The proxy is drawn where the hand is, so that either is the other's picture.
bool drawsBothAlike(const plan::Condition& condition) {
    return condition.scene.contact.rendersAtHand() &&
           (!condition.comparison || condition.comparison->contact.rendersAtHand());
}

/// Nothing is drawn while real parts are handled or none at all, and the device rests.
bool isVirtual(const plan::Condition& condition) { return condition.timed_by == plan::TimedBy::Program; }

void dropDeadFeedback(plan::Condition& condition) {
    plan::Cues& cues = condition.cues;
    if (!isVirtual(condition)) cues = {.masking_noise = cues.masking_noise};
    if (!isVirtual(condition) || drawsBothAlike(condition)) condition.shown = plan::ShownPose::Proxy;
    if (!isVirtual(condition)) condition.shows_scene = true;
    const plan::Cues unsaid;
    if (!cues.visual && !cues.vibrotactile) cues.full_depth = unsaid.full_depth;
    if (!cues.audio) cues.full_speed = unsaid.full_speed;
    if (!cues.audio) cues.sound_decay = unsaid.sound_decay;
}

/// A density reaches nobody but as the weight of what is held, nor gravity but by a density.
void dropDeadWeight(scene::SceneSpec& scene) {
    bool weighs = false;
    for (scene::PartSpec& part : scene.parts) {
        if (!part.moves() || scene.effects.weight.gravity.isZero(0.0)) part.density = 0.0;
        weighs = weighs || part.density > 0.0;
    }
    if (!weighs) scene.effects.weight = {};
}

}  // namespace

std::string whatReaches(plan::Condition condition) {
    dropDeadFeedback(condition);
    dropDeadWeight(condition.scene);
    if (condition.comparison) dropDeadWeight(*condition.comparison);
    std::string meshes;
    if (condition.comparison)
        for (auto& part : condition.comparison->parts)
            if (const auto* mesh = std::get_if<scene::MeshFile>(&part.geometry)) meshes += mesh->path + '\n';
    for (std::size_t i = 0; i < condition.scene.parts.size(); ++i) {
        auto& part = condition.scene.parts[i];
        if (part.name == condition.task.target) condition.task.target = std::to_string(i);
        part.name.clear();
        // In full: files of one name in two folders differ.
        if (const auto* mesh = std::get_if<scene::MeshFile>(&part.geometry)) meshes += mesh->path + '\n';
    }
    return paramsJson(condition) + meshes;
}

std::string deadFeedback(const plan::Condition& a, const plan::Condition& b) {
    const auto differ = [&](auto plan::Cues::*member) { return a.cues.*member != b.cues.*member; };
    const bool cues = differ(&plan::Cues::visual) || differ(&plan::Cues::vibrotactile) || differ(&plan::Cues::audio);
    if (!isVirtual(a) && (cues || a.shown != b.shown || a.shows_scene != b.shows_scene))
        return "feedback has no effect in a trial that the program does not time: nothing is drawn, the device rests";
    if (a.shown != b.shown)
        return "feedback.shown_pose has no effect where contact.method = \"penalty\" renders at the hand: the proxy is "
               "there too";
    if (differ(&plan::Cues::full_depth))
        return "feedback.cue_full_depth_mm has no effect without the cue \"visual\" or \"vibrotactile\"";
    if (differ(&plan::Cues::full_speed) || differ(&plan::Cues::sound_decay))
        return "the keys of the cue \"audio\" have no effect without it";
    const auto same_density = [](const scene::PartSpec& x, const scene::PartSpec& y) { return x.density == y.density; };
    if (!std::equal(a.scene.parts.begin(), a.scene.parts.end(), b.scene.parts.begin(), b.scene.parts.end(),
                    same_density))
        return "density_kg_per_m3 has no effect without effects.weight, nor of a part that is not held";
    if (a.scene.effects.weight.gravity != b.scene.effects.weight.gravity)
        return "effects.weight has no effect where density_kg_per_m3 of the held part is 0";
    return "";
}

}  // namespace passung::protocol
