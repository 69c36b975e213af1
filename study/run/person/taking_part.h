#pragma once

#include <functional>
#include <optional>
#include <string>

#include "study/plan/participant.h"
#include "study/store/write/store.h"

namespace passung::run {

/// Shows a clause's text and says what was decided; nothing if nobody answers any more.
using AskConsent = std::function<std::optional<bool>(const plan::ConsentClause&, const std::string& text)>;

/// Asks what the participant has not decided yet of the protocol's clauses, as they stand there in `language`, and
/// stores every decision at once, as made at `now_utc`. Errors: a required clause was refused or nobody answered.
Result<Done> askForConsent(store::Store& store, const std::string& database, const plan::StudyPlan& plan,
                           const std::string& participant, const std::string& language, const std::string& now_utc,
                           const AskConsent& ask);

/// What keeps people (not simulated ones) from this study: each cue of its conditions that nothing here can give them.
Errors missingOutputs(const plan::StudyPlan& plan, const std::string& participant);

/// What keeps people (not simulated ones) from a session here: each device of the study that this program cannot drive.
Errors missingDevices(const plan::StudyPlan& plan, const std::string& participant);

}  // namespace passung::run
