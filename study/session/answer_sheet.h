#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/session/questionnaire_source.h"

namespace passung::session {

/// What a person has answered to a questionnaire's items so far, how long each answer took and how often it was
/// changed. Whoever shows the items says what time it is, in ms from anywhere.
class AnswerSheet {
public:
    explicit AnswerSheet(std::size_t items) : answers_(items), first_shown_ms_(items, kNotYet) {}

    /// The item is on the screen; only the first time counts.
    void show(std::size_t item, std::int64_t now_ms);
    /// Answers the item number `i`. A missing answer leaves it out. Returns what is wrong with it, and then nothing has
    /// changed; empty: nothing. @pre it was shown
    std::string give(const questionnaire::Item& item, std::size_t i, questionnaire::Answer answer, std::int64_t now_ms);

    const questionnaire::Answer& answer(std::size_t item) const { return answers_[item].answer; }
    const std::vector<ItemAnswer>& answers() const { return answers_; }

private:
    static constexpr std::int64_t kNotYet = -1;

    std::vector<ItemAnswer> answers_;
    std::vector<std::int64_t> first_shown_ms_;
};

}  // namespace passung::session
