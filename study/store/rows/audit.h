#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "study/plan/participant.h"
#include "study/store/rows/actor.h"
#include "study/store/rows/rows.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// What experimenters did to participants, as a chain: every row's hash covers the hash before it and that of its own
// detail. Erasing a participant takes the details about them away and leaves the chain whole; each detail holds a
// random text, so that nobody can find an erased code by trying. A file into which others were merged holds their
// chains beside its own: every row follows an earlier one, or begins a chain. For this room only: the functions throw.

/// Adds a row at the end of the chain, within the caller's transaction.
void appendAudit(const Database& database, const Actor& actor, const std::string& action, JsonObject detail);

/// What stands in the place of a detail about somebody erased.
std::string erasedDetail(const std::string& surrogate);

/// Takes away every detail about the participant; `surrogate` stands in its place.
void eraseAuditDetails(const Database& database, const std::string& participant, const std::string& surrogate);

/// The highest number that a code of this kind had when somebody of it was last erased; 0 if nobody was.
std::int64_t erasedCodesTo(const Database& database, plan::ParticipantKind kind);

struct AuditRow {
    std::string t_utc, actor, action, detail_json, prev_hash, hash, detail_sha256;
    bool erased = false;  // the detail says only that it was taken away
};

/// All rows of the attached database `schema`, in their order. The details about those who are left out because they
/// were erased elsewhere (by code: their surrogate) are taken away.
std::vector<AuditRow> auditRows(const Database& database, const std::string& schema,
                                const std::map<std::string, std::string>& left_out);

/// Adds those of these rows that the main database has not.
void mergeAudit(const Database& database, const std::vector<AuditRow>& rows);

/// Rows that are damaged in the main database as they are in the attached one `source`, if they are whole there; what
/// was taken away here stays away. Returns what it healed, a line each. @pre in a transaction
std::vector<std::string> healAudit(const Database& database, const std::string& source);

/// Walks the chains. Rows cut off the end of one cannot be missed.
AuditReport checkAudit(const Database& database);

}  // namespace passung::store
