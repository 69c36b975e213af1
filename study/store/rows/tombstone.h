#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "core/base/json.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// What the audit keeps of an erased participant: their identity (see person_identity.h), by which a copy of them in
// another file is known again and from which nothing else follows. Programs that knew no identities kept a salted hash
// of code and time of enrolment instead: whoever tries all codes finds out whose it is. Such rows stay as they are,
// since the audit's chain holds them. For this room only: the functions throw.

/// Detail of the audit's row. `codes_to`: highest number of a code of this kind.
JsonObject tombstone(const std::string& identity, const std::string& kind, std::int64_t codes_to);

/// Who of the people in the attached database `people` was erased, as the audit in `tombstones` says, each with what
/// stands there for them. Tombstones from before there were hashes tell nothing.
std::map<std::string, std::string> erasedPeople(const Database& database, const std::string& tombstones,
                                                const std::string& people);

/// Has kKept say who is not among these, until the table temp.left_out is dropped.
void leaveOut(const Database& database, const std::map<std::string, std::string>& erased);
inline const std::string kKept = "participant_id NOT IN(SELECT participant_id FROM temp.left_out)";

}  // namespace passung::store
