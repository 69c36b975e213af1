#include "study/measures/tick_of_hands.h"

#include <algorithm>

#include "study/measures/tick_facts.h"

namespace passung::measures {
namespace {

void add(const TickRecord& record, TickOfHands& tick) {
    tick.contact = tick.contact || isContact(record);
    tick.status |= record.status;
    tick.depth = std::max(tick.depth, static_cast<double>(record.proxy_depth_m));
    tick.force = std::max(tick.force, Vec3(record.force_N[0], record.force_N[1], record.force_N[2]).norm());
}

}  // namespace

std::vector<TickOfHands> togetherAt(std::span<const TickRecord> ticks,
                                    std::span<const std::span<const TickRecord>> hands) {
    std::vector<TickOfHands> together(ticks.size());
    const auto addHand = [&](std::span<const TickRecord> records) {
        auto next = records.begin();
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            next = std::find_if(next, records.end(), [&](const TickRecord& r) { return r.tick >= ticks[i].tick; });
            if (next != records.end() && next->tick == ticks[i].tick) add(*next, together[i]);
        }
    };
    if (hands.empty()) addHand(ticks);
    for (const auto& hand : hands) addHand(hand);
    return together;
}

}  // namespace passung::measures
