#include "study/store/transfer/held.h"

#include <algorithm>

#include "study/store/schema/value_hash.h"

namespace passung::store {
namespace {

/// Is `holds` true, as far as it can be told?
template <class Holds>
bool surely(Holds holds) {
    try {
        return holds();
    } catch (const SqliteError& error) {
        if (isOfTheDisk(error)) throw;
        return false;
    }
}

bool isSame(const RowFault& one, const RowFault& other) { return one.table == other.table && one.key == other.key; }

}  // namespace

bool holdsSession(const Database& database, const std::string& source, const std::string& session) {
    return surely([&] {
        const auto kept = keptHashes(database, source, session).units;
        return !kept.empty() && keptHashes(database, "main", session).units == kept &&
               laterChanges(database, "main", session) == laterChanges(database, source, session);
    });
}

bool holdsRow(const Database& database, const std::string& source, const RowFault& fault,
              const std::vector<RowFault>& faults) {
    if (std::any_of(faults.begin(), faults.end(), [&](const RowFault& other) { return isSame(other, fault); }))
        return false;
    return surely([&] {
        Statement same = database.prepare("SELECT 1 FROM main.row_hash m JOIN " + source +
                                          ".row_hash s USING(table_name, row_key, sha256) WHERE table_name=? AND "
                                          "row_key=?");
        if (!same.bind(fault.table, fault.key).step()) return false;
        Statement sessions = database.prepare("SELECT session_id FROM " + source + ".session WHERE participant_id=?");
        sessions.bind(fault.participant_id);
        while (sessions.step())
            if (!holdsSession(database, source, sessions.text(0))) return false;
        return true;
    });
}

}  // namespace passung::store
