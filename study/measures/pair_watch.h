#pragma once

#include <cstdint>
#include <optional>

#include "core/base/tick_record.h"

namespace passung::measures {

/// Buttons of the device that went down in a tick: bit 0 the first button, bit 1 the second.
class ButtonWatch {
public:
    std::uint32_t pressedIn(const TickRecord& record) {
        const std::uint32_t down = record.input_flags >> 8;
        const std::uint32_t pressed = down & ~before_;
        before_ = down;
        return pressed;
    }

private:
    std::uint32_t before_ = 0;
};

/// A discrimination pair, record by record from its start tick on. The status bit kEngaged tells the intervals: the
/// first ends where it goes, the second lasts from its return until it goes again; then a button gives the answer. Both
/// buttons at once are none.
class PairWatch {
public:
    enum class Phase { First, Between, Second, Question, Answered };

    /// `time`: of the record [haptic periods, from any origin].
    void follow(const TickRecord& record, std::int64_t time);

    Phase phase() const { return phase_; }
    /// Time at which the phase began.
    std::int64_t since() const { return since_; }
    /// The interval that was named, 1 or 2. @pre phase() is Answered
    int answer() const { return answer_; }
    /// From the question to the answer [periods]. @pre phase() is Answered
    std::int64_t responsePeriods() const { return since_ - asked_; }

private:
    void enter(Phase phase, std::int64_t time);

    Phase phase_ = Phase::First;
    std::int64_t since_ = 0;
    std::int64_t asked_ = 0;
    int answer_ = 0;
    ButtonWatch buttons_;
};

}  // namespace passung::measures
