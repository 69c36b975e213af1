#include "study/run/cue_delivery.h"

#include <algorithm>

namespace passung::run {
namespace {

bool pushes(const TickRecord& record) noexcept {
    const auto some = [](const auto& values) {
        return std::any_of(values.begin(), values.end(), [](float value) { return value != 0.0f; });
    };
    return (record.status & kWrenchWithheld) == 0 && (some(record.force_N) || some(record.torque_Nm));
}

}  // namespace

CueDelivery::CueDelivery(const measures::CueSettings& cues, simulated::SimulatedDevice* person, bool driven)
    : settings_(cues), signals_(cues), person_(person), driven_(driven) {}

void CueDelivery::take(const TickRecord& record) noexcept {
    const measures::CueCommands commands = signals_.at(record);
    const bool picture = loop::hasPicture(record.tick);
    if (picture) given_.visual = commands.visual;
    given_.vibration = commands.vibration;
    given_.sound = settings_.masking ? 0.0 : commands.sound;
    asked_.force += driven_ && pushes(record) ? 1 : 0;
    asked_.visual += picture && given_.visual > 0.0 ? 1 : 0;
    asked_.vibration += commands.vibration > 0.0 ? 1 : 0;
    asked_.sound += commands.sound > 0.0 ? 1 : 0;
    asked_.masking += settings_.masking ? 1 : 0;
    if (person_ != nullptr) person_->notice(given_);
}

}  // namespace passung::run
