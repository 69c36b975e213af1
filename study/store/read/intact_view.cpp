#include "study/store/read/intact_view.h"

#include <algorithm>
#include <set>

#include "study/store/schema/row_hash.h"
#include "study/store/schema/value_hash.h"

namespace passung::store {
namespace {

/// Gathers what is damaged in temp.lost, by table and number, and hides it.
class IntactView {
public:
    IntactView(const Database& database, SampleCheck samples)
        : database_(database), samples_(samples), tables_(sessionTables(database)) {
        database_.execute(
            "CREATE TEMP TABLE lost(table_name TEXT, number INTEGER, PRIMARY KEY(table_name, number)); CREATE TEMP "
            "TABLE "
            "lost_chunk(stream_id INTEGER, chunk_no INTEGER, PRIMARY KEY(stream_id, chunk_no)); CREATE TEMP TABLE "
            "lost_name(name TEXT PRIMARY KEY)");
    }

    std::vector<DamageRow> run() {
        studyRows();
        std::vector<std::string> ids;
        Statement sessions = database_.prepare("SELECT session_id FROM session ORDER BY participant_id, ordinal");
        while (sessions.step()) ids.push_back(sessions.text(0));
        for (const std::string& id : ids) session(id);
        hide();
        return std::move(rows_);
    }

private:
    void studyRows() {
        for (const RowFault& fault : rowFaults(database_, "main")) {
            DamageRow row;
            row.participant_id = fault.participant_id;
            row.part = fault.table;
            row.what = titleOf(fault) + (fault.missing ? " is gone" : " is not as it was written");
            if (!fault.participant_id.empty()) {
                loseName(fault.participant_id);
            } else if (fault.table == "condition") {
                conditions_.insert(fault.key);
                row.what += ": attempts of that condition are left out";
            } else {
                row.what += ": exported as it stands";
            }
            rows_.push_back(std::move(row));
        }
        loseAttemptsOf("t.condition_id");
        loseAttemptsOf("(SELECT f.condition_id FROM staircase_step f WHERE f.attempt_id=a.attempt_id)");
    }

    /// Attempts whose planned or presented condition is damaged.
    void loseAttemptsOf(const std::string& condition) {
        for (const std::string& key : conditions_)
            database_
                .prepare(
                    "INSERT OR IGNORE INTO temp.lost(table_name, number) SELECT 'attempt', a.attempt_id FROM attempt a "
                    "JOIN trial_plan t "
                    "USING(trial_id) JOIN condition c ON c.condition_id=" +
                    condition + " WHERE c.protocol_sha256 || ', ' || c.condition=?")
                .bind(key)
                .run();
    }

    void session(const std::string& id) {
        const SessionDamage damage = damageOf(database_, tables_, "main", id, samples_);
        if (!damage.any()) return;
        const SessionValues values = sessionValues(database_, tables_, "main", id);
        Statement who = database_.prepare("SELECT participant_id, ordinal FROM session WHERE session_id=?");
        who.bind(id).step();
        DamageRow row;
        row.participant_id = who.text(0);
        row.session_ordinal = who.integer(1);
        for (const ChunkFault& chunk : damage.chunks) {
            database_.prepare("INSERT OR IGNORE INTO temp.lost_chunk(stream_id, chunk_no) VALUES(?, ?)")
                .bind(chunk.stream_id, chunk.chunk_no)
                .run();
            tell(row, chunk.unit, chunk.what);
        }
        for (const std::string& unit : damage.units) {
            lose(id, unit, values);
            const bool told = std::any_of(damage.chunks.begin(), damage.chunks.end(),
                                          [&](const ChunkFault& chunk) { return chunk.unit == unit; });
            if (!told) tell(row, unit, "is not as the run wrote it");
        }
        if (damage.changes) tell(row, "later changes", "a later note, event or invalidation is not as it was left");
        if (damage.list)
            tell(row, "hashes", "the list of its hashes is damaged: nothing of the session could be compared");
    }

    void tell(DamageRow row, const std::string& unit, const std::string& what) {
        row.part = unit;
        row.what = what;
        Statement place = database_.prepare(
            "SELECT trial_index, attempt_no FROM attempt JOIN trial_plan USING(trial_id) JOIN session "
            "USING(session_id) "
            "WHERE participant_id=? AND ordinal=? AND (?3='trial ' || (trial_index + 1) || ', attempt ' || attempt_no "
            "OR "
            "substr(?3, 1, length('trial ' || (trial_index + 1) || ', attempt ' || attempt_no || ','))='trial ' || "
            "(trial_index + 1) || ', attempt ' || attempt_no || ',')");
        if (place.bind(row.participant_id, row.session_ordinal, unit).step()) {
            row.trial_index = place.integer(0);
            row.attempt_no = place.integer(1);
        }
        rows_.push_back(std::move(row));
    }

    void lose(const std::string& id, const std::string& unit, const SessionValues& values) {
        const auto is_of = [&](const std::string& name) { return unit == name || unit.starts_with(name + ", "); };
        if (unit.ends_with(", event") || unit == "note") {
            for (const ValueRow& row : values.rows)
                if (row.unit == unit) loseNumber(row.table, row.number);
            return;
        }
        if (unit.ends_with(", order_step")) return;  // nobody reads it but a session that is resumed
        for (const auto& [number, name] : values.names.at("attempt")) {
            if (!is_of(name)) continue;
            if (unit.ends_with(kSamplesUnit))
                database_
                    .prepare(
                        "INSERT OR IGNORE INTO temp.lost_chunk(stream_id, chunk_no) SELECT stream_id, chunk_no FROM "
                        "sample_chunk WHERE "
                        "attempt_id=?")
                    .bind(number)
                    .run();
            else
                loseAttempt(number, values);
            return;
        }
        for (const auto& [number, name] : values.names.at("questionnaire_run"))
            if (is_of(name)) return loseNumber("questionnaire_run", number);
        if (unit.starts_with("trial ") || unit.starts_with("form ")) return;  // it is not there at all
        loseName(id);
        for (const auto& [number, name] : values.names.at("attempt")) loseAttempt(number, values);
    }

    void loseAttempt(std::int64_t number, const SessionValues& values) {
        loseNumber("attempt", number);
        const std::string events = values.names.at("attempt").at(number) + ", event";
        for (const ValueRow& row : values.rows)
            if (row.unit == events) loseNumber("event", row.number);
    }

    void loseNumber(const std::string& table, std::int64_t number) {
        database_.prepare("INSERT OR IGNORE INTO temp.lost(table_name, number) VALUES(?, ?)").bind(table, number).run();
    }
    void loseName(const std::string& name) {
        database_.prepare("INSERT OR IGNORE INTO temp.lost_name(name) VALUES(?)").bind(name).run();
    }

    void hide() {
        const auto view = [&](const std::string& table, const std::string& where) {
            database_.execute("CREATE TEMP VIEW " + table + " AS SELECT * FROM main." + table + " WHERE " + where);
        };
        const auto number = [&](const std::string& table, const std::string& column) {
            return column + " NOT IN (SELECT number FROM temp.lost WHERE table_name='" + table + "')";
        };
        const std::string names = " NOT IN (SELECT name FROM temp.lost_name)";
        view("participant", "participant_id" + names);
        view("session", "session_id" + names + " AND participant_id" + names);
        view("attempt", number("attempt", "attempt_id"));
        view("event", number("event", "event_id"));
        view("note", number("note", "note_id"));
        view("questionnaire_run", number("questionnaire_run", "run_id"));
        for (const char* table : {"staircase_step", "secondary_response"}) view(table, number("attempt", "attempt_id"));
        view("sample_chunk", "(stream_id, chunk_no) NOT IN (SELECT stream_id, chunk_no FROM temp.lost_chunk)");
    }

    const Database& database_;
    const SampleCheck samples_;
    const std::vector<SessionTable> tables_;
    std::vector<DamageRow> rows_;
    std::set<std::string> conditions_;  // keys of damaged ones
};

}  // namespace

std::vector<DamageRow> leaveOutDamaged(const Database& database, SampleCheck samples) {
    database.execute("PRAGMA query_only=OFF");  // for tables in `temp`; the file is not written
    return IntactView(database, samples).run();
}

}  // namespace passung::store
