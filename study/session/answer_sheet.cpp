#include "study/session/answer_sheet.h"

#include <utility>

#include "core/base/assert.h"

namespace passung::session {

void AnswerSheet::show(std::size_t item, std::int64_t now_ms) {
    if (first_shown_ms_[item] == kNotYet) first_shown_ms_[item] = now_ms;
}

std::string AnswerSheet::give(const questionnaire::Item& item, std::size_t i, questionnaire::Answer answer,
                              std::int64_t now_ms) {
    PASSUNG_ASSERT(first_shown_ms_[i] != kNotYet);
    std::string fault = questionnaire::answerFault(item, answer);
    if (!fault.empty()) return fault;
    ItemAnswer& given = answers_[i];
    const bool same = given.answer.number == answer.number && given.answer.text == answer.text;
    if (!given.answer.missing() && !same) ++given.changes;
    if (!given.response_ms || !same) given.response_ms = now_ms - first_shown_ms_[i];
    given.answer = std::move(answer);
    return {};
}

}  // namespace passung::session
