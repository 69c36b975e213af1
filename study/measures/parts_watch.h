#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/tick_record.h"
#include "core/scene/scene_spec.h"

namespace passung::measures {

/// Where the parts of a scene are, tick by tick, from the records of all hands alone: a part in a hand is where that
/// hand's proxy is; one that was let go stays where the proxy was in the hand's last record with it. Where nothing is
/// picked up a hand holds what it begins with.
class PartsWatch {
public:
    explicit PartsWatch(const scene::SceneSpec& spec);

    /// `hands`: each hand's record of a tick, in the order of the scene; of a hand that is not told nullptr.
    void follow(std::span<const TickRecord* const> hands);

    /// Of every part, world.
    const std::vector<Pose>& poses() const { return X_WP_; }
    /// Which part the hand holds; nothing: none.
    std::optional<std::size_t> heldBy(std::size_t hand) const { return held_[hand]; }
    bool isHeld(std::size_t part) const;

private:
    std::vector<Pose> X_WP_;
    std::array<std::optional<std::size_t>, scene::kMostHands> held_{};
};

}  // namespace passung::measures
