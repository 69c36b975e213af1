#pragma once

#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "core/loop/mailbox.h"
#include "core/loop/record_ring.h"
#include "ui/sound/synthesis.h"

namespace passung::sound {

/// Where sound comes from.
struct SoundOutput {
    std::string name;
    double delay_us = 0.0;  // the length of its buffer; what the output adds is not known
};

/// Between a session, whose loop puts ticks into its ring, and the thread that plays. Nobody waits.
class SoundFeed {
public:
    static constexpr int kRate = 48'000;  // samples a second

    SoundFeed() : synthesis_(kRate) {}

    /// What the next attempt has to be heard; nothing: silence from now on. The session's thread.
    void plan(const SoundPlan& plan);
    loop::ScreenRing& ring() { return ring_; }

    /// The next samples. The thread that plays.
    void fill(std::span<float> samples);

    /// Who plays says where; none: nobody does. Any thread.
    void setOutput(std::optional<SoundOutput> output);
    std::optional<SoundOutput> output() const;

private:
    loop::ScreenRing ring_{4096};
    loop::Mailbox<SoundPlan> plans_{SoundPlan{}};
    Synthesis synthesis_;
    std::int64_t last_tick_ = -1;
    mutable std::mutex mutex_;  // of what follows
    std::optional<SoundOutput> output_;
};

}  // namespace passung::sound
