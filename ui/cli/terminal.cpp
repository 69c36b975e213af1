#include "ui/cli/terminal.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>

namespace passung::cli {

namespace {

using questionnaire::Answer;
using questionnaire::AnswerKind;
using questionnaire::Item;

constexpr int kWaitMilliseconds = 20;

std::int64_t steadyMilliseconds() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

void say(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

/// The whole line as a number, with a point or a comma.
std::optional<double> numberOf(std::string line) {
    std::replace(line.begin(), line.end(), ',', '.');
    double value = 0.0;
    const auto [end, problem] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (problem != std::errc() || end != line.data() + line.size()) return std::nullopt;
    return value;
}

/// What a line means as an answer; nothing if the item cannot be answered so.
std::optional<Answer> answerOf(const Item& item, const std::string& line) {
    if (item.response.kind == AnswerKind::Text) return Answer{std::nullopt, line};
    const auto number = numberOf(line);
    if (!number) return std::nullopt;
    const bool numbered = item.response.kind == AnswerKind::Choice || item.response.kind == AnswerKind::Pair;
    if (!numbered) return Answer{*number, ""};
    if (item.response.kind == AnswerKind::Pair) return Answer{*number - 1.0, ""};
    for (std::size_t i = 0; i < item.response.options.size(); ++i)
        if (*number == static_cast<double>(i + 1)) return Answer{item.response.options[i].value, ""};
    return std::nullopt;
}

/// How the item is to be answered, in a line or several.
std::string waysToAnswer(const session::FormFilling& filling) {
    const auto& definition = filling.form().planned.definition;
    const questionnaire::Response& response = filling.item().response;
    const std::string range = fmt::format(
        "    {:g} to {:g}{}", response.low, response.high,
        response.step == 1.0 || !(response.step > 0.0) ? "" : fmt::format(", steps of {:g}", response.step));
    switch (response.kind) {
        case AnswerKind::Rating:
            return fmt::format("{}   ({:g}: {}, {:g}: {})\n", range, response.low, response.low_anchor, response.high,
                               response.high_anchor);
        case AnswerKind::Number:
            return range + "\n";
        case AnswerKind::Choice: {
            std::string text;
            for (std::size_t i = 0; i < response.options.size(); ++i)
                text += fmt::format("    {}: {}\n", i + 1, response.options[i].label);
            return text;
        }
        case AnswerKind::Pair:
            return fmt::format("    1: {}\n    2: {}\n", definition.items[filling.item().of.first].text,
                               definition.items[filling.item().of.second].text);
        case AnswerKind::Text:
            break;
    }
    return {};
}

}  // namespace

std::optional<std::string> Terminal::line() {
    const auto take = [this](std::size_t length, std::size_t with_end) {
        std::string line = pending_.substr(0, length);
        pending_.erase(0, with_end);
        if (line.ends_with('\r')) line.pop_back();
        return line;
    };
    if (const std::size_t end = pending_.find('\n'); end != std::string::npos) return take(end, end + 1);
    pollfd waiting{STDIN_FILENO, POLLIN, 0};
    if (ended_ || poll(&waiting, 1, kWaitMilliseconds) <= 0) return std::nullopt;
    std::array<char, 1024> buffer;
    const ssize_t count = read(STDIN_FILENO, buffer.data(), buffer.size());
    if (count > 0) {
        pending_.append(buffer.data(), static_cast<std::size_t>(count));
        if (const std::size_t end = pending_.find('\n'); end != std::string::npos) return take(end, end + 1);
        return std::nullopt;
    }
    ended_ = true;
    return std::nullopt;
}

void TerminalAnswers::begin(const session::ShownQuestionnaire& form) {
    filling_ = std::make_unique<session::FormFilling>(form, steadyMilliseconds());
    leaves_out_ = false;
    const auto& definition = form.planned.definition;
    say(fmt::format("\n== {} ==\n{}{}", definition.title, definition.instruction,
                    definition.instruction.empty() ? "" : "\n"));
    prompt();
}

void TerminalAnswers::prompt() const {
    if (filling_->atEnd()) return say("\nAll items are answered or left out. Enter: done; <: back\n> ");
    const Item& item = filling_->item();
    const Answer& given = filling_->answer();
    std::string kept;
    if (given.number)
        kept = item.response.kind == AnswerKind::Rating || item.response.kind == AnswerKind::Number
                   ? fmt::format("    Enter keeps {:g}\n", *given.number)
                   : "    Enter keeps your answer\n";
    else if (!given.missing())
        kept = "    Enter keeps \"" + given.text + "\"\n";
    say(fmt::format("\n{}/{}  {}\n{}{}> ", filling_->shown() + 1, filling_->form().order.size(), item.text,
                    waysToAnswer(*filling_), kept));
}

/// The line answers the item that is shown, or leaves it out, or leads back.
void TerminalAnswers::takeAnswer(const std::string& line) {
    const std::int64_t now = steadyMilliseconds();
    if (line.empty() && filling_->answer().missing() && !leaves_out_) {
        leaves_out_ = true;
        return say("    Enter once more leaves it out\n> ");
    }
    const auto answer = line.empty() ? filling_->answer() : answerOf(filling_->item(), line);
    const std::string fault = answer ? filling_->give(*answer, now) : "must be one of the numbers";
    if (!fault.empty()) return say("    " + fault + "\n> ");
    leaves_out_ = false;
    prompt();
}

/// True if the form is done.
bool TerminalAnswers::take(const std::string& line) {
    if (line == "<") {
        leaves_out_ = false;
        filling_->back(steadyMilliseconds());
        prompt();
    } else if (filling_->atEnd()) {
        if (line.empty()) return true;
        prompt();
    } else {
        takeAnswer(line);
    }
    return false;
}

std::optional<session::FilledForm> TerminalAnswers::fill(const session::ShownQuestionnaire& form) {
    if (!filling_ || filling_->form().id() != form.id()) begin(form);
    const auto line = terminal_.line();
    if (!line || !take(*line)) return std::nullopt;
    return std::exchange(filling_, nullptr)->filled(answered_by_);
}

std::optional<session::PageRead> TerminalReader::read(const session::Page& page) {
    if (open_ != page.id) {
        open_ = page.id;
        since_ms_ = steadyMilliseconds();
        const std::string picture = page.picture.empty() ? "" : fmt::format("    picture: {}\n", page.picture);
        say(fmt::format("\n{}\n{}    Enter: read\n> ", page.text, picture));
    }
    const auto line = terminal_.line();
    if (!line) return std::nullopt;
    if (!line->empty()) {
        say("    Enter alone goes on\n> ");
        return std::nullopt;
    }
    open_.clear();
    return session::PageRead{read_by_, steadyMilliseconds() - since_ms_};
}

std::optional<bool> askConsent(Terminal& terminal, const std::function<bool()>& stop, const plan::ConsentClause& clause,
                               const std::string& text) {
    const std::string prompt = "    yes or no > ";
    say(fmt::format("\n{}{}\n{}", text, clause.required ? "" : "  (may be refused)", prompt));
    while (!terminal.ended() && !stop()) {
        const auto line = terminal.line();
        if (!line) continue;
        for (const char* word : {"yes", "y", "ja", "j"})
            if (*line == word) return true;
        for (const char* word : {"no", "n", "nein"})
            if (*line == word) return false;
        say(prompt);
    }
    return std::nullopt;
}

}  // namespace passung::cli
