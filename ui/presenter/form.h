#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/questionnaire/definition.h"
#include "study/session/answer_sheet.h"

namespace passung::presenter {

/// Questions for the participant: a questionnaire, or a clause of consent, which is one item whose options mean yes and
/// no by their values 1 and 0.
struct FormRequest {
    std::string id;
    bool consent = false;
    questionnaire::Definition definition;
    std::vector<std::size_t> order;  // items as presented
};

/// How an item is answered on a screen.
enum class ItemControl {
    Points,    // a rating of few points, each to be picked
    Ticks,     // of many: a scale with a mark for each, such as the 21 of the NASA-TLX
    Line,      // without steps, or of very many: a visual analogue scale
    Options,   // labelled, side by side or below one another
    Pair,      // two cards
    Decision,  // yes or no
    Number,
    Text,
};

enum class FormFault { None, NoNumber, OutOfRange };

/// An item on the page that is shown.
struct FormRow {
    std::size_t number = 0;  // as presented, from 1
    ItemControl control = ItemControl::Points;
    std::string text, low_anchor, high_anchor;
    std::vector<std::string> labels;    // of points, options or the pair; of a decision two without words
    std::optional<std::size_t> picked;  // of the labels
    double low = 0.0, high = 0.0;       // Ticks, Line, Number
    int ticks = 0;                      // Ticks: how many
    std::optional<double> value;
    std::string typed;
    FormFault fault = FormFault::None;
    bool open = false;    // was pointed out: not answered yet
    bool beside = false;  // short options stand side by side
};

struct FormView {
    std::string title, instruction;
    bool consent = false;
    std::size_t page = 0, pages = 1;
    std::vector<FormRow> rows;
    std::size_t focus = 0;  // the row that keys are for; rows.size(): the button that goes on
    std::size_t open = 0;   // rows that were pointed out as not answered
    double share = 0.0;     // of the items that are answered
    bool last() const { return page + 1 == pages; }
};

/// A form while a person fills it: which items share a page, what each key, click and button of the device means, what
/// may be left out, what is counted. Knows no window and no clock: whoever shows it says what time it is, in ms from
/// anywhere.
///
/// Missing answers: whoever goes on from a page with open items is told of them once, and going on again leaves them
/// out; a clause of consent has to be decided. What is typed and cannot be an answer has to be put right or cleared.
class Form {
public:
    Form(std::shared_ptr<const FormRequest> request, std::int64_t now_ms);

    FormView view() const;
    const FormRequest& request() const { return *request_; }
    bool isDone() const { return done_; }
    /// @pre isDone()
    session::FilledForm filled(std::string answered_by) const { return {sheet_.answers(), std::move(answered_by)}; }

    // `row`: on the page.
    /// A click or a digit; of a pair it turns the page.
    void pick(std::size_t row, std::size_t label, std::int64_t now_ms);
    /// The admissible answer next to `value`.
    void place(std::size_t row, double value, std::int64_t now_ms);
    /// What stands in the field now; it is an answer once the focus moves or the page turns.
    void type(std::size_t row, std::string text, std::int64_t now_ms);
    /// The next answer up or down; without one yet, the middle one.
    void step(std::size_t row, int by, std::int64_t now_ms);
    /// To the lowest or highest answer.
    void end(std::size_t row, bool high, std::int64_t now_ms);
    /// The answer of this number where answers have numbers, else the label of this number from 1, else so many tenths
    /// of the scale. False: none.
    bool digit(std::size_t row, int digit, std::int64_t now_ms);
    void focus(std::size_t row);

    /// From an item to the one below it, then to the button.
    void enter();
    void next(std::int64_t now_ms);
    void back(std::int64_t now_ms);
    /// A button of the haptic device went down, from 1: the first changes the answer that has the focus, round and
    /// round, the second goes on.
    void button(int number, std::int64_t now_ms);

    /// Time does not count while the form cannot be seen.
    void hide(std::int64_t now_ms);
    void unhide(std::int64_t now_ms);

private:
    struct Draft {
        std::string text;
        std::int64_t typed_ms = 0;
        bool changed = false;
        FormFault fault = FormFault::None;
    };

    void layOut();
    void turnTo(std::size_t page, std::int64_t now_ms);
    std::size_t itemOf(std::size_t row) const { return request_->order[starts_[page_] + row]; }
    std::size_t rowCount() const { return starts_[page_ + 1] - starts_[page_]; }
    const questionnaire::Item& item(std::size_t i) const { return request_->definition.items[i]; }
    FormRow rowOf(std::size_t row) const;
    void choose(std::size_t row, std::size_t label, std::int64_t now_ms);
    void give(std::size_t i, double number, std::int64_t now_ms);
    void commitPage();
    void commit(std::size_t i);
    bool isOpen(std::size_t row) const;
    std::int64_t seen(std::int64_t now_ms) const { return (hidden_ms_ ? *hidden_ms_ : now_ms) - unseen_ms_; }

    std::shared_ptr<const FormRequest> request_;  // shared_ptr: the news that brought it keeps it too
    session::AnswerSheet sheet_;
    std::vector<Draft> drafts_;        // by item
    std::vector<std::size_t> starts_;  // of the pages in the presented order, and its end
    std::size_t page_ = 0, focus_ = 0;
    bool told_ = false;  // of the open items of this page
    bool done_ = false;
    std::optional<std::int64_t> hidden_ms_;
    std::int64_t unseen_ms_ = 0;
};

}  // namespace passung::presenter
