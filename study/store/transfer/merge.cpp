#include "study/store/transfer/merge.h"

#include <filesystem>
#include <map>
#include <stdexcept>

#include "study/store/rows/audit.h"
#include "study/store/rows/tombstone.h"
#include "study/store/schema/open_database.h"
#include "study/store/schema/private_files.h"
#include "study/store/schema/process_lock.h"
#include "study/store/schema/session_tables.h"
#include "study/store/schema/study_views.h"
#include "study/store/schema/untouched.h"
#include "study/store/schema/workshop.h"
#include "study/store/transfer/heal.h"
#include "study/store/transfer/held.h"
#include "study/store/transfer/merge_people.h"
#include "study/store/transfer/merge_places.h"
#include "study/store/transfer/merge_session.h"
#include "study/store/transfer/same_study.h"
#include "study/store/transfer/session_remarks.h"

namespace passung::store {
namespace {

namespace fs = std::filesystem;

/// The database that is merged, attached beside the one that grows.
constexpr const char* kSource = "source";

/// How a source is taken: as a whole, or, where its pages are damaged, what of it can be read.
enum class Taken { Whole, AsFarAsReadable };

/// Merges one source into an open database.
class Merge {
public:
    Merge(const Database& database, std::string source, MergeReport& report, Taken taken = Taken::Whole)
        : database_(database), source_(std::move(source)), report_(report), taken_(taken) {}

    /// `file`: the source or a copy of it.
    void run(const std::string& file) {
        database_.prepare(std::string("ATTACH ? AS ") + kSource).bind(file).run();
        tables_ = sessionTables(database_);
        if (taken_ == Taken::Whole) {
            Transaction transaction(database_);
            mergeStudy();
            transaction.commit();
        } else {
            mergeStudy();
        }
        database_.execute(std::string("DETACH ") + kSource);
    }

private:
    void mergeStudy() {
        part("who was erased from it", [&] { findErased(); });
        leaveOut(database_, left_out_);
        part("what study it is", [&] {
            requireSameStudy(database_, kSource, [this](const std::string& reason) { refuseUnlessDamaged(reason); });
        });
        const auto none = [] { return false; };
        attempt(
            "the hashes of the study's rows", [&] { findDamaged(); }, none);
        part("who is left out", [&] { leaveOutDamaged(); });
        tellDamaged();
        if (other_study_.empty())
            mergeAll();
        else if (study_damaged_)
            report_.damaged.push_back(source_ + ": " + other_study_ + ": nothing of it is taken");
        else
            refuse(other_study_);
        database_.execute("DROP TABLE temp.left_out");
    }

    void mergeAll() {
        Healer healer(database_, kSource);
        part("rows that are damaged here", [&] { tellHealed(healer.healRows()); });
        if (!study_damaged_)  // a damaged row would come in under a hash of its own
            part("the protocols", [&] {
                mergeMeasures();
                mergeProtocols();
            });
        part("the participants", [&] { mergePeople(database_); });
        part("the audit", [&] {
            mergeAudit(database_, auditRows(database_, kSource, left_out_));
            settleStandings(database_);
        });
        mergeSessions(healer);
        part("the slots", [&] {
            for (std::string& who : mergePlaces(database_)) report_.moved_places.push_back(std::move(who));
        });
        part("hashes of what is new", [&] { sealNewRows(database_); });
        part("the views", [&] { makeStudyViews(database_); });
    }

    /// Where a source is taken as far as it can be read, what cannot be read is told and left out. Each part is a
    /// transaction then: SQLite writes nothing more within one that has met a damaged page.
    template <class Work>
    void part(const std::string& what, Work work) {
        part(what, work, [] { return false; });
    }

    /// `held`: is what cannot be read no loss?
    template <class Work, class Held>
    void part(const std::string& what, Work work, Held held) {
        if (taken_ == Taken::Whole) return work();
        attempt(
            what,
            [&] {
                Transaction transaction(database_);
                work();
                transaction.commit();
            },
            held);
    }

    template <class Work, class Held>
    void attempt(const std::string& what, Work work, Held held) {
        if (taken_ == Taken::Whole) return work();
        try {
            work();
        } catch (const std::exception& error) {
            const auto* refused = dynamic_cast<const SqliteError*>(&error);
            if (refused != nullptr && isOfTheDisk(*refused)) throw;
            tellLeftOut(held(), what + ": " + error.what());
        }
    }

    /// Damaged rows make a study another one.
    void refuseUnlessDamaged(const std::string& reason) {
        if (taken_ == Taken::Whole) refuse(reason);
        if (other_study_.empty()) other_study_ = reason;
    }

    [[noreturn]] void refuse(const std::string& reason) const { throw std::runtime_error(source_ + ": " + reason); }

    /// Throws if the query has a row; `reason` gets its first column.
    void refuseWhere(const std::string& sql, const std::string& before, const std::string& after) const {
        Statement find = database_.prepare(sql);
        if (find.step()) refuse(before + find.text(0) + after);
    }

    /// Names of the columns but the one that numbers the rows.
    static std::string names(const SessionTable& table) {
        std::string text;
        for (const TableColumn& column : table.columns)
            if (&column != table.number()) text += (text.empty() ? "" : ", ") + column.name;
        return text;
    }

    void mergeProtocols() {
        for (const std::string& name : tableNames(database_)) {
            const SessionTable table = describeTable(database_, name);
            if (table.find("protocol_sha256") == nullptr || name == "session" || name == "design_slot") continue;
            mergeRows(table);
        }
    }

    void mergeMeasures() {
        for (const char* name : {"measure", "questionnaire"}) mergeRows(describeTable(database_, name));
    }

    /// Adds the rows whose keys the result lacks.
    void mergeRows(const SessionTable& table) {
        const std::string columns = names(table);
        database_.execute("INSERT OR IGNORE INTO main." + table.name + "(" + columns + ") SELECT " + columns +
                          " FROM source." + table.name);
    }

    /// Whoever was erased from the result does not come back with a copy. The other way round nobody but the
    /// experimenter decides.
    void findErased() {
        left_out_ = erasedPeople(database_, "main", kSource);
        for (const auto& [code, surrogate] : left_out_)
            report_.erased.push_back(source_ + ": " + code + " was erased and is left out; this file still has them");
        for (const auto& [code, surrogate] : erasedPeople(database_, kSource, "main"))
            report_.erased.push_back(source_ + ": " + code + " was erased there; the result still has them");
    }

    /// Reads alone: a transaction that met a damaged page would keep nothing of what it wrote.
    void findDamaged() {
        study_damaged_ = taken_ == Taken::AsFarAsReadable;  // until all of its rows are read
        RowsSeen seen;
        damaged_rows_ = rowFaults(database_, kSource, taken_ == Taken::Whole ? nullptr : &seen);
        study_damaged_ = !seen.unreadable.empty() || (taken_ == Taken::AsFarAsReadable && !damaged_rows_.empty());
        for (const std::string& table : seen.unreadable)
            report_.damaged.push_back(source_ + ": " + table + " cannot be read: left out");
    }

    /// A damaged row goes nowhere: nor does anything of whom it is about.
    void leaveOutDamaged() {
        for (const RowFault& fault : damaged_rows_) {
            if (fault.participant_id.empty() && taken_ == Taken::Whole)
                refuse(titleOf(fault) + " is damaged: passung restore heals it");
            if (fault.participant_id.empty()) continue;
            database_.prepare("INSERT OR IGNORE INTO temp.left_out(participant_id) VALUES(?)")
                .bind(fault.participant_id)
                .run();
        }
    }

    void tellDamaged() {
        if (damaged_rows_.empty()) return;
        const bool may_hold = taken_ == Taken::AsFarAsReadable;
        const std::vector<RowFault> here = may_hold ? rowFaults(database_, "main") : std::vector<RowFault>();
        for (const RowFault& fault : damaged_rows_)
            tellLeftOut(may_hold && holdsRow(database_, kSource, fault, here),
                        titleOf(fault) + " is not as it was written");
    }

    bool isHeld(const std::string& session) const {
        return taken_ == Taken::AsFarAsReadable && holdsSession(database_, kSource, session);
    }

    /// Damage in the source is no loss where the result has what was once written there.
    void tellLeftOut(bool is_held, const std::string& what) {
        if (is_held)
            report_.held.push_back(what);
        else
            report_.damaged.push_back(source_ + ": " + what + ": left out");
    }

    void tellHealed(const std::vector<std::string>& healed) {
        report_.healed.insert(report_.healed.end(), healed.begin(), healed.end());
    }

    void mergeSessions(Healer& healer) {
        std::vector<std::pair<std::string, std::string>> sessions;  // id, title
        part("the list of sessions", [&] { findSessions(sessions); });
        for (const auto& [id, title] : sessions)
            part(
                title, [&, session = id] { mergeSession(session, healer); },
                [&, session = id] { return isHeld(session); });
    }

    void findSessions(std::vector<std::pair<std::string, std::string>>& found) {
        Statement left_out = database_.prepare(
            "SELECT participant_id || ', session ' || ordinal FROM source.session WHERE end_state IS NULL AND " +
            kKept + " ORDER BY participant_id, ordinal");
        while (left_out.step()) report_.unfinished.push_back(source_ + ": " + left_out.text(0));
        if (taken_ == Taken::AsFarAsReadable) return listSessions(found);  // such a session is left out by itself
        refuseWhere(
            "SELECT s.participant_id FROM source.session s JOIN main.session m USING(participant_id, ordinal) "
            "WHERE s.session_id<>m.session_id AND " +
                kKept,
            "participant code ", " stands for two people: their sessions differ");
        listSessions(found);
    }

    void listSessions(std::vector<std::pair<std::string, std::string>>& found) {
        Statement sessions = database_.prepare(
            "SELECT session_id, participant_id || ', session ' || ordinal FROM source.session WHERE end_state IS NOT "
            "NULL AND " +
            kKept + " ORDER BY participant_id, ordinal");
        while (sessions.step()) found.emplace_back(sessions.text(0), sessions.text(1));
    }

    void mergeSession(const std::string& id, Healer& healer) {
        const bool known = database_.prepare("SELECT 1 FROM main.session WHERE session_id=?").bind(id).step();
        if (known) tellHealed(healer.healSession(id));
        if (const SessionDamage damage = damageOf(database_, tables_, kSource, id); damage.any()) {
            for (const std::string& line : damage.lines()) tellLeftOut(isHeld(id), damage.name + ", " + line);
            return;
        }
        if (!known) {
            copySession(database_, tables_, kSource, id);
            ++report_.sessions;
            return;
        }
        if (sessionDigest(database_, tables_, "main", id) == sessionDigest(database_, tables_, kSource, id)) {
            ++report_.known;
            return;
        }
        const bool behind = sessionLacks(database_, "main", kSource, id);
        if (behind && sessionLacks(database_, kSource, "main", id)) {
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
            copySession(database_, tables_, kSource, id);
        }
        UnitedRemarks united;
        changeLater(database_, id, [&] { united = uniteRemarks(database_, id, remarks); });
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

    const Database& database_;
    std::string source_;
    MergeReport& report_;
    Taken taken_;
    std::vector<RowFault> damaged_rows_;  // of the source
    bool study_damaged_ = false;          // rows that everybody needs cannot be trusted
    std::string other_study_;             // why the source seems to be of another study
    std::vector<SessionTable> tables_;
    std::map<std::string, std::string> left_out_;  // code → surrogate
};

/// A source must be sound and of this program's schema: columns are copied by their names. Returns what is wrong with
/// its audit, which nothing but a person can judge.
Result<std::vector<std::string>> checkSource(const std::string& path) {
    const auto opened = openForReading(path, OlderFile::Refuse);
    if (!opened) return opened.errors();
    return guarded(path, [&] { return checkAudit(**opened).faults; });
}

/// A file that SQLite would write into is attached as a copy.
void mergeUntouched(const Database& database, const std::string& source, const Workshop& workshop,
                    MergeReport& report) {
    const bool rests = !staysUntouched(source);
    if (rests) openUntouched(source)->copyTo(workshop.source);
    Merge(database, source, report).run(rests ? workshop.source : source);
    removeDatabase(workshop.source);
}

/// What no source could heal.
void tellDamage(const Database& result, const std::string& out, MergeReport& report) {
    const auto tables = sessionTables(result);
    Statement sessions = result.prepare("SELECT session_id FROM session ORDER BY participant_id, ordinal");
    while (sessions.step()) {
        const SessionDamage damage = damageOf(result, tables, "main", sessions.text(0));
        for (const std::string& line : damage.lines()) report.damaged.push_back(out + ": " + damage.name + ", " + line);
    }
    for (const RowFault& fault : rowFaults(result, "main"))
        report.damaged.push_back(out + ": " + titleOf(fault) + " is not as it was written");
}

}  // namespace

Result<MergeReport> mergeDatabases(const std::vector<std::string>& sources, const std::string& to,
                                   const OpenOptions& options) {
    MergeReport report;
    for (const std::string& source : sources) {
        const auto faults = checkSource(source);
        if (!faults) return faults.errors();
        for (const std::string& fault : *faults) report.conflicts.push_back(source + ": audit: " + fault);
    }
    const std::string out = behindLink(to);
    const auto lock = ProcessLock::take(out);
    if (!lock) return lock.errors();
    return guarded(out, [&] {
        const Workshop workshop(out);
        if (fs::exists(out)) Database(out, OpenMode::ReadWrite).copyTo(workshop.part);
        // A log that outlives our own look at the file belongs to somebody who has it open.
        if (fs::exists(out + "-wal")) throw std::runtime_error("another program has this database open; end it first");
        {
            const OpenedDatabase opened = openForWriting(workshop.part, options);
            if (!opened.database) throw std::runtime_error(opened.errors.front().message);
            for (const std::string& source : sources) mergeUntouched(*opened.database, source, workshop, report);
            tellDamage(*opened.database, out, report);
        }
        if (options.group) keepPrivate(out, true);
        shareLike(out, workshop.part);
        std::error_code refused;
        fs::rename(workshop.part, out, refused);
        if (refused) throw std::runtime_error("cannot be written: " + refused.message());
        return report;
    });
}

Result<MergeReport> mergeDamaged(const std::string& source, const std::string& file, const std::string& out,
                                 const OpenOptions& options) {
    return guarded(out, [&] {
        MergeReport report;
        const OpenedDatabase opened = openForWriting(out, options);
        if (!opened.database) throw std::runtime_error(opened.errors.front().message);
        try {
            Merge(*opened.database, source, report, Taken::AsFarAsReadable).run(file);
        } catch (const SqliteError& error) {
            if (!isDamage(error)) throw;
            report = {};
            report.damaged.push_back(source + ": nothing of it can be read (" + error.what() + ")");
        }
        return report;
    });
}

}  // namespace passung::store
