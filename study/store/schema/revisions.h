#pragma once

#include <span>
#include <string>

#include "study/store/schema/sqlite.h"

namespace passung::store {

/// One step of the schema. Revisions are appended, never edited: files written by older programs hold them.
struct Revision {
    int number;
    const char* sentence;  // what it changes, for people
    const char* sql;
    int oldest_reader;  // the oldest schema number whose programs can read a file of this revision
    void (*fill)(const Database&) = nullptr;  // what its SQL alone cannot do, right after it
};

/// All revisions this program knows, ascending from 1.
std::span<const Revision> revisions();

/// The schema that this program writes.
int schemaNumber();

/// Marks a file as Passung's in SQLite's header ("Pssg").
inline constexpr std::int64_t kApplicationId = 0x50737367;

enum class SchemaState {
    Empty,    // no table at all
    Foreign,  // somebody else's database
    Older,    // can be upgraded
    Current,
    NewerCompatible,    // written by a newer program, readable by this one
    NewerIncompatible,  // written by a newer program, not readable by this one
};

SchemaState inspectSchema(const Database& database);

/// The number of the newest revision in the file; 0 if none.
int fileSchemaNumber(const Database& database);

/// Brings a file up to the current schema in one transaction: all of it or nothing. @pre Empty or Older
void upgradeSchema(const Database& database, const std::string& applied_utc);

}  // namespace passung::store
