#pragma once

#include <string>

#include "study/protocol/participant.h"
#include "study/store/sqlite.h"

namespace passung::store {

/// False if the participant is there already with this kind. Throws for a code that is none of this kind. For this room
/// only, within the caller's transaction.
bool insertParticipant(const Database& database, const std::string& code, protocol::ParticipantKind wanted,
                       const std::string& created_utc);

}  // namespace passung::store
