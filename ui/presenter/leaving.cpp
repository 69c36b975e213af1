#include "ui/presenter/leaving.h"

namespace passung::presenter {

void LeavingDialog::open(ParticipantEntry person) {
    person_ = std::move(person);
    leaving_ = {};
    step_ = Step::Choose;
}

PersonWhy LeavingDialog::whyNotChoose(Scope scope, const std::string& reason, bool session_runs) const {
    if (session_runs) return PersonWhy::SessionRuns;
    if (scope == Scope::Erase) return PersonWhy::Possible;  // also of who has left
    const bool data_counts = person_.standing == Standing::TakesPart || person_.standing == Standing::Withdrawn;
    if (!data_counts || (scope == Scope::Stop && person_.standing == Standing::Withdrawn)) return PersonWhy::OutAlready;
    return scope == Scope::Dismiss && reason.empty() ? PersonWhy::NeedsReason : PersonWhy::Possible;
}

void LeavingDialog::choose(Scope scope, const std::string& reason) {
    leaving_ = {person_.code,
                scope,
                reason,
                static_cast<std::int64_t>(person_.sessions.size()),
                person_.attempts(),
                person_.forms,
                person_.place && (scope != Scope::Stop || person_.complete() == 0)};
    step_ = Step::Confirm;
}

PersonWhy LeavingDialog::whyNotConfirm(const std::string& typed, bool session_runs) const {
    if (session_runs) return PersonWhy::SessionRuns;
    return leaving_.scope == Scope::Erase && typed != leaving_.code ? PersonWhy::NeedsCode : PersonWhy::Possible;
}

std::optional<Leaving> LeavingDialog::confirm(const std::string& typed, bool session_runs, bool backup_too) {
    if (step_ != Step::Confirm || whyNotConfirm(typed, session_runs) != PersonWhy::Possible) return std::nullopt;
    step_ = Step::Closed;
    leaving_.backup_too = backup_too;
    return leaving_;
}

}  // namespace passung::presenter
