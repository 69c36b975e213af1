#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/tick_record.h"

namespace passung::measures {

/// What a tick is with all hands.
struct TickOfHands {
    bool contact = false;      // isContact() of any hand
    std::uint32_t status = 0;  // TickStatus bits of any hand
    double depth = 0.0;        // largest recorded proxy_depth_m of any hand [m]
    double force = 0.0;        // largest |force| of any hand [N]
};

/// Of each of `ticks`, the first hand's. `hands`: what was recorded of each, the first included, ascending; a tick that
/// was not recorded of a hand tells nothing of it. Empty: one hand.
std::vector<TickOfHands> togetherAt(std::span<const TickRecord> ticks,
                                    std::span<const std::span<const TickRecord>> hands);

}  // namespace passung::measures
