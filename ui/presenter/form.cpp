#include "ui/presenter/form.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/base/assert.h"

namespace passung::presenter {

using questionnaire::Answer;
using questionnaire::AnswerKind;
using questionnaire::Item;
using questionnaire::Response;

namespace {

constexpr int kMostPoints = 11, kMostTicks = 41;
constexpr double kPage = 6.0;  // rows of a scale that fit on a page
constexpr std::size_t kMostBeside = 5, kBesideLetters = 90;

/// Answers of a rating or number; 0: any value in between.
int stepsOf(const Response& response) {
    if (!(response.step > 0.0)) return 0;
    return static_cast<int>(std::lround((response.high - response.low) / response.step)) + 1;
}

bool isBeside(const Response& response) {
    std::size_t letters = 0;
    for (const auto& option : response.options) letters += option.label.size();
    return response.options.size() <= kMostBeside && letters <= kBesideLetters;
}

ItemControl controlOf(const Item& item, bool consent) {
    if (consent) return ItemControl::Decision;
    switch (item.response.kind) {
        case AnswerKind::Choice:
            return ItemControl::Options;
        case AnswerKind::Number:
            return ItemControl::Number;
        case AnswerKind::Text:
            return ItemControl::Text;
        case AnswerKind::Pair:
            return ItemControl::Pair;
        case AnswerKind::Rating:
            break;
    }
    const int steps = stepsOf(item.response);
    if (steps == 0 || steps > kMostTicks) return ItemControl::Line;
    return steps <= kMostPoints ? ItemControl::Points : ItemControl::Ticks;
}

/// Height of a row in those of a scale.
double heightOf(const Item& item, ItemControl control) {
    switch (control) {
        case ItemControl::Pair:
        case ItemControl::Decision:
            return kPage;
        case ItemControl::Text:
            return 2.0;
        case ItemControl::Options:
            return isBeside(item.response) ? 1.0 : 0.5 + 0.5 * static_cast<double>(item.response.options.size());
        case ItemControl::Points:
        case ItemControl::Ticks:
        case ItemControl::Line:
        case ItemControl::Number:
            break;
    }
    return 1.0;
}

/// The answer of a rating next to `value`.
double nearest(const Response& response, double value) {
    const double inside = std::clamp(value, response.low, response.high);
    if (!(response.step > 0.0)) return inside;
    return std::min(response.high, response.low + response.step * std::round((inside - response.low) / response.step));
}

/// The whole text as a number, with a point or a comma.
std::optional<double> numberOf(std::string text) {
    std::replace(text.begin(), text.end(), ',', '.');
    double value = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// What a label means: of a point its value, of an option its own, of a pair 0 or 1.
double valueOf(const Item& item, ItemControl control, std::size_t label) {
    if (control == ItemControl::Points) return item.response.low + item.response.step * static_cast<double>(label);
    if (control == ItemControl::Pair) return static_cast<double>(label);
    return item.response.options[label].value;
}

}  // namespace

Form::Form(std::shared_ptr<const FormRequest> request, std::int64_t now_ms)
    : request_(std::move(request)),
      sheet_(request_->definition.items.size()),
      drafts_(request_->definition.items.size()) {
    PASSUNG_ASSERT(!request_->order.empty());
    layOut();
    turnTo(0, now_ms);
}

/// Pages as equal as they can be without one that is too full.
void Form::layOut() {
    const auto& order = request_->order;
    const auto height = [this](std::size_t i) { return heightOf(item(i), controlOf(item(i), request_->consent)); };
    double total = 0.0;
    for (const std::size_t i : order) total += height(i);
    const double fair = std::ceil(total / std::ceil(total / kPage));
    double used = 0.0;
    starts_ = {0};
    for (std::size_t shown = 0; shown < order.size(); ++shown) {
        if (used > 0.0 && used + height(order[shown]) > fair) {
            starts_.push_back(shown);
            used = 0.0;
        }
        used += height(order[shown]);
    }
    starts_.push_back(order.size());
}

void Form::turnTo(std::size_t page, std::int64_t now_ms) {
    page_ = page;
    focus_ = 0;
    told_ = false;
    for (std::size_t row = 0; row < rowCount(); ++row) sheet_.show(itemOf(row), seen(now_ms));
}

bool Form::isOpen(std::size_t row) const { return sheet_.answer(itemOf(row)).missing(); }

FormRow Form::rowOf(std::size_t row) const {
    const std::size_t i = itemOf(row);
    const Item& asked = item(i);
    const Response& response = asked.response;
    FormRow shown;
    shown.number = starts_[page_] + row + 1;
    shown.control = controlOf(asked, request_->consent);
    shown.text = asked.text;
    shown.low_anchor = response.low_anchor;
    shown.high_anchor = response.high_anchor;
    shown.low = response.low;
    shown.high = response.high;
    shown.value = sheet_.answer(i).number;
    shown.typed = drafts_[i].text;
    shown.fault = drafts_[i].fault;
    shown.open = told_ && isOpen(row);
    shown.beside = isBeside(response);
    const int steps = stepsOf(response);
    if (shown.control == ItemControl::Ticks) shown.ticks = steps;
    if (shown.control == ItemControl::Points)
        for (int point = 0; point < steps; ++point)
            shown.labels.push_back(fmt::format("{:g}", response.low + point * response.step));
    if (shown.control == ItemControl::Decision) shown.labels.resize(response.options.size());
    if (shown.control == ItemControl::Options)
        for (const auto& option : response.options) shown.labels.push_back(option.label);
    if (shown.control == ItemControl::Pair) shown.labels = {item(asked.of.first).text, item(asked.of.second).text};
    for (std::size_t label = 0; label < shown.labels.size() && shown.value; ++label)
        if (std::abs(valueOf(asked, shown.control, label) - *shown.value) < 1e-9) shown.picked = label;
    return shown;
}

FormView Form::view() const {
    FormView view;
    view.title = request_->definition.title;
    view.instruction = request_->definition.instruction;
    view.consent = request_->consent;
    view.page = page_;
    view.pages = starts_.size() - 1;
    view.focus = focus_;
    for (std::size_t row = 0; row < rowCount(); ++row) {
        view.rows.push_back(rowOf(row));
        view.open += view.rows.back().open ? 1 : 0;
    }
    const auto& answers = sheet_.answers();
    const auto answered = std::count_if(answers.begin(), answers.end(),
                                        [](const session::ItemAnswer& given) { return !given.answer.missing(); });
    view.share = static_cast<double>(answered) / static_cast<double>(answers.size());
    return view;
}

void Form::give(std::size_t i, double number, std::int64_t now_ms) {
    const std::string fault = sheet_.give(item(i), i, Answer{number, ""}, seen(now_ms));
    PASSUNG_ASSERT(fault.empty());
}

void Form::choose(std::size_t row, std::size_t label, std::int64_t now_ms) {
    const FormRow shown = rowOf(row);
    if (done_ || label >= shown.labels.size()) return;
    focus(row);
    give(itemOf(row), valueOf(item(itemOf(row)), shown.control, label), now_ms);
}

void Form::pick(std::size_t row, std::size_t label, std::int64_t now_ms) {
    choose(row, label, now_ms);
    // A pair has a page of its own: nothing is left to do there, except at the end of the form.
    if (rowOf(row).control == ItemControl::Pair && !isOpen(row) && page_ + 2 < starts_.size())
        turnTo(page_ + 1, now_ms);
}

void Form::place(std::size_t row, double value, std::int64_t now_ms) {
    if (done_ || !std::isfinite(value)) return;
    focus(row);
    give(itemOf(row), nearest(item(itemOf(row)).response, value), now_ms);
}

void Form::type(std::size_t row, std::string text, std::int64_t now_ms) {
    Draft& draft = drafts_[itemOf(row)];
    if (draft.text == text) return;
    draft = {std::move(text), seen(now_ms), true, FormFault::None};
}

/// What was typed into the item becomes its answer, if it can be one.
void Form::commit(std::size_t i) {
    Draft& draft = drafts_[i];
    if (!std::exchange(draft.changed, false)) return;
    const std::string text = trimmed(draft.text);
    Answer answer;
    if (item(i).response.kind == AnswerKind::Text) answer.text = text;
    if (item(i).response.kind == AnswerKind::Number && !text.empty()) {
        answer.number = numberOf(text);
        if (!answer.number) draft.fault = FormFault::NoNumber;
    }
    if (draft.fault == FormFault::None && !sheet_.give(item(i), i, answer, draft.typed_ms).empty())
        draft.fault = FormFault::OutOfRange;
    if (draft.fault != FormFault::None) static_cast<void>(sheet_.give(item(i), i, {}, draft.typed_ms));
}

void Form::commitPage() {
    for (std::size_t row = 0; row < rowCount(); ++row) commit(itemOf(row));
}

void Form::step(std::size_t row, int by, std::int64_t now_ms) {
    const FormRow shown = rowOf(row);
    const Response& response = item(itemOf(row)).response;
    if (!shown.labels.empty()) {
        const auto last = static_cast<int>(shown.labels.size()) - 1;
        const int now = shown.picked ? static_cast<int>(*shown.picked) + by : by > 0 ? 0 : last;
        if (shown.control == ItemControl::Points && !shown.picked)
            return choose(row, static_cast<std::size_t>(last / 2), now_ms);
        return choose(row, static_cast<std::size_t>(std::clamp(now, 0, last)), now_ms);
    }
    if (shown.control != ItemControl::Ticks && shown.control != ItemControl::Line) return;
    const double width = shown.control == ItemControl::Line ? 0.01 * (response.high - response.low) : response.step;
    place(row, shown.value ? *shown.value + by * width : 0.5 * (response.low + response.high), now_ms);
}

void Form::end(std::size_t row, bool high, std::int64_t now_ms) {
    const FormRow shown = rowOf(row);
    if (!shown.labels.empty()) return choose(row, high ? shown.labels.size() - 1 : 0, now_ms);
    if (shown.control == ItemControl::Ticks || shown.control == ItemControl::Line)
        place(row, high ? shown.high : shown.low, now_ms);
}

bool Form::digit(std::size_t row, int digit, std::int64_t now_ms) {
    const FormRow shown = rowOf(row);
    if (shown.control == ItemControl::Points) {
        const auto named = std::find(shown.labels.begin(), shown.labels.end(), std::to_string(digit));
        const bool numbers = item(itemOf(row)).response.low >= 0.0;  // else the first point is number 1
        if (numbers && named == shown.labels.end()) return false;
        if (numbers) digit = static_cast<int>(named - shown.labels.begin()) + 1;
    }
    if (!shown.labels.empty()) {
        if (digit < 1 || digit > static_cast<int>(shown.labels.size())) return false;
        pick(row, static_cast<std::size_t>(digit - 1), now_ms);
        return true;
    }
    if (shown.control != ItemControl::Ticks && shown.control != ItemControl::Line) return false;
    place(row, shown.low + 0.1 * digit * (shown.high - shown.low), now_ms);
    return true;
}

void Form::focus(std::size_t row) {
    if (row != focus_) commitPage();
    focus_ = std::min(row, rowCount());
}

void Form::enter() { focus(focus_ + 1); }

void Form::next(std::int64_t now_ms) {
    if (done_) return;
    commitPage();
    std::optional<std::size_t> first_open;
    for (std::size_t row = rowCount(); row-- > 0;) {
        if (drafts_[itemOf(row)].fault != FormFault::None) {
            focus_ = row;
            return;
        }
        if (isOpen(row)) first_open = row;
    }
    if (first_open && (!told_ || request_->consent)) {
        told_ = true;
        focus_ = *first_open;
        return;
    }
    for (std::size_t row = 0; row < rowCount(); ++row)
        if (isOpen(row)) static_cast<void>(sheet_.give(item(itemOf(row)), itemOf(row), {}, seen(now_ms)));
    done_ = page_ + 2 == starts_.size();
    if (!done_) turnTo(page_ + 1, now_ms);
}

void Form::back(std::int64_t now_ms) {
    if (done_ || page_ == 0) return;
    commitPage();
    turnTo(page_ - 1, now_ms);
}

void Form::button(int number, std::int64_t now_ms) {
    if (done_) return;
    if (number == 2 && focus_ < rowCount()) return enter();
    if (number == 2) return next(now_ms);
    if (number != 1 || focus_ >= rowCount()) return;
    const FormRow shown = rowOf(focus_);
    const bool at_end = !shown.labels.empty() ? shown.picked == shown.labels.size() - 1 : shown.value == shown.high;
    if (at_end || (shown.labels.empty() ? !shown.value : !shown.picked)) return end(focus_, false, now_ms);
    step(focus_, 1, now_ms);
}

void Form::hide(std::int64_t now_ms) {
    if (!hidden_ms_) hidden_ms_ = now_ms;
}

void Form::unhide(std::int64_t now_ms) {
    if (hidden_ms_) unseen_ms_ += now_ms - *std::exchange(hidden_ms_, std::nullopt);
}

}  // namespace passung::presenter
