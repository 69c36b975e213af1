#pragma once

#include <string>

#include "study/store/schema/sqlite.h"

namespace passung::store {

// Who somebody is in every copy of a study: 32 hexadecimal digits beside the code, which merging, pushing and backups
// carry along, and all that is kept of somebody who was erased. Of people 128 random bits of the system, from which
// nothing about them follows; of simulated participants a hash of study, seed and code, so that equal runs give equal
// files. For this room only: the functions throw.

/// Identity of somebody who is enrolled now.
std::string newIdentity(const Database& database, const std::string& code, const std::string& kind);

/// Of everybody in the database `schema` who has none: participants of programs that knew no identities. Every copy of
/// such a file gives them the same one: it follows from a random number in the audit's first row about them (else from
/// the first recorded trial), which erasing takes away. Who has neither gets a random one in `main`, else none.
void giveIdentities(const Database& database, const std::string& schema);

}  // namespace passung::store
