#include "study/store/transfer/session_remarks.h"

#include <stdexcept>

namespace passung::store {
namespace {

SessionRemarks::Text optionalText(const Statement& row, int column) {
    return row.isNull(column) ? SessionRemarks::Text() : row.text(column);
}

std::optional<SessionRemarks::AttemptKey> attemptKey(const Statement& row, int column) {
    if (row.isNull(column)) return std::nullopt;
    return SessionRemarks::AttemptKey(row.integer(column), row.integer(column + 1));
}

/// The attempt's number in the main database.
std::int64_t attemptHere(const Database& database, const std::string& session_id,
                         const SessionRemarks::AttemptKey& key) {
    Statement find = database.prepare(
        "SELECT attempt_id FROM main.attempt JOIN main.trial_plan USING(trial_id) WHERE session_id=? AND trial_index=? "
        "AND attempt_no=?");
    if (!find.bind(session_id, key.first, key.second).step())
        throw std::runtime_error("session " + session_id + " has remarks on an attempt that is not there");
    return find.integer(0);
}

void insertEvent(const Database& database, const std::string& session_id,
                 const decltype(SessionRemarks::events)::value_type& row) {
    const auto& [segment, key, t_ns, source, event, payload, t_utc] = row;
    std::optional<std::int64_t> attempt;
    if (key) attempt = attemptHere(database, session_id, *key);
    database
        .prepare(
            "INSERT INTO main.event(segment_id, attempt_id, t_ns, source, event, payload_json, t_utc) "
            "VALUES((SELECT segment_id FROM main.segment WHERE session_id=? ORDER BY segment_id LIMIT 1 OFFSET ?), "
            "?, ?, ?, ?, ?, ?)")
        .bind(session_id, segment, attempt, t_ns, source, event, payload, t_utc)
        .run();
}

}  // namespace

SessionRemarks remarksOf(const Database& database, const std::string& schema, const std::string& session_id) {
    SessionRemarks remarks;
    const auto rows = [&](std::string sql, auto&& keep) {
        for (std::size_t at = 0; (at = sql.find("$.", at)) != std::string::npos;) sql.replace(at, 1, schema);
        Statement row = database.prepare(sql);
        row.bind(session_id);
        while (row.step()) keep(row);
    };
    rows("SELECT t_utc, author, text FROM $.note WHERE session_id=?",
         [&](const Statement& row) { remarks.notes.emplace(row.text(0), optionalText(row, 1), row.text(2)); });
    rows(
        "SELECT g.number, t.trial_index, a.attempt_no, e.t_ns, e.source, e.event, e.payload_json, e.t_utc FROM (SELECT "
        "segment_id, row_number() OVER (ORDER BY segment_id) - 1 AS number FROM $.segment WHERE session_id=?) g "
        "JOIN $.event e USING(segment_id) LEFT JOIN $.attempt a ON a.attempt_id=e.attempt_id "
        "LEFT JOIN $.trial_plan t ON t.trial_id=a.trial_id",
        [&](const Statement& row) {
            remarks.events.emplace(row.integer(0), attemptKey(row, 1), row.integer(3), row.text(4), row.text(5),
                                   optionalText(row, 6), optionalText(row, 7));
        });
    rows(
        "SELECT t.trial_index, a.attempt_no, coalesce(a.invalid_reason, '') FROM $.attempt a "
        "JOIN $.trial_plan t ON t.trial_id=a.trial_id WHERE t.session_id=? AND a.valid=0",
        [&](const Statement& row) { remarks.invalid.emplace(*attemptKey(row, 0), row.text(2)); });
    return remarks;
}

UnitedRemarks uniteRemarks(const Database& database, const std::string& session_id, const SessionRemarks& more) {
    const SessionRemarks here = remarksOf(database, "main", session_id);
    UnitedRemarks united;
    Statement insert = database.prepare("INSERT INTO main.note(session_id, t_utc, author, text) VALUES(?, ?, ?, ?)");
    for (const auto& note : more.notes) {
        if (here.notes.count(note) != 0) continue;
        const auto& [t_utc, author, text] = note;
        insert.bind(session_id, t_utc, author, text).run();
        united.changed = true;
    }
    for (const auto& event : more.events) {
        if (here.events.count(event) != 0) continue;
        insertEvent(database, session_id, event);
        united.changed = true;
    }
    for (const auto& [key, reason] : more.invalid) {
        const auto known = here.invalid.find(key);
        if (known == here.invalid.end()) {
            database.prepare("UPDATE main.attempt SET valid=0, invalid_reason=? WHERE attempt_id=?")
                .bind(nullIfEmpty(reason), attemptHere(database, session_id, key))
                .run();
            united.changed = true;
        } else if (known->second != reason) {
            united.conflicts.push_back("trial " + std::to_string(key.first + 1) + ", attempt " +
                                       std::to_string(key.second) + " does not count for two reasons: \"" +
                                       known->second + "\" stays, \"" + reason + "\" is not kept");
        }
    }
    return united;
}

}  // namespace passung::store
