#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "study/plan/study_plan.h"
#include "study/session/instruction_reader.h"
#include "study/session/questionnaire_source.h"
#include "ui/presenter/session_news.h"

namespace passung::window {

/// What a session asks the participant at a window: consent, instructions, questionnaires. The session's thread asks by
/// news and looks for what came back; the window hands it in. Neither waits for the other longer than a moment.
class Interview final : public session::QuestionnaireSource, public session::InstructionReader {
public:
    using Tell = std::function<void(presenter::News)>;
    explicit Interview(Tell tell) : tell_(std::move(tell)) {}

    // The session's thread.
    /// An attempt or a session begins: whatever was asked no longer is.
    void forget();
    /// Shows a clause until it is decided; nothing if `stop` says so first.
    std::optional<bool> consent(const plan::ConsentClause& clause, const std::string& text,
                                const std::function<bool()>& stop);
    std::optional<session::FilledForm> fill(const session::ShownQuestionnaire& form) override;
    void withdraw() override;
    std::optional<session::PageRead> read(const session::Page& page) override;
    bool goesOn() override;

    // The window's.
    void handIn(const std::string& form, session::FilledForm filled);
    void pageRead(std::int64_t number, std::int64_t read_ms);
    void goOn();

private:
    void ask(presenter::News what);
    template <class Held>
    std::optional<Held> take(std::optional<Held>& held);

    Tell tell_;
    std::string form_;        // id of the one that is asked; empty: none
    std::string page_;        // likewise
    std::int64_t pages_ = 0;  // so many were shown
    std::mutex mutex_;        // of what follows
    std::condition_variable changed_;
    std::optional<std::pair<std::string, session::FilledForm>> filled_;
    std::optional<std::pair<std::int64_t, std::int64_t>> read_;  // page, ms
    bool goes_on_ = false;
};

}  // namespace passung::window
