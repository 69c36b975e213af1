#include "study/run/person/simulated_timer.h"

#include <cmath>

#include "core/base/random.h"
#include "core/base/tick_record.h"

namespace passung::run {

void SimulatedTimer::begin(const plan::Condition&, std::uint64_t seed, std::int64_t trials_before) {
    std::uint64_t state = seed ^ fnv1a64("real parts");
    Random random(splitmix64(state));
    trial_ = person::realTrial(person_, trials_before, random);
    started_ = ended_ = false;
}

std::optional<session::Command> SimulatedTimer::commandAt(std::int64_t periods) {
    using session::CommandKind;
    const auto say = [](CommandKind kind) { return session::Command{.kind = kind, .source = "simulated"}; };
    if (!started_ && periods >= kStart) {
        started_ = true;
        return say(CommandKind::Start);
    }
    if (!started_ || ended_ || periods < kStart + std::llround(trial_.time / kTickSeconds)) return std::nullopt;
    ended_ = true;
    return say(trial_.success ? CommandKind::Done : CommandKind::Failed);
}

}  // namespace passung::run
