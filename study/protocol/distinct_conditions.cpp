#include "study/protocol/distinct_conditions.h"

#include "study/protocol/plan_json.h"

namespace passung::protocol {
namespace {

/// The proxy is drawn where the hand is, so that either is the other's picture.
bool drawsBothAlike(const Condition& condition) {
    return condition.scene.contact.rendersAtHand() &&
           (!condition.comparison || condition.comparison->contact.rendersAtHand());
}

/// Nothing is drawn while real parts are handled or none at all, and the device rests.
bool isVirtual(const Condition& condition) { return condition.timed_by == TimedBy::Program; }

void dropDeadFeedback(Condition& condition) {
    Cues& cues = condition.cues;
    if (!isVirtual(condition)) cues = {.masking_noise = cues.masking_noise};
    if (!isVirtual(condition) || drawsBothAlike(condition)) condition.shown = ShownPose::Proxy;
    const Cues unsaid;
    if (!cues.visual && !cues.vibrotactile) cues.full_depth = unsaid.full_depth;
    if (!cues.audio) cues.full_speed = unsaid.full_speed;
    if (!cues.audio) cues.sound_decay = unsaid.sound_decay;
}

}  // namespace

std::string whatReaches(Condition condition) {
    dropDeadFeedback(condition);
    std::string meshes;
    if (condition.comparison)
        for (auto& part : condition.comparison->parts)
            if (const auto* mesh = std::get_if<model::MeshFile>(&part.geometry)) meshes += mesh->path + '\n';
    for (std::size_t i = 0; i < condition.scene.parts.size(); ++i) {
        auto& part = condition.scene.parts[i];
        if (part.name == condition.task.target) condition.task.target = std::to_string(i);
        part.name.clear();
        // In full: files of one name in two folders differ.
        if (const auto* mesh = std::get_if<model::MeshFile>(&part.geometry)) meshes += mesh->path + '\n';
    }
    return paramsJson(condition) + meshes;
}

std::string deadFeedback(const Condition& a, const Condition& b) {
    const auto differ = [&](auto Cues::*member) { return a.cues.*member != b.cues.*member; };
    const bool cues = differ(&Cues::visual) || differ(&Cues::vibrotactile) || differ(&Cues::audio);
    if (!isVirtual(a) && (cues || a.shown != b.shown))
        return "feedback has no effect in a trial that the program does not time: nothing is drawn, the device rests";
    if (a.shown != b.shown)
        return "feedback.shown_pose has no effect where contact.method = \"penalty\" renders at the hand: the proxy is "
               "there too";
    if (differ(&Cues::full_depth))
        return "feedback.cue_full_depth_mm has no effect without the cue \"visual\" or \"vibrotactile\"";
    if (differ(&Cues::full_speed) || differ(&Cues::sound_decay))
        return "the keys of the cue \"audio\" have no effect without it";
    return "";
}

}  // namespace passung::protocol
