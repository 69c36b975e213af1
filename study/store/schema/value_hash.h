#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "study/store/schema/session_tables.h"

namespace passung::store {

// SHA-256 over what a run wrote, so that a bit that flips on a disk is noticed and named. A row's hash is over its
// values by their columns' names, where numbers of rows stand for what they refer to: a trial's place in the plan, an
// attempt's number in its trial. So it does not depend on a file's row numbers, survives merge and push, and, since a
// column's default is left out, a later schema's columns too. Samples take part by their chunks' checksums. Hashes of
// rows make that of a unit: an attempt, its measures, its samples, a form's answers … What people change later is kept
// beside the run's hashes, as the hash of the row before and after. For this room only: the functions throw.

/// A row of a session.
struct ValueRow {
    std::string table;
    std::int64_t number = 0;  // of the row in its file; 0: rows of this table have none
    std::string unit;  // "trial 4, attempt 1", "trial 4, attempt 1, samples", "form 2, item_response", "plan" …
    std::string sha256;
};

inline const std::string kSamplesUnit = ", samples";  // end of the name of such a unit

/// What a session consists of, with names that do not depend on numbers of rows.
struct SessionValues {
    std::vector<ValueRow> rows;
    /// Parts of tables that others refer to, by number: "trial 4, attempt 1".
    std::map<std::string, std::map<std::int64_t, std::string>> names;
};
SessionValues sessionValues(const Database& database, const std::vector<SessionTable>& tables,
                            const std::string& schema, const std::string& session_id);

/// Hash by unit, without what people changed later; and of what they changed, what is not there as it was left.
struct UnitHashes {
    std::map<std::string, std::string> units;
    bool changes_whole = true;
};
UnitHashes unitHashes(const Database& database, const std::string& schema, const std::string& session_id,
                      const std::vector<ValueRow>& rows);

/// Keeps the hashes of a session that is over. What an earlier part of it was sealed with stays, and a list of hashes
/// that did not fit stays known as damaged.
void sealSession(const Database& database, const std::string& session_id);

/// Before a sealed session goes on: damage in what will grow damages the list, so that no later seal hides it.
void keepDamageKnown(const Database& database, const std::string& session_id);

/// As it is kept; empty: the session was not sealed. `list_whole`: its hash over all units fits.
struct KeptHashes {
    std::map<std::string, std::string> units;
    bool list_whole = true;
};
KeptHashes keptHashes(const Database& database, const std::string& schema, const std::string& session_id);

/// By the hash of a row as people left it: as the run wrote it; nothing if the row is new.
using LaterChanges = std::map<std::string, std::optional<std::string>>;
LaterChanges laterChanges(const Database& database, const std::string& schema, const std::string& session_id);

/// Runs `change`, something that people add to a session after its end or say of it, and keeps what it did to the
/// session's rows, if it is sealed.
void changeLater(const Database& database, const std::string& session_id, const std::function<void()>& change);

}  // namespace passung::store
