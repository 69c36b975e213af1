#include "study/store/rows/remarks.h"

#include <stdexcept>

#include "core/base/json.h"
#include "study/store/schema/sqlite.h"
#include "study/store/schema/value_hash.h"

namespace passung::store {
namespace {

constexpr const char* kExperimenter = "experimenter";

std::string noAttempt(std::int64_t attempt_id) { return "there is no attempt " + std::to_string(attempt_id); }

void invalidate(const Database& database, std::int64_t attempt_id, const std::string& reason,
                const std::string& now_utc) {
    markInvalid(database, attempt_id, "invalidated by the experimenter: " + reason);
    const std::string payload = JsonObject().boolean("accepted", true).text("text", reason).str();
    database
        .prepare(
            "INSERT INTO event(segment_id, attempt_id, t_ns, source, event, payload_json, t_utc) "
            "SELECT segment_id, attempt_id, end_ns, ?, 'command_invalidate', ?, CASE epoch WHEN 'wall' THEN ? END "
            "FROM attempt JOIN segment USING(segment_id) JOIN session USING(session_id) WHERE attempt_id=?")
        .bind(kExperimenter, payload, now_utc, attempt_id)
        .run();
}

}  // namespace

void markInvalid(const Database& database, std::int64_t attempt_id, const std::string& reason) {
    Statement find =
        database.prepare("SELECT valid, outcome, coalesce(invalid_reason, '') FROM attempt WHERE attempt_id=?");
    if (!find.bind(attempt_id).step()) throw std::runtime_error(noAttempt(attempt_id));
    if (find.integer(0) == 0) {
        throw std::runtime_error("attempt " + std::to_string(attempt_id) + " is not valid already (" + find.text(1) +
                                 (find.text(2).empty() ? "" : ", " + find.text(2)) + ")");
    }
    database.prepare("UPDATE attempt SET valid=0, invalid_reason=? WHERE attempt_id=?").bind(reason, attempt_id).run();
}

void insertNote(const Database& database, const Note& note) {
    database.prepare("INSERT INTO note(session_id, t_utc, author, text) VALUES(?, ?, ?, ?)")
        .bind(note.session_id, note.t_utc, note.author, note.text)
        .run();
}

void invalidateLater(const Database& database, std::int64_t attempt_id, const std::string& reason,
                     const std::string& now_utc) {
    Statement find =
        database.prepare("SELECT session_id FROM attempt JOIN trial_plan USING(trial_id) WHERE attempt_id=?");
    if (!find.bind(attempt_id).step()) throw std::runtime_error(noAttempt(attempt_id));
    changeLater(database, find.text(0), [&] { invalidate(database, attempt_id, reason, now_utc); });
}

void noteLater(const Database& database, std::int64_t attempt_id, const std::string& text, const std::string& now_utc) {
    Statement find = database.prepare(
        "SELECT s.session_id, CASE epoch WHEN 'virtual' THEN coalesce(ended_utc, started_utc) ELSE ?2 END "
        "FROM session s WHERE ?1=0 OR s.session_id=(SELECT t.session_id FROM attempt a JOIN trial_plan t "
        "USING(trial_id) WHERE a.attempt_id=?1) ORDER BY s.rowid DESC LIMIT 1");
    if (!find.bind(attempt_id, now_utc).step())
        throw std::runtime_error(attempt_id > 0 ? noAttempt(attempt_id) : "holds no session");
    const Note note{find.text(0), find.text(1), kExperimenter, text};
    changeLater(database, note.session_id, [&] { insertNote(database, note); });
}

}  // namespace passung::store
