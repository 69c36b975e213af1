#include "study/measures/parts_watch.h"

#include <algorithm>

#include "study/measures/tick_facts.h"

namespace passung::measures {

PartsWatch::PartsWatch(const scene::SceneSpec& spec) {
    for (const scene::PartSpec& part : spec.parts) X_WP_.push_back(part.X_WP);
    for (std::size_t hand = 0; hand < spec.handCount(); ++hand)
        if (const std::size_t part = spec.heldBy(hand); part < X_WP_.size()) held_[hand] = part;
}

bool PartsWatch::isHeld(std::size_t part) const {
    return std::any_of(held_.begin(), held_.end(), [part](const auto& held) { return held == part; });
}

void PartsWatch::follow(std::span<const TickRecord* const> hands) {
    for (std::size_t hand = hands.size(); hand-- > 0;) {  // of two on one part the first tells where it is
        if (hands[hand] == nullptr) continue;
        const std::int32_t held = hands[hand]->held;
        if (held >= 0) held_[hand] = static_cast<std::size_t>(held);
        if (held == kNoPart) held_[hand].reset();
        if (held_[hand]) X_WP_[*held_[hand]] = proxyPose(*hands[hand]);
    }
}

}  // namespace passung::measures
