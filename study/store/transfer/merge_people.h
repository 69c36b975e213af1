#pragma once

#include "study/store/schema/sqlite.h"

namespace passung::store {

// What a merge does to people, by the attached database `source`, without those who are left out (tombstone.h). For
// this room only: the functions throw. @pre in a transaction

/// One person has one kind and one time of enrolment. Whoever went on since is as far as they got.
void mergePeople(const Database& database);

/// Whoever was excluded, withdrew or was readmitted stands as the newest of these acts says, wherever it was done.
void settleStandings(const Database& database);

}  // namespace passung::store
