#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "study/store/read/session_damage.h"
#include "study/store/schema/row_hash.h"
#include "study/store/schema/value_hash.h"

namespace passung::store {

/// Heals what is damaged in the main database by what is intact, and the same, in an attached one: rows of the study,
/// chunks of samples, units of sessions (value_hash.h). What is healed fits the hashes that the main database kept, or
/// stays as it was; what is intact is never touched. For this room only: the functions throw. @pre in a transaction
class Healer {
public:
    Healer(const Database& database, std::string source);

    /// Each returns what it healed, a line each.
    std::vector<std::string> healRows();
    std::vector<std::string> healSession(const std::string& session_id);  // that both have

private:
    void healChunks(const SessionDamage& damage, std::vector<std::string>& healed);
    bool healChunk(const ChunkFault& fault);
    void healList();
    bool healChanges();
    bool healRow(const SessionTable& table, const RowFault& fault, const std::vector<StudyRow>& rows_here);
    bool healUnit(const std::string& unit);
    bool replaceUnit(const std::string& unit);
    void look();
    void lookAtLater();
    bool mayLoseLater(const std::string& unit) const;

    void replaceOwner(const std::string& owner, std::int64_t there);
    void replaceChildren(const std::string& owner, std::int64_t there, const SessionTable& child);
    void replaceSamples(std::int64_t there);
    void keepLaterInvalidation(std::int64_t here, const std::string& valid, const std::string& reason);

    const SessionTable& table(const std::string& name) const;
    std::string valuesOf(const SessionTable& table) const;
    void copy(const SessionTable& table, const std::string& where, std::int64_t key);
    void replaceRows(const SessionTable& table, const std::string& where_here, std::int64_t here,
                     const std::string& where_there, std::int64_t there);
    std::string notLater(const SessionTable& table, const std::string& schema) const;

    const Database& database_;
    const std::string source_;
    const std::vector<SessionTable> tables_;
    std::string session_;
    SessionValues here_, there_;
    UnitHashes hashes_here_, hashes_there_;
    KeptHashes kept_;
    std::map<std::string, std::map<std::int64_t, std::int64_t>> numbers_;  // by table: there, here
    std::map<std::string, std::set<std::string>> unknown_;                 // by unit: rows here that are not there
    std::set<std::string> lost_;                  // units of which something came later that is there and no more here
    std::map<std::string, std::size_t> lacking_;  // by unit: how many rows there are not here
};

}  // namespace passung::store
