#include "ui/window/interview.h"

#include <chrono>
#include <utility>

namespace passung::window {

namespace {

constexpr auto kMoment = std::chrono::milliseconds(20);

presenter::FormRequest requestOf(const session::ShownQuestionnaire& form) {
    return {form.id(), false, form.planned.definition, form.order};
}

presenter::FormRequest requestOf(const plan::ConsentClause& clause, const std::string& text) {
    questionnaire::Item item;
    item.id = clause.clause;
    item.text = text;
    item.response.kind = questionnaire::AnswerKind::Choice;
    item.response.options = {{1.0, ""}, {0.0, ""}};
    presenter::FormRequest request{"consent|" + clause.clause, true, {}, {0}};
    request.definition.items = {std::move(item)};
    return request;
}

}  // namespace

void Interview::forget() {
    form_.clear();
    page_.clear();
}

void Interview::ask(presenter::News what) {
    {
        const std::lock_guard lock(mutex_);
        filled_.reset();
        read_.reset();
        goes_on_ = false;
    }
    tell_(std::move(what));
}

/// What is held, once something is; gives it a moment to come.
template <class Held>
std::optional<Held> Interview::take(std::optional<Held>& held) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kMoment, [&held] { return held.has_value(); });
    return std::exchange(held, std::nullopt);
}

std::optional<bool> Interview::consent(const plan::ConsentClause& clause, const std::string& text,
                                       const std::function<bool()>& stop) {
    const auto request = std::make_shared<const presenter::FormRequest>(requestOf(clause, text));
    ask(presenter::FormDue{request});
    while (!stop()) {
        const auto decided = take(filled_);
        if (!decided || decided->first != request->id) continue;
        tell_(presenter::AskedDone{});
        return decided->second.answers.front().answer.number == 1.0;
    }
    return std::nullopt;
}

std::optional<session::FilledForm> Interview::fill(const session::ShownQuestionnaire& form) {
    if (std::exchange(form_, form.id()) != form_)
        ask(presenter::FormDue{std::make_shared<const presenter::FormRequest>(requestOf(form))});
    auto filled = take(filled_);
    if (!filled || filled->first != form_) return std::nullopt;
    forget();
    tell_(presenter::AskedDone{});
    return std::move(filled->second);
}

void Interview::withdraw() {
    forget();
    tell_(presenter::AskedDone{});
}

std::optional<session::PageRead> Interview::read(const session::Page& page) {
    if (std::exchange(page_, page.id) != page.id) ask(presenter::PageDue{++pages_, page.text, page.picture});
    const auto read = take(read_);
    if (!read || read->first != pages_) return std::nullopt;
    forget();
    tell_(presenter::AskedDone{});
    return session::PageRead{"participant", read->second};
}

bool Interview::goesOn() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kMoment, [this] { return goes_on_; });
    return std::exchange(goes_on_, false);
}

void Interview::handIn(const std::string& form, session::FilledForm filled) {
    const std::lock_guard lock(mutex_);
    filled_ = {form, std::move(filled)};
    changed_.notify_all();
}

void Interview::pageRead(std::int64_t number, std::int64_t read_ms) {
    const std::lock_guard lock(mutex_);
    read_ = {number, read_ms};
    changed_.notify_all();
}

void Interview::goOn() {
    const std::lock_guard lock(mutex_);
    goes_on_ = true;
    changed_.notify_all();
}

}  // namespace passung::window
