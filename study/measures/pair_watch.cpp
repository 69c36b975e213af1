#include "study/measures/pair_watch.h"

namespace passung::measures {

void PairWatch::enter(Phase phase, std::int64_t time) {
    phase_ = phase;
    since_ = time;
}

void PairWatch::follow(const TickRecord& record, std::int64_t time) {
    const std::uint32_t pressed = buttons_.pressedIn(record) & 3u;
    const bool engaged = (record.status & kEngaged) != 0;
    switch (phase_) {
        case Phase::First:
            if (!engaged) enter(Phase::Between, time);
            break;
        case Phase::Between:
            if (engaged) enter(Phase::Second, time);
            break;
        case Phase::Second:
            if (engaged) break;
            asked_ = time;
            enter(Phase::Question, time);
            break;
        case Phase::Question:
            if (pressed != 1u && pressed != 2u) break;
            answer_ = static_cast<int>(pressed);
            enter(Phase::Answered, time);
            break;
        case Phase::Answered:
            break;
    }
}

}  // namespace passung::measures
