#include "study/store/merge.h"

#include <array>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "study/store/audit.h"
#include "study/store/open_database.h"
#include "study/store/process_lock.h"
#include "study/store/same_study.h"
#include "study/store/session_remarks.h"
#include "study/store/session_tables.h"
#include "study/store/tombstone.h"

namespace passung::store {
namespace {

namespace fs = std::filesystem;

/// The database that is merged, attached beside the one that grows.
constexpr const char* kSource = "source";

/// Merges one source into an open database.
class Merge {
public:
    Merge(const Database& database, std::string source, MergeReport& report)
        : database_(database), source_(std::move(source)), report_(report) {}

    void run() {
        database_.prepare(std::string("ATTACH ? AS ") + kSource).bind(source_).run();
        {
            Transaction transaction(database_);
            tables_ = sessionTables(database_);
            leaveOutErased();
            requireSameStudy(database_, kSource, [this](const std::string& reason) { refuse(reason); });
            mergeMeasures();
            mergeProtocols();
            mergePeople();
            mergeAudit(database_, auditRows(database_, kSource, left_out_));
            settleStandings();
            mergeSessions();
            mergePlaces();
            database_.execute("DROP TABLE temp.left_out");
            transaction.commit();
        }
        database_.execute(std::string("DETACH ") + kSource);
    }

private:
    [[noreturn]] void refuse(const std::string& reason) const { throw std::runtime_error(source_ + ": " + reason); }

    /// Throws if the query has a row; `reason` gets its first column.
    void refuseWhere(const std::string& sql, const std::string& before, const std::string& after) const {
        Statement find = database_.prepare(sql);
        if (find.step()) refuse(before + find.text(0) + after);
    }

    static std::string names(const Table& table, bool with_number) {
        std::string text;
        const TableColumn* number = table.number();
        for (const TableColumn& column : table.columns)
            if (with_number || number == nullptr || column.name != number->name)
                text += (text.empty() ? "" : ", ") + column.name;
        return text;
    }

    void mergeProtocols() {
        for (const std::string& name : tableNames(database_)) {
            const Table table = describeTable(database_, name);
            if (table.find("protocol_sha256") == nullptr || name == "session" || name == "design_slot") continue;
            const std::string columns = names(table, false);
            database_.execute("INSERT OR IGNORE INTO main." + name + "(" + columns + ") SELECT " + columns +
                              " FROM source." + name);
        }
    }

    void mergeMeasures() {
        database_.execute("INSERT OR IGNORE INTO main.measure SELECT * FROM source.measure");
        database_.execute("INSERT OR IGNORE INTO main.questionnaire SELECT * FROM source.questionnaire");
    }

    /// Whoever was erased from the result does not come back with a copy. The other way round nobody but the
    /// experimenter decides.
    void leaveOutErased() {
        left_out_ = erasedPeople(database_, "main", kSource);
        leaveOut(database_, left_out_);
        for (const auto& [code, surrogate] : left_out_)
            report_.erased.push_back(source_ + ": " + code + " was erased and is left out; this file still has them");
        for (const auto& [code, surrogate] : erasedPeople(database_, kSource, "main"))
            report_.erased.push_back(source_ + ": " + code + " was erased there; the result still has them");
    }

    /// One person has one kind and one time of enrolment. Whoever went on since is as far as they got.
    void mergePeople() {
        database_.execute("INSERT OR IGNORE INTO main.participant SELECT * FROM source.participant WHERE " + kKept);
        database_.execute(
            "UPDATE main.participant AS m SET status=s.status, status_reason=s.status_reason "
            "FROM source.participant AS s WHERE s.participant_id=m.participant_id AND " +
            rankOf("s") + ">" + rankOf("m"));
        database_.execute(
            "INSERT INTO main.consent(participant_id, text_sha256, language, clause, decision, decided_utc) "
            "SELECT participant_id, text_sha256, language, clause, decision, decided_utc FROM source.consent s "
            "WHERE NOT EXISTS(SELECT 1 FROM main.consent m WHERE (m.participant_id, m.text_sha256, m.clause, "
            "m.decision, m.decided_utc)=(s.participant_id, s.text_sha256, s.clause, s.decision, s.decided_utc)) "
            "AND " +
            kKept + " ORDER BY consent_id");
    }

    /// Whoever was excluded, withdrew or was readmitted stands as the newest of these acts says, wherever it was done.
    void settleStandings() {
        Statement acts = database_.prepare(
            "SELECT p.participant_id, p.status IN('excluded', 'withdrawn'), a.action, "
            "json_extract(a.detail_json, '$.status'), json_extract(a.detail_json, '$.reason'), s.status "
            "FROM main.participant p JOIN main.audit a ON a.audit_id=(SELECT b.audit_id FROM main.audit b WHERE "
            "json_extract(b.detail_json, '$.participant')=p.participant_id AND b.action IN('exclude', 'withdraw', "
            "'readmit') ORDER BY b.t_utc DESC, b.audit_id DESC LIMIT 1) "
            "JOIN source.participant s ON s.participant_id=p.participant_id");
        std::vector<std::array<std::string, 3>> settled;
        while (acts.step()) {
            const bool out = acts.integer(1) != 0, back = acts.text(2) == "readmit";
            if (back && !out) continue;
            const bool goes_on = back && acts.text(5) != "excluded" && acts.text(5) != "withdrawn";
            settled.push_back(
                {acts.text(0), goes_on ? acts.text(5) : acts.text(3), (back ? "readmitted: " : "") + acts.text(4)});
        }
        for (const auto& [code, status, reason] : settled)
            database_.prepare("UPDATE main.participant SET status=?2, status_reason=?3 WHERE participant_id=?1")
                .bind(code, status, reason)
                .run();
    }

    static std::string rankOf(const std::string& alias) {
        return "CASE " + alias +
               ".status WHEN 'enrolled' THEN 0 WHEN 'active' THEN 1 WHEN 'complete' THEN 2 WHEN 'withdrawn' THEN 3 "
               "ELSE 4 END";
    }

    void mergeSessions() {
        Statement left_out = database_.prepare(
            "SELECT participant_id || ', session ' || ordinal FROM source.session WHERE end_state IS NULL AND " +
            kKept + " ORDER BY participant_id, ordinal");
        while (left_out.step()) report_.unfinished.push_back(source_ + ": " + left_out.text(0));
        refuseWhere(
            "SELECT s.participant_id FROM source.session s JOIN main.session m USING(participant_id, ordinal) "
            "WHERE s.session_id<>m.session_id AND " +
                kKept,
            "participant code ", " stands for two people: their sessions differ");
        std::vector<std::string> ids;
        Statement sessions =
            database_.prepare("SELECT session_id FROM source.session WHERE end_state IS NOT NULL AND " + kKept +
                              " ORDER BY participant_id, ordinal");
        while (sessions.step()) ids.push_back(sessions.text(0));
        for (const std::string& id : ids) mergeSession(id);
    }

    void mergeSession(const std::string& id) {
        if (!database_.prepare("SELECT 1 FROM main.session WHERE session_id=?").bind(id).step()) {
            copySession(id);
            ++report_.sessions;
            return;
        }
        if (sessionDigest(database_, tables_, "main", id) == sessionDigest(database_, tables_, kSource, id)) {
            ++report_.known;
            return;
        }
        const bool behind = lacks("main", kSource, id);
        if (behind && lacks(kSource, "main", id)) {
            Statement who = database_.prepare(
                "SELECT participant_id || ' stands for two people: session ' || ordinal FROM source.session "
                "WHERE session_id=?");
            who.bind(id).step();
            refuse("participant code " + who.text(0) + " has other trials");
        }
        // What was said about the session since lives on, wherever it was said.
        const SessionRemarks remarks = remarksOf(database_, behind ? "main" : kSource, id);
        if (behind) {
            database_.prepare("DELETE FROM main.session WHERE session_id=?").bind(id).run();
            copySession(id);
        }
        const UnitedRemarks united = uniteRemarks(database_, id, remarks);
        ++(behind || united.changed ? report_.replaced : report_.known);
        reportConflicts(id, united.conflicts);
    }

    void reportConflicts(const std::string& id, const std::vector<std::string>& conflicts) {
        Statement who =
            database_.prepare("SELECT participant_id || ', session ' || ordinal FROM main.session WHERE session_id=?");
        who.bind(id).step();
        for (const std::string& conflict : conflicts)
            report_.conflicts.push_back(source_ + ": " + who.text(0) + ", " + conflict);
    }

    /// What the session consists of, a line each; remarks on it apart.
    static std::string contents(const std::string& schema) {
        const std::string of = " FROM " + schema + ".", where = " WHERE session_id=?1";
        return "SELECT json_array('attempt', s.started_utc, s.station, t.trial_index, a.attempt_no, a.start_ns, "
               "a.end_ns, a.outcome, a.seed, a.state_hash)" +
               of + "attempt a JOIN " + schema + ".trial_plan t USING(trial_id) JOIN " + schema +
               ".session s USING(session_id)" + where +
               " UNION ALL SELECT json_array('segment', started_utc, utc_zero, mono_zero_ns)" + of + "segment" + where +
               " UNION ALL SELECT json_array('form', questionnaire_sha256, moment, block_index, (SELECT trial_index "
               "FROM " +
               schema + ".trial_plan t WHERE t.trial_id=q.trial_id), started_utc, completed_utc)" + of +
               "questionnaire_run q" + where + " UNION ALL SELECT 'complete'" + of + "session" + where +
               " AND end_state='complete'";
    }

    /// Has the session in `other` anything that it has not in `one`?
    bool lacks(const std::string& one, const std::string& other, const std::string& id) const {
        Statement find = database_.prepare(contents(other) + " EXCEPT SELECT * FROM (" + contents(one) + ") LIMIT 1");
        return find.bind(id).step();
    }

    void copySession(const std::string& id) {
        std::map<std::string, std::int64_t> offsets;
        for (const Table& table : tables_)
            if (const TableColumn* number = table.number())
                offsets[table.name] =
                    database_.integer("SELECT coalesce(max(" + number->name + "), 0) FROM main." + table.name) -
                    least(table, *number, id) + 1;
        for (const Table& table : tables_) {
            std::string values;
            for (const TableColumn& column : table.columns) {
                std::string value = column.name;
                const Table* numbered = numberedBy(tables_, table, column);
                if (numbered != nullptr)
                    value += " + " + std::to_string(offsets[numbered->name]);
                else if (column.parent == "condition")
                    value =
                        "(SELECT m.condition_id FROM main.condition m JOIN source.condition s USING("
                        "protocol_sha256, condition) WHERE s.condition_id=t." +
                        column.name + ")";
                values += (values.empty() ? "" : ", ") + value;
            }
            database_
                .prepare("INSERT INTO main." + table.name + "(" + names(table, true) + ") SELECT " + values +
                         " FROM source." + table.name + " t WHERE " + rowsOfSession(tables_, table, kSource))
                .bind(id)
                .run();
        }
    }

    std::int64_t least(const Table& table, const TableColumn& number, const std::string& id) const {
        Statement find = database_.prepare("SELECT coalesce(min(" + number.name + "), 0) FROM source." + table.name +
                                           " WHERE " + rowsOfSession(tables_, table, kSource));
        find.bind(id).step();
        return find.integer(0);
    }

    /// Everybody keeps their row of the square; where stations gave one place twice, the second takes the same row in a
    /// further replicate.
    void mergePlaces() {
        database_.execute(
            "INSERT OR IGNORE INTO main.design_slot(protocol_sha256, between_group, sequence_index, replicate, "
            "state, kind) SELECT protocol_sha256, between_group, sequence_index, replicate, 'free', kind "
            "FROM source.design_slot");
        database_.execute(
            "UPDATE main.design_slot SET state='free', participant_id=NULL WHERE participant_id IN(SELECT "
            "participant_id FROM main.participant WHERE status='excluded')");
        Statement taken = database_.prepare(
            "SELECT s.participant_id, s.protocol_sha256, s.kind, s.between_group, s.sequence_index, s.replicate, "
            "s.state, s.station FROM source.design_slot s JOIN main.participant p USING(participant_id) "
            "WHERE p.status<>'excluded' ORDER BY s.replicate, s.sequence_index, s.participant_id");
        while (taken.step()) takePlace(taken);
    }

    void takePlace(const Statement& row) {
        const std::string who = row.text(0), sha256 = row.text(1), kind = row.text(2), group = row.text(3);
        const std::int64_t index = row.integer(4), wanted = row.integer(5);
        const std::string state = row.text(6);
        Statement own = database_.prepare("SELECT 1 FROM main.design_slot WHERE participant_id=?");
        if (own.bind(who).step()) {
            database_.prepare("UPDATE main.design_slot SET state=? WHERE participant_id=?").bind(state, who).run();
            return;
        }
        const auto place = [&](std::int64_t replicate) {
            Statement take = database_.prepare(
                "UPDATE main.design_slot SET state=?, participant_id=?, station=? WHERE protocol_sha256=? AND kind=? "
                "AND between_group=? AND sequence_index=? AND replicate=? AND participant_id IS NULL");
            const auto station = row.isNull(7) ? std::nullopt : std::optional(row.text(7));
            take.bind(state, who, station, sha256, kind, group, index, replicate).run();
            return database_.changes() == 1;
        };
        if (place(wanted)) return;
        report_.moved_places.push_back(who);
        for (std::int64_t replicate = 0; !place(replicate); ++replicate)
            database_
                .prepare(
                    "INSERT OR IGNORE INTO main.design_slot(protocol_sha256, between_group, sequence_index, replicate, "
                    "state, kind) SELECT protocol_sha256, between_group, sequence_index, ?5, 'free', kind FROM "
                    "main.design_slot WHERE protocol_sha256=?1 AND kind=?2 AND between_group=?3 AND replicate=?4")
                .bind(sha256, kind, group, wanted, replicate + 1)
                .run();
    }

    const Database& database_;
    std::string source_;
    MergeReport& report_;
    std::vector<Table> tables_;
    std::map<std::string, std::string> left_out_;  // code → surrogate
};

/// A source must be sound and of this program's schema: columns are copied by their names. Returns what is wrong with
/// its audit, which nothing but a person can judge.
Result<std::vector<std::string>> checkSource(const std::string& path) {
    const auto opened = openForReading(path);
    if (!opened) return opened.errors();
    return guarded(path, [&] { return checkAudit(**opened).faults; });
}

}  // namespace

Result<MergeReport> mergeDatabases(const std::vector<std::string>& sources, const std::string& out,
                                   const OpenOptions& options) {
    MergeReport report;
    for (const std::string& source : sources) {
        const auto faults = checkSource(source);
        if (!faults) return faults.errors();
        for (const std::string& fault : *faults) report.conflicts.push_back(source + ": audit: " + fault);
    }
    const auto lock = ProcessLock::take(out);
    if (!lock) return lock.errors();
    const std::string part = out + ".part";
    std::error_code none;
    fs::remove(part, none);
    const auto copied = guarded(out, [&] {
        if (fs::exists(out)) Database(out, OpenMode::ReadWrite).copyTo(part);
        // A log that outlives our own look at the file belongs to somebody who has it open.
        if (fs::exists(out + "-wal")) throw std::runtime_error("another program has this database open; end it first");
        return Done{};
    });
    if (!copied) return copied.errors();
    auto merged = guarded(out, [&] {
        const OpenedDatabase opened = openForWriting(part, options);
        if (!opened.database) throw std::runtime_error(opened.errors.front().message);
        for (const std::string& source : sources) Merge(*opened.database, source, report).run();
        return report;
    });
    if (merged) fs::rename(part, out, none);
    if (merged && none) merged = Error{.message = "cannot be written: " + none.message(), .file = out};
    if (!merged)
        for (const char* suffix : {"", "-wal", "-shm"}) {
            std::error_code ignored;
            fs::remove(part + suffix, ignored);
        }
    return merged;
}

}  // namespace passung::store
