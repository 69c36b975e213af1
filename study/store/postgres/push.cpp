#include "study/store/postgres/push.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <map>
#include <optional>
#include <pqxx/pqxx>
#include <set>

#include "core/base/digest.h"
#include "study/store/postgres/postgres_message.h"
#include "study/store/postgres/push_copies.h"
#include "study/store/read/session_damage.h"
#include "study/store/rows/audit.h"
#include "study/store/rows/tombstone.h"
#include "study/store/schema/open_database.h"
#include "study/store/schema/person_identity.h"
#include "study/store/schema/row_hash.h"
#include "study/store/schema/session_tables.h"
#include "study/store/transfer/same_study.h"

namespace passung::store {
namespace {

/// The conversation with PostgreSQL.
class Push {
public:
    Push(const Database& database, const std::string& to) : database_(database), there_(to) {}

    PushReport run() {
        const std::vector<SessionTable> tables = sessionTables(database_);
        const std::vector<Copy> study = studyCopies(database_), sessions = sessionCopies(tables);
        const std::string name = database_.text("SELECT name FROM protocol_version LIMIT 1");
        if (name.empty()) throw std::runtime_error("holds no study yet");
        // Until this connection ends: several that push one study at once would make its tables and rows twice.
        pqxx::nontransaction(there_).exec_params("SELECT pg_advisory_lock(hashtext($1))", "passung " + name);
        PushReport report;
        pushStudy(name, study, sessions, report);
        Statement running = database_.prepare(
            "SELECT participant_id || ', session ' || ordinal FROM session WHERE end_state IS NULL ORDER BY rowid");
        while (running.step()) report.unfinished.push_back(running.text(0));
        Statement ended = database_.prepare(
            "SELECT session_id, participant_id || ', session ' || ordinal FROM session WHERE end_state IS NOT NULL "
            "AND " +
            kKept + " ORDER BY participant_id, ordinal");
        while (ended.step()) pushSession(ended.text(0), ended.text(1), sessions, tables, report);
        return report;
    }

private:
    void pushStudy(const std::string& name, const std::vector<Copy>& study, const std::vector<Copy>& sessions,
                   PushReport& report) {
        pqxx::work work(there_);
        // IF NOT EXISTS tells that something exists; nobody needs to hear it.
        work.exec("SET client_min_messages=warning");
        work.exec("CREATE SCHEMA IF NOT EXISTS " + work.quote_name(name));
        work.exec("SET search_path TO " + work.quote_name(name));
        for (const Copy& copy : study) create(work, copy);
        for (const Copy& copy : sessions) create(work, copy);
        create(work, auditCopy());
        work.exec(
            "CREATE TABLE IF NOT EXISTS pushed_session(session_id TEXT PRIMARY KEY REFERENCES session ON DELETE "
            "CASCADE, digest TEXT NOT NULL)");
        const auto left_out = compareWithThere(work, study, report);
        leaveOutDamaged(report);
        Statement people = database_.prepare("SELECT participant_id FROM participant");
        while (people.step())  // who gave a place back has it there no more
            if (decided_there_.count(people.text(0)) == 0 && damaged_.count(people.text(0)) == 0)
                work.exec_params("DELETE FROM design_slot WHERE participant_id=$1", people.text(0));
        for (const Copy& copy : study) {
            const bool changes = copy.name == "participant" || copy.name == "design_slot";
            const auto who = std::find_if(copy.columns.begin(), copy.columns.end(),
                                          [](const TableColumn& column) { return column.name == "participant_id"; });
            Statement rows = database_.prepare(copy.query);
            while (rows.step()) {
                const Values values = valuesOf(rows, copy.columns);
                if (changes && decided_there_.count(*values[static_cast<std::size_t>(who - copy.columns.begin())]) > 0)
                    continue;
                insert(work, copy, values, changes);
            }
        }
        report.newer_there.assign(decided_there_.begin(), decided_there_.end());
        pushAudit(work, left_out);
        const auto shared = work.exec(
            "SELECT string_agg(participant_id, ', ' ORDER BY participant_id) FROM design_slot GROUP BY "
            "protocol_sha256, kind, between_group, sequence_index, replicate HAVING count(*)>1 ORDER BY 1");
        for (const auto& row : shared) report.shared_places.push_back(row[0].c_str());
        work.commit();
    }

    /// Whoever's row is damaged stays here with all sessions; what everybody needs and is damaged ends the push.
    void leaveOutDamaged(PushReport& report) {
        for (const std::string& fault : checkAudit(database_).faults)
            throw std::runtime_error("audit, " + fault + ", nothing was pushed: passung restore heals it");
        for (const RowFault& fault : rowFaults(database_, "main")) {
            if (fault.participant_id.empty())
                throw std::runtime_error(titleOf(fault) + " is damaged, nothing was pushed: passung restore heals it");
            report.damaged.push_back(titleOf(fault) + ": is not as it was written");
            damaged_.insert(fault.participant_id);
        }
        for (const std::string& code : damaged_)
            database_.prepare("INSERT OR IGNORE INTO temp.left_out(participant_id) VALUES(?)").bind(code).run();
    }

    /// The audit's rows mean the same everywhere by their hashes.
    Copy auditCopy() const {
        Copy copy{"audit", describeTable(database_, "audit").columns, {"hash"}, {}, {}};
        std::erase_if(copy.columns, [](const TableColumn& column) { return column.name == "audit_id"; });
        return copy;
    }

    /// Copies what decides whether the studies are one beside the tables here, under their names in `temp`, and lets
    /// the rules of merging judge. Whoever was erased here is deleted there; whoever was erased there is left out.
    std::map<std::string, std::string> compareWithThere(pqxx::work& work, const std::vector<Copy>& study,
                                                        PushReport& report) {
        std::vector<Copy> copies = study;
        copies.push_back(auditCopy());
        const std::vector<std::string> apart = {"consent", "design_slot", "condition"};  // nothing of them is compared
        std::erase_if(
            copies, [&](const Copy& copy) { return std::find(apart.begin(), apart.end(), copy.name) != apart.end(); });
        database_.execute("PRAGMA query_only=OFF");  // for tables in `temp`; the file is not written
        for (const Copy& copy : copies) fetch(work, copy);
        giveIdentities(database_, "temp");  // of people who were pushed before there were any
        requireSameStudy(database_, "temp", [](const std::string& reason) { throw std::runtime_error(reason); });
        for (const auto& [code, surrogate] : erasedPeople(database_, "main", "temp")) {
            work.exec_params("DELETE FROM session WHERE participant_id=$1", code);
            work.exec_params("DELETE FROM participant WHERE participant_id=$1", code);
            work.exec_params("UPDATE audit SET detail_json=$2 WHERE detail_json::jsonb->>'participant'=$1", code,
                             erasedDetail(surrogate));
            report.erased_there.push_back(code);
        }
        Statement decided = database_.prepare(
            "SELECT json_extract(detail_json, '$.participant') AS code FROM temp.audit WHERE action IN('exclude', "
            "'withdraw', 'readmit') AND hash NOT IN(SELECT hash FROM main.audit) AND code IN(SELECT participant_id "
            "FROM main.participant)");
        while (decided.step()) decided_there_.insert(decided.text(0));
        auto left_out = erasedPeople(database_, "temp", "main");
        for (const auto& [code, surrogate] : left_out) report.left_out.push_back(code);
        for (const Copy& copy : copies) database_.execute("DROP TABLE temp." + copy.name);
        leaveOut(database_, left_out);
        return left_out;
    }

    /// The rows there as a table of the same name in `temp`.
    void fetch(pqxx::work& work, const Copy& copy) {
        const std::string columns = joined(copy.columns, nameOf);
        database_.execute("CREATE TEMP TABLE " + copy.name + " AS SELECT " + columns + " FROM main." + copy.name +
                          " LIMIT 0");
        Statement insert_here = database_.prepare("INSERT INTO temp." + copy.name + "(" + columns + ") SELECT " +
                                                  joined(copy.columns, [&, number = 0](const TableColumn&) mutable {
                                                      return "json_extract(?1, '$[" + std::to_string(number++) + "]')";
                                                  }));
        const auto rows =
            work.exec("SELECT json_build_array(" +
                      joined(copy.columns, [&](const TableColumn& column) { return work.quote_name(column.name); }) +
                      ") FROM " + work.quote_name(copy.name));
        for (const auto& row : rows) insert_here.bind(row[0].c_str()).run();
    }

    /// Details that were taken away since are taken away there too.
    void pushAudit(pqxx::work& work, const std::map<std::string, std::string>& left_out) {
        for (const AuditRow& row : auditRows(database_, "main", left_out))
            work.exec_params(
                std::string("INSERT INTO audit(t_utc, actor, action, detail_json, prev_hash, hash, detail_sha256) "
                            "VALUES($1, $2, $3, $4, $5, $6, $7) ON CONFLICT (hash) DO ") +
                    (row.erased ? "UPDATE SET detail_json=EXCLUDED.detail_json" : "NOTHING"),
                row.t_utc, row.actor, row.action, row.detail_json, row.prev_hash, row.hash, row.detail_sha256);
    }

    void create(pqxx::work& work, const Copy& copy) {
        std::string columns = joined(copy.columns, [&](const TableColumn& column) {
            const bool refers =
                !copy.reference.empty() &&
                column.name ==
                    (copy.reference.find("participant") != std::string::npos ? "participant_id" : "session_id");
            return work.quote_name(column.name) + " " + typeThere(column.type) + (refers ? " " + copy.reference : "");
        });
        work.exec("CREATE TABLE IF NOT EXISTS " + work.quote_name(copy.name) + "(" + columns + ", PRIMARY KEY(" +
                  joined(copy.keys, [&](const std::string& key) { return work.quote_name(key); }) + "))");
        for (const TableColumn& column : copy.columns)  // those of later revisions
            work.exec("ALTER TABLE " + work.quote_name(copy.name) + " ADD COLUMN IF NOT EXISTS " +
                      work.quote_name(column.name) + " " + typeThere(column.type));
    }

    void insert(pqxx::work& work, const Copy& copy, const Values& values, bool update) {
        std::size_t number = 0;
        std::string sql =
            "INSERT INTO " + work.quote_name(copy.name) + "(" +
            joined(copy.columns, [&](const TableColumn& column) { return work.quote_name(column.name); }) +
            ") VALUES(" + joined(copy.columns, [&](const TableColumn&) { return "$" + std::to_string(++number); }) +
            ") ON CONFLICT (" + joined(copy.keys, [&](const std::string& key) { return work.quote_name(key); }) +
            ") DO ";
        sql +=
            !update ? "NOTHING" : "UPDATE SET " + joined(copy.columns, [&](const TableColumn& column) {
                                      return work.quote_name(column.name) + "=EXCLUDED." + work.quote_name(column.name);
                                  });
        std::vector<const char*> parameters;
        for (const auto& value : values) parameters.push_back(value ? value->c_str() : nullptr);
        work.exec_params(sql, pqxx::prepare::make_dynamic_params(parameters));
    }

    void pushSession(const std::string& id, const std::string& name, const std::vector<Copy>& copies,
                     const std::vector<SessionTable>& tables, PushReport& report) {
        if (const SessionDamage damage = damageOf(database_, tables, "main", id); damage.any()) {
            for (const std::string& line : damage.lines()) report.damaged.push_back(fmt::format("{}, {}", name, line));
            return;
        }
        const std::string digest = sessionDigest(database_, tables, "main", id);
        pqxx::work work(there_);
        const auto found = work.exec_params("SELECT digest FROM pushed_session WHERE session_id=$1", id);
        const bool known = !found.empty() && found[0][0].c_str() == digest;
        if (known && isSameThere(work, id, copies)) {
            ++report.known;
            return;
        }
        if (!found.empty() && !known) refuseOtherTrials(work, id);
        if (!found.empty() && !known && hasMoreThere(work, id)) {
            report.newer_there.push_back(name);
            return;
        }
        work.exec_params("DELETE FROM session WHERE session_id=$1", id);
        for (const Copy& copy : copies) {
            Statement rows = database_.prepare(copy.query);
            rows.bind(id);
            while (rows.step()) insert(work, copy, valuesOf(rows, copy.columns), false);
        }
        work.exec_params("INSERT INTO pushed_session(session_id, digest) VALUES($1, $2)", id, digest);
        work.commit();
        ++(found.empty() ? report.sessions : known ? report.healed : report.replaced);
    }

    /// Is every value that was pushed there as it is here? Samples are compared by their SHA-256, which the server
    /// makes.
    bool isSameThere(pqxx::work& work, const std::string& id, const std::vector<Copy>& copies) {
        return std::all_of(copies.begin(), copies.end(), [&](const Copy& copy) {
            std::vector<std::string> here, there;
            Statement rows = database_.prepare(copy.query);
            rows.bind(id);
            while (rows.step())
                here.push_back(comparable(copy, [&](int column) { return valueOf(rows, copy, column); }));
            const auto found = work.exec_params(
                "SELECT " +
                    joined(copy.columns,
                           [&](const TableColumn& column) {
                               const std::string name = work.quote_name(column.name);
                               return column.type == "BLOB" ? "encode(sha256(" + name + "), 'hex')" : name;
                           }) +
                    " FROM " + work.quote_name(copy.name) + " WHERE session_id=$1",
                id);
            for (const auto& row : found)
                there.push_back(comparable(copy, [&](int column) -> std::optional<std::string> {
                    if (row[column].is_null()) return std::nullopt;
                    return row[column].c_str();
                }));
            std::sort(here.begin(), here.end());
            std::sort(there.begin(), there.end());
            return here == there;
        });
    }

    static std::optional<std::string> valueOf(const Statement& row, const Copy& copy, int column) {
        if (row.isNull(column)) return std::nullopt;
        const std::string& type = copy.columns[static_cast<std::size_t>(column)].type;
        if (type == "REAL") return fmt::format("{:.17g}", row.real(column));
        if (type != "BLOB") return row.text(column);
        const auto blob = row.blob(column);
        return sha256Hex({reinterpret_cast<const char*>(blob.data()), blob.size()});
    }

    /// A row as one text. Numbers by their value: two programs write them with other digits.
    template <class Value>
    static std::string comparable(const Copy& copy, Value value) {
        std::string text;
        for (std::size_t i = 0; i < copy.columns.size(); ++i) {
            std::optional<std::string> field = value(static_cast<int>(i));
            if (field && copy.columns[i].type == "REAL")
                field = std::to_string(std::bit_cast<std::uint64_t>(std::strtod(field->c_str(), nullptr)));
            text += field ? std::to_string(field->size()) + ":" + *field + ";" : "N;";
        }
        return text;
    }

    /// A session that has changed here still holds every trial that had ended when it was pushed.
    void refuseOtherTrials(pqxx::work& work, const std::string& id) {
        const auto ended = work.exec_params(
            "SELECT t.trial_index, a.attempt_no, a.state_hash FROM attempt a JOIN trial_plan t USING(session_id, "
            "trial_id) WHERE session_id=$1 AND a.end_ns IS NOT NULL",
            id);
        Statement here = database_.prepare(
            "SELECT 1 FROM attempt a JOIN trial_plan t USING(trial_id) WHERE t.session_id=? AND t.trial_index=? "
            "AND a.attempt_no=? AND coalesce(a.state_hash, '')=?");
        for (const auto& row : ended)
            if (!here.bind(id, row[0].as<std::int64_t>(), row[1].as<std::int64_t>(), std::string(row[2].c_str()))
                     .step())
                throw std::runtime_error("session " + id + " has other trials there: its code stands for two people");
    }

    /// Was the session noted on, answered about or invalidated in a copy of the file that is newer than this one?
    bool hasMoreThere(pqxx::work& work, const std::string& id) {
        const auto lacks = [&](const std::string& there, const std::string& here) {
            Statement find = database_.prepare(here);
            const auto rows = work.exec_params(there, id);
            return std::any_of(rows.begin(), rows.end(), [&](const auto& row) {
                return !find.bind(id, row[0].template as<std::string>(), row[1].template as<std::string>(),
                                  row[2].template as<std::string>())
                            .step();
            });
        };
        return lacks("SELECT t_utc, coalesce(author, ''), text FROM note WHERE session_id=$1",
                     "SELECT 1 FROM note WHERE session_id=? AND t_utc=? AND coalesce(author, '')=? AND text=?") ||
               lacks(
                   "SELECT t_ns::text, event, coalesce(payload_json, '') FROM event WHERE session_id=$1",
                   "SELECT 1 FROM event JOIN segment USING(segment_id) WHERE session_id=? AND t_ns=CAST(? AS INTEGER) "
                   "AND event=? AND coalesce(payload_json, '')=?") ||
               lacks(
                   "SELECT t.trial_index::text, a.attempt_no::text, '0' FROM attempt a JOIN trial_plan t "
                   "USING(session_id, trial_id) WHERE session_id=$1 AND a.valid=0",
                   "SELECT 1 FROM attempt JOIN trial_plan USING(trial_id) WHERE session_id=? AND "
                   "trial_index=CAST(? AS INTEGER) AND attempt_no=CAST(? AS INTEGER) AND valid=CAST(? AS INTEGER)");
    }

    const Database& database_;
    pqxx::connection there_;
    std::set<std::string> damaged_;        // codes whose own row here is damaged
    std::set<std::string> decided_there_;  // codes that were excluded, withdrew or were readmitted in a newer copy
};

}  // namespace

Result<PushReport> pushDatabase(const std::string& path, const std::string& to) {
    const auto opened = openForReading(path, OlderFile::Refuse);
    if (!opened) return opened.errors();
    return guarded(path, [&] {
        (*opened)->execute("BEGIN");
        try {
            return Push(**opened, to).run();
        } catch (const pqxx::failure& error) {
            throw std::runtime_error(postgresMessage(error));
        }
    });
}

}  // namespace passung::store
