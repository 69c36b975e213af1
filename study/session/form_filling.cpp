#include "study/session/form_filling.h"

#include <utility>

#include "core/base/assert.h"

namespace passung::session {
namespace {

constexpr std::int64_t kNotYet = -1;

}  // namespace

FormFilling::FormFilling(const Form& form, std::int64_t now_ms)
    : form_(form), answers_(items().size()), first_shown_ms_(items().size(), kNotYet) {
    show(0, now_ms);
}

void FormFilling::show(std::size_t shown, std::int64_t now_ms) {
    shown_ = shown;
    if (atEnd()) return;
    std::int64_t& first = first_shown_ms_[form_.order[shown_]];
    if (first == kNotYet) first = now_ms;
}

std::string FormFilling::give(questionnaire::Answer answer, std::int64_t now_ms) {
    PASSUNG_ASSERT(!atEnd());
    const std::string fault = questionnaire::answerFault(item(), answer);
    if (!fault.empty()) return fault;
    const std::size_t i = form_.order[shown_];
    ItemAnswer& given = answers_[i];
    const bool same = given.answer.number == answer.number && given.answer.text == answer.text;
    if (!given.answer.missing() && !same) ++given.changes;
    if (!given.response_ms || !same) given.response_ms = now_ms - first_shown_ms_[i];
    given.answer = std::move(answer);
    show(shown_ + 1, now_ms);
    return {};
}

bool FormFilling::back(std::int64_t now_ms) {
    if (shown_ == 0) return false;
    show(shown_ - 1, now_ms);
    return true;
}

}  // namespace passung::session
