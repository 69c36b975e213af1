#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/session/answer_sheet.h"
#include "study/session/questionnaire_source.h"

namespace passung::session {

/// A form while a person fills it, item after item in the order in which it presents them. Whoever shows it says what
/// time it is, in ms from anywhere; nothing here waits or shows anything.
class FormFilling {
public:
    FormFilling(const ShownQuestionnaire& form, std::int64_t now_ms);

    /// True once every item was answered or left out; back() still leads to the last one.
    bool atEnd() const { return shown_ == form_.order.size(); }
    /// How many items come before the one that is shown.
    std::size_t shown() const { return shown_; }
    /// The item that is shown. @pre not atEnd()
    const questionnaire::Item& item() const { return items()[form_.order[shown_]]; }
    /// What was answered to it; missing if nothing yet. @pre not atEnd()
    const questionnaire::Answer& answer() const { return sheet_.answer(form_.order[shown_]); }
    const ShownQuestionnaire& form() const { return form_; }

    /// Answers the item that is shown and shows the next one. A missing answer leaves it out. Returns what is wrong
    /// with the answer, and then nothing has changed; empty: nothing. @pre not atEnd()
    std::string give(questionnaire::Answer answer, std::int64_t now_ms);

    /// Shows the item before; false at the first one.
    bool back(std::int64_t now_ms);

    /// @pre atEnd()
    FilledForm filled(std::string answered_by) const { return {sheet_.answers(), std::move(answered_by)}; }

private:
    const std::vector<questionnaire::Item>& items() const { return form_.planned.definition.items; }
    void show(std::size_t shown, std::int64_t now_ms);

    ShownQuestionnaire form_;
    std::size_t shown_ = 0;
    AnswerSheet sheet_;
};

}  // namespace passung::session
