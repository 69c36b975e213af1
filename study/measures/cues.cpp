#include "study/measures/cues.h"

#include <algorithm>
#include <cmath>

#include "study/measures/tick_facts.h"

namespace passung::measures {

CueCommands CueSignals::at(const TickRecord& record) {
    const double time = static_cast<double>(clock_.at(record)) * kTickSeconds;
    const Vec3 position = handPosition(record);
    const bool touching = isContact(record);
    if (known_) {
        const double since = time - time_;
        sound_ *= std::exp(-since / settings_.sound_decay);
        if (touching && !touching_)
            sound_ = std::max(sound_, std::min(1.0, (position - position_).norm() / since / settings_.full_speed));
    }
    known_ = true;
    touching_ = touching;
    position_ = position;
    time_ = time;
    const double depth = std::min(1.0, static_cast<double>(record.hand_depth_m) / settings_.full_depth);
    return {settings_.visual ? depth : 0.0, settings_.vibration ? depth : 0.0, settings_.sound ? sound_ : 0.0};
}

}  // namespace passung::measures
