#include "ui/presenter/step_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/measures/hint_watch.h"

namespace passung::presenter {

std::vector<StepLine> stepLines(const DrawnPicking& picking, scene::StepSet done, std::optional<std::size_t> hinted) {
    std::vector<StepLine> lines;
    for (std::size_t i = 0; i < picking.pick.steps.size(); ++i) {
        StepLine line;
        line.name = i < picking.step_names.size() && !picking.step_names[i].empty() ? picking.step_names[i]
                                                                                    : fmt::format("{}", i + 1);
        if ((done & scene::stepBit(i)) != 0)
            line.state = StepLine::State::Done;
        else if (measures::mayBeNext(picking.pick.steps[i], i, done))
            line.state = StepLine::State::Next;
        line.hinted = hinted == i;
        lines.push_back(std::move(line));
    }
    return lines;
}

std::vector<measures::StepState> stepStates(const DrawnPicking& picking, const PartPoses& poses) {
    using measures::StepState;
    std::vector<StepState> states(picking.pick.steps.size(), StepState::Idle);
    for (std::size_t i = 0; i < states.size(); ++i) {
        const scene::AssemblyStep& step = picking.pick.steps[i];
        const auto holds = [&](const DrawnHand& hand) { return hand.part == static_cast<std::int32_t>(step.part); };
        if ((poses.done() & scene::stepBit(i)) != 0)
            states[i] = StepState::Locked;
        else if (std::any_of(poses.hands().begin(), poses.hands().end(), holds))
            states[i] = measures::stateInHand(step, poses.poses(),
                                              (poses.poses()[step.part].p - poses.takenAt()[step.part]).norm());
    }
    return states;
}

std::vector<StepImage> stepImages(const DrawnScene& scene, std::span<const Pose> X_WP, scene::StepSet done,
                                  std::optional<std::size_t> hinted) {
    std::vector<StepImage> images;
    if (!scene.picking) return images;
    const std::vector<scene::AssemblyStep>& steps = scene.picking->pick.steps;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const bool asked = scene.picking->hints || hinted == i;
        if (!asked || !measures::mayBeNext(steps[i], i, done) || steps[i].part >= X_WP.size()) continue;
        const Pose X_WGoal = scene::goalOf(steps[i], X_WP);
        images.push_back({steps[i].part, {X_WGoal.q, X_WGoal.p + scene.parts[steps[i].part].shown_offset}});
    }
    return images;
}

std::vector<bool> partsDone(const DrawnScene& scene, scene::StepSet done) {
    std::vector<bool> parts(scene.parts.size(), false);
    if (!scene.picking) return parts;
    const std::vector<scene::AssemblyStep>& steps = scene.picking->pick.steps;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if ((done & scene::stepBit(i)) != 0 && steps[i].locks && steps[i].part < parts.size())
            parts[steps[i].part] = true;
    return parts;
}

}  // namespace passung::presenter
