#pragma once

#include "core/base/tick_record.h"
#include "study/measures/period_clock.h"

namespace passung::measures {

/// What commands a condition's cues have; see plan::Cues.
struct CueSettings {
    bool visual = false, vibration = false, sound = false;
    double full_depth = 0.002;  // [m], > 0
    double full_speed = 0.1;    // [m/s], > 0
    double sound_decay = 0.05;  // [s], > 0
    bool masking = false;       // noise all the time
};

/// Commands of the cues in one tick, each from 0 to 1; 0 for what the condition does not have.
struct CueCommands {
    double visual = 0.0;
    double vibration = 0.0;
    double sound = 0.0;
};

/// The commands that follow from the ticks of one attempt, in order:
///   visual    = vibration = min(1, hand depth / full_depth)
///   sound     = max over the impacts so far of min(1, speed / full_speed) · exp(-time since / sound_decay)
/// An impact is a tick in contact after one without; its speed is how far the hand came since that tick, by the time
/// between them. A tick that was not recorded counts as one period.
class CueSignals {
public:
    explicit CueSignals(const CueSettings& settings) : settings_(settings) {}

    CueCommands at(const TickRecord& record);

private:
    CueSettings settings_;
    PeriodClock clock_;
    bool known_ = false;  // a tick before
    bool touching_ = false;
    Vec3 position_ = Vec3::Zero();
    double time_ = 0.0;   // [s]
    double sound_ = 0.0;  // at time_
};

}  // namespace passung::measures
