#pragma once

#include <cstdint>
#include <string>

#include "study/protocol/json.h"
#include "study/protocol/participant.h"
#include "study/store/rows.h"
#include "study/store/sqlite.h"

namespace passung::store {

// What experimenters did to participants, as a chain: every row's hash covers the hash before it and that of its own
// detail. Erasing a participant takes the details about them away and leaves the chain whole; each detail holds a
// random text, so that nobody can find an erased code by trying. For this room only: the functions throw.

/// Who does something, and when.
struct Actor {
    std::string name;
    std::string now_utc;
};

/// Adds a row at the end of the chain, within the caller's transaction.
void appendAudit(const Database& database, const Actor& actor, const std::string& action, protocol::JsonObject detail);

/// Takes away every detail about the participant; `surrogate` stands in its place.
void eraseAuditDetails(const Database& database, const std::string& participant, const std::string& surrogate);

/// The highest number that a code of this kind had when somebody of it was last erased; 0 if nobody was.
std::int64_t erasedCodesTo(const Database& database, protocol::ParticipantKind kind);

/// Walks the chain. Rows cut off its end cannot be missed.
AuditReport checkAudit(const Database& database);

}  // namespace passung::store
