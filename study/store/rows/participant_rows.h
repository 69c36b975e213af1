#pragma once

#include <cstdint>
#include <string>

#include "study/plan/participant.h"
#include "study/store/schema/sqlite.h"
#include "study/store/schema/station.h"

namespace passung::store {

/// What the codes of this kind begin with at the station: P; of several stations PB.
std::string codeStart(plan::ParticipantKind kind, const Station& station);

/// False if the participant is there already with this kind. Throws for a code that is none of this kind and station,
/// and for one that an erased participant may have had. For this room only, within the caller's transaction.
bool insertParticipant(const Database& database, const std::string& code, plan::ParticipantKind wanted,
                       const std::string& created_utc, const Station& station);

}  // namespace passung::store
