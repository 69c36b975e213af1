#pragma once

#include <cstdint>

#include "core/loop/haptic_loop.h"
#include "devices/simulated/simulated_device.h"
#include "study/measures/cues.h"
#include "study/session/apparatus.h"

namespace passung::run {

/// Hands a simulated person the cues of the running attempt, tick by tick, and counts them. Colour comes with the
/// pictures (loop::hasPicture), so that it stands between them; noise over the headphones covers every sound. rt-safe.
class CueDelivery final : public loop::TickListener {
public:
    /// `person`: null where nobody simulated holds the device. `driven`: the device can push a hand.
    CueDelivery(const measures::CueSettings& cues, simulated::SimulatedDevice* person, bool driven);

    void take(const TickRecord& record) noexcept override;

    /// Pictures and ticks so far with more than nothing to be given: what a simulated person was handed, for anybody
    /// else what was asked for. Read when no tick runs.
    const session::Delivered& asked() const { return asked_; }

private:
    measures::CueSettings settings_;
    measures::CueSignals signals_;
    simulated::SimulatedDevice* person_;
    bool driven_;
    simulated::GivenCues given_;
    session::Delivered asked_;
};

}  // namespace passung::run
