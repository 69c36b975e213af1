#include "study/run/machine/hand_path.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/loop/haptic_loop.h"
#include "core/tick/pressed_run.h"
#include "devices/simulated/presets.h"
#include "devices/simulated/simulated_device.h"
#include "study/run/person/simulated_hand.h"
#include "study/run/visible_task.h"
#include "study/session/rendered_scenes.h"
#include "study/session/trial_rule.h"

namespace passung::run {

namespace {

constexpr std::uint64_t kSeed = 1;         // the same hand for the same condition
constexpr int kMostBefore = 3000;          // ticks until the hand holds the start pose
constexpr std::size_t kHardlyTouch = 100;  // ticks in contact: fewer say nothing
constexpr int kPressedTicks = 3000;

/// One trial, by a person who is as people are on average.
class HandTrial {
public:
    HandTrial(const scene::Scene& scene, const plan::Condition& condition, const Pose& X_WT)
        : scene_(scene),
          registration_{condition.scene.registration.X_WB, condition.scene.registration.scale,
                        condition.scene.registration.X_DH},
          device_(*simulated::findPreset(condition.device), simulatedHand({}, 0), visibleTask(condition), registration_,
                  kSeed),
          models_(scene_),
          ring_(16),
          cycle_(models_[0], device_, ring_, condition.shown == plan::ShownPose::Proxy),
          rule_(condition.task, condition.scene, X_WT, kSeed) {}

    /// False: the trial is over.
    bool step() {
        cycle_.run();
        std::array<TickRecord, 1> record;
        if (ring_.take(record) == 0) return true;
        const TickRecord& tick = record[0];
        begun_ = begun_ || (tick.status & kEngaged) != 0;
        if (!begun_) return tick.tick < kMostBefore;
        X_WH.push_back(registration_.partFromHandle(readingOf(tick)));
        touched += tick.contacts > 0 ? 1 : 0;
        std::vector<session::TrialEvent> events;
        const TickRecord* const alone = &tick;
        return !rule_.follow(tick, std::span(&alone, 1), tick.tick, events) &&
               X_WH.size() < static_cast<std::size_t>(HandPath::kMostTicks);
    }

    std::vector<Pose> X_WH;
    std::size_t touched = 0;  // ticks

private:
    static Pose readingOf(const TickRecord& tick) {
        const auto& p = tick.device_position_m;
        const auto& q = tick.device_quaternion;
        return {Quat(q[0], q[1], q[2], q[3]), Vec3(p[0], p[1], p[2])};
    }

    const scene::Scene& scene_;
    simulated::HandRegistration registration_;
    simulated::SimulatedDevice device_;
    tick::SceneModels models_;
    loop::RecordRing ring_;
    loop::HapticCycle cycle_;
    session::TrialRule rule_;
    bool begun_ = false;
};

std::vector<Pose> pressedPath(const scene::Scene& scene) {
    const tick::PressedRun run(scene);
    std::vector<Pose> path;
    for (int i = 0; i < tick::PressedRun::kApproachTicks + kPressedTicks; ++i) path.push_back(run.readingAt(i).X_BD);
    return path;
}

}  // namespace

Result<HandPath> handPath(const plan::Condition& condition, scene::PartCache& parts,
                          const std::function<void(double share)>& report) {
    if (condition.timed_by != plan::TimedBy::Program)
        return Error{.message = "its trials are not done with the device", .key = "condition", .value = condition.name};
    if (condition.scene.handCount() > 1)
        return Error{.message = "has more than one hand: what accuracy costs is measured with one",
                     .key = "condition",
                     .value = condition.name};
    if (condition.scene.effects.picks())
        return Error{.message = "picks parts up: what accuracy costs is measured with one held part",
                     .key = "condition",
                     .value = condition.name};
    if (simulated::findPreset(condition.device) == nullptr)
        return Error{.message = "no such device preset", .key = "device.preset", .value = condition.device};
    const auto X_WT = session::targetPose(condition);
    if (!X_WT) return X_WT.errors();
    const auto scene = scene::buildScene(condition.scene, parts);
    if (!scene) return scene.errors();
    HandTrial trial(*scene, condition, *X_WT);
    for (int i = 0; trial.step(); ++i)
        if (i % 100 == 0) report(std::min(1.0, static_cast<double>(i) / (kMostBefore + HandPath::kMostTicks)));
    if (trial.touched >= kHardlyTouch) return HandPath{HandPath::Origin::SimulatedHand, std::move(trial.X_WH)};
    return HandPath{HandPath::Origin::Pressed, pressedPath(*scene)};
}

}  // namespace passung::run
