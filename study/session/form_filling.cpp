#include "study/session/form_filling.h"

#include <utility>

#include "core/base/assert.h"

namespace passung::session {

FormFilling::FormFilling(const ShownQuestionnaire& form, std::int64_t now_ms) : form_(form), sheet_(items().size()) {
    show(0, now_ms);
}

void FormFilling::show(std::size_t shown, std::int64_t now_ms) {
    shown_ = shown;
    if (!atEnd()) sheet_.show(form_.order[shown_], now_ms);
}

std::string FormFilling::give(questionnaire::Answer answer, std::int64_t now_ms) {
    PASSUNG_ASSERT(!atEnd());
    std::string fault = sheet_.give(item(), form_.order[shown_], std::move(answer), now_ms);
    if (fault.empty()) show(shown_ + 1, now_ms);
    return fault;
}

bool FormFilling::back(std::int64_t now_ms) {
    if (shown_ == 0) return false;
    show(shown_ - 1, now_ms);
    return true;
}

}  // namespace passung::session
