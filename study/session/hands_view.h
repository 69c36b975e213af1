#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/tick_record.h"
#include "study/plan/study_plan.h"

namespace passung::session {

/// The record of `tick` among ascending ones, or the last one before it; nullptr: there is none.
const TickRecord* recordAt(std::span<const TickRecord> records, std::int64_t tick);

/// By what of its ticks an attempt is judged where the scene has several hands. Of one hand: by its records as they
/// are.
///   A trial begins when all hands are engaged. Where the target is in another hand, the first hand's part is seen from
/// the target: poses and wrenches are those that they were if the target had stayed where it starts, so that every rule
/// and measure of a type holds for a target that moves.
class HandsView {
public:
    /// Of this condition's scene.
    explicit HandsView(const plan::Condition& condition);

    std::size_t otherHands() const { return other_hands_; }

    /// What the first hand's `record` is judged as. `others`: what was recorded of each other hand, ascending, that
    /// tick included; of a tick that is missing there the one before it counts.
    TickRecord of(const TickRecord& record, std::span<const std::vector<TickRecord>> others) const;

    /// The records of each hand of a scene with several, `first` included; empty of one hand.
    std::vector<std::span<const TickRecord>> recordsOfAll(std::span<const TickRecord> first,
                                                          std::span<const std::vector<TickRecord>> others) const;

    /// What was recorded of each hand at that tick, where it is looked at beside; else of the first alone.
    /// `others`: as of().
    std::array<const TickRecord*, scene::kMostHands> all(const TickRecord& record,
                                                         std::span<const std::vector<TickRecord>> others) const;

private:
    std::size_t other_hands_;
    std::optional<std::size_t> target_hand_;  // that holds the target, among the others; none: it rests
    Pose X_TW_start_;
};

}  // namespace passung::session
