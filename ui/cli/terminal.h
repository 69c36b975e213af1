#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "study/plan/study_plan.h"
#include "study/session/form_filling.h"
#include "study/session/instruction_reader.h"

namespace passung::cli {

/// Lines that a person types, or a script writes.
class Terminal {
public:
    /// A line, if one arrives within a moment.
    std::optional<std::string> line();
    /// Nothing more will come.
    bool ended() const { return ended_; }

private:
    std::string pending_;
    bool ended_ = false;
};

/// Asks questionnaires at a terminal, item by item. An empty line leaves an item out after one more, "<" goes back.
class TerminalAnswers : public session::QuestionnaireSource {
public:
    /// `answered_by`: "participant", or "experimenter" who reads the items out. The terminal outlives this.
    TerminalAnswers(Terminal& terminal, std::string answered_by)
        : terminal_(terminal), answered_by_(std::move(answered_by)) {}

    std::optional<session::FilledForm> fill(const session::ShownQuestionnaire& form) override;
    void withdraw() override { filling_.reset(); }

private:
    void begin(const session::ShownQuestionnaire& form);
    void prompt() const;
    bool take(const std::string& line);
    void takeAnswer(const std::string& line);

    Terminal& terminal_;
    std::string answered_by_;
    std::unique_ptr<session::FormFilling> filling_;
    bool leaves_out_ = false;  // the line before was empty
};

/// Prints instructions at a terminal; an empty line says that they were read.
class TerminalReader : public session::InstructionReader {
public:
    /// `read_by`: as `answered_by` above. The terminal outlives this.
    TerminalReader(Terminal& terminal, std::string read_by) : terminal_(terminal), read_by_(std::move(read_by)) {}

    std::optional<session::PageRead> read(const session::Page& page) override;

private:
    Terminal& terminal_;
    std::string read_by_;
    std::string open_;  // id of the page that is shown; empty: none
    std::int64_t since_ms_ = 0;
};

/// Shows a clause of consent and waits for yes or no; nothing if the terminal ends or `stop` says so first.
std::optional<bool> askConsent(Terminal& terminal, const std::function<bool()>& stop, const plan::ConsentClause& clause,
                               const std::string& text);

}  // namespace passung::cli
