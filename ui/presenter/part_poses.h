#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/loop/record_ring.h"
#include "study/measures/hint_watch.h"
#include "ui/presenter/drawn_scene.h"

namespace passung::presenter {

/// A hand as it is drawn: an empty one as a little gripper at its point, another one by what it holds.
struct DrawnHand {
    Pose X_W;  // of the part in it, else of its point
    std::int32_t part = kNoPart;
    bool closed = false;
};

/// Where all parts and hands are drawn, tick by tick: parts that hands pick up, carry and let go.
///
/// A part in a hand is where the scene shows that hand's pose; in two hands, where the first of them does. Let go it
/// stays where the hand's proxy was in the last tick that is known of it, as its record has it. Where ticks are missed
/// that is too early a place, until the part's turn comes in ScreenTick::at_rest.
class PartPoses {
public:
    PartPoses() = default;
    /// All parts at their start. A scene without picking has none to follow.
    explicit PartPoses(const DrawnScene& scene);

    /// The next tick. One that is not later begins anew, with all parts at their start.
    void follow(const loop::ScreenTick& tick);
    /// The same of what was recorded of each hand; null: nothing yet. @pre records[0] is not null
    void follow(std::span<const TickRecord* const> records);

    /// Where each part is drawn.
    const std::vector<Pose>& drawn() const { return X_WDrawn_; }
    /// Where each part is, as far as it is shown: without the offsets that parts are drawn at.
    const std::vector<Pose>& poses() const { return X_WP_; }
    const std::vector<DrawnHand>& hands() const { return hands_; }
    /// Where each part was when a hand last took it; its start if none has [m].
    const std::vector<Vec3>& takenAt() const { return taken_at_; }
    /// The steps of an assembly that are done.
    scene::StepSet done() const { return done_; }
    /// The step that a hint leads to, from when it is due in the running trial on.
    std::optional<std::size_t> hinted() const { return hints_.shown(); }

private:
    struct HandTick {
        Pose X_WShown, X_WG;
        std::int32_t part = kNoPart;
        bool closed = false;
    };
    void begin(std::int64_t tick);
    void take(std::span<const std::optional<HandTick>> hands);
    void put(std::size_t part, const Pose& X_WP);
    void lookAtSteps(const TickRecord& first, bool engaged);
    HandTick tickOf(const TickRecord& record) const;

    std::vector<Pose> X_WStart_, X_WP_, X_WDrawn_;
    std::vector<Vec3> offsets_, taken_at_;
    std::vector<Pose> X_WHandStart_;
    std::vector<std::int32_t> held_start_;
    std::vector<DrawnHand> hands_;
    std::vector<Pose> X_WG_;  // of each hand, in the last tick
    plan::ShownPose shown_ = plan::ShownPose::Proxy;
    int button_ = 1;
    std::int64_t tick_ = -1;
    scene::StepSet done_ = 0;
    measures::HintWatch hints_, no_hint_yet_;
    bool started_ = false;  // all hands have held the start: the trial runs
};

}  // namespace passung::presenter
