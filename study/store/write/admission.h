#pragma once

#include <optional>
#include <string>

#include "study/plan/participant.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

/// Throws unless the participant may begin a session of this protocol: not excluded nor withdrawn, and, unless
/// simulated, with a yes to every required clause of consent in the words that this protocol has now.
/// `newcomer`: what kind the participant will be who is not enrolled yet; none: that is refused too. For this room
/// only.
void requireAdmission(const Database& database, const std::string& protocol_sha256, const std::string& participant,
                      std::optional<plan::ParticipantKind> newcomer = {});

}  // namespace passung::store
