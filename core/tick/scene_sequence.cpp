#include "core/tick/scene_sequence.h"

namespace passung::tick {

SceneSequence::SceneSequence(std::span<const SceneTurn> turns) : turns_(turns.begin(), turns.end()) {
    states_.reserve(turns_.size());
    for (const SceneTurn& turn : turns_) states_.push_back(makeState(*turn.model));
}

std::vector<PairAccount> SceneSequence::pairs() const {
    std::vector<PairAccount> all;
    for (const TickState& state : states_) all.insert(all.end(), state.pairs.begin(), state.pairs.end());
    return all;
}

TickOutput SceneSequence::step(const DeviceReading& reading) noexcept {
    if (engaged_) rendered_ += reading.periods;
    if (engaged_ && rendered_ >= turns_[current_].periods && current_ + 1 < turns_.size()) {
        const TickState& before = states_[current_];
        TickState& next = states_[++current_];
        next.tick = before.tick;
        next.hash = before.hash;
        engaged_ = false;
        rendered_ = 0;
    }
    const TickOutput output = tick::step(*turns_[current_].model, states_[current_], reading);
    engaged_ = engaged_ || (output.frame.status & kEngaged) != 0;
    return output;
}

}  // namespace passung::tick
