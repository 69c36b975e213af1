#pragma once

#include <optional>
#include <string>

#include "ui/presenter/participants.h"

namespace passung::presenter {

/// How somebody's part in a study ends.
enum class Scope {
    Stop,     // they take part no more, what is there stays in the analysis
    Exclude,  // their wish: what is there stays and counts nowhere
    Erase,    // their wish: nothing of them is left
    Dismiss,  // the experimenter's decision, which can be taken back: what is there stays and counts nowhere
};

/// What a participant's leaving does to what is there.
struct Leaving {
    std::string code;
    Scope scope = Scope::Stop;
    std::string reason;
    std::int64_t sessions = 0, attempts = 0, forms = 0;  // that are there
    bool frees_place = false;
    bool backup_too = true;  // of Erase: in the database's backup as well
};

/// Asks twice before somebody leaves: how and why, then, with what it does in sight, whether really.
class LeavingDialog {
public:
    enum class Step { Closed, Choose, Confirm };

    void open(ParticipantEntry person);
    void close() { step_ = Step::Closed; }
    Step step() const { return step_; }
    const std::string& code() const { return person_.code; }

    PersonWhy whyNotChoose(Scope scope, const std::string& reason, bool session_runs) const;
    /// On to the second question. @pre it may be chosen.
    void choose(Scope scope, const std::string& reason);
    void back() { step_ = Step::Choose; }
    const Leaving& leaving() const { return leaving_; }

    /// `typed`: the code once more, which erasing asks for.
    PersonWhy whyNotConfirm(const std::string& typed, bool session_runs) const;
    /// What is to be done now, and closes; none if it may not be done.
    std::optional<Leaving> confirm(const std::string& typed, bool session_runs, bool backup_too = true);

private:
    Step step_ = Step::Closed;
    ParticipantEntry person_;
    Leaving leaving_;
};

}  // namespace passung::presenter
