#include "ui/sound/sound_feed.h"

#include <array>
#include <utility>

namespace passung::sound {

void SoundFeed::plan(const SoundPlan& plan) { plans_.put(plan); }

void SoundFeed::fill(std::span<float> samples) {
    std::array<loop::ScreenTick, 64> ticks;
    while (const std::size_t count = ring_.take(ticks)) {
        for (const loop::ScreenTick& tick : std::span(ticks).first(count)) {
            if (tick.record.tick <= last_tick_ || last_tick_ < 0) synthesis_.begin(plans_.latest());  // another attempt
            last_tick_ = tick.record.tick;
            synthesis_.follow(tick.record);
        }
    }
    if (const SoundPlan& plan = plans_.latest(); !plan.any()) synthesis_.begin(plan);
    synthesis_.render(samples);
}

void SoundFeed::setOutput(std::optional<SoundOutput> output) {
    const std::lock_guard lock(mutex_);
    output_ = std::move(output);
}

std::optional<SoundOutput> SoundFeed::output() const {
    const std::lock_guard lock(mutex_);
    return output_;
}

}  // namespace passung::sound
