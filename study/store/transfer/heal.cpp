#include "study/store/transfer/heal.h"

#include <algorithm>

namespace passung::store {
namespace {

/// What others are named by comes first.
int rankOf(const std::string& unit) {
    return unit == "session" ? 0 : unit == "plan" ? 1 : unit.starts_with("segment") ? 2 : 3;
}

/// Empty: no row of the unit was there when the run ended.
std::string hashOf(const std::map<std::string, std::string>& units, const std::string& unit) {
    const auto found = units.find(unit);
    return found == units.end() ? std::string() : found->second;
}

/// For a row that is not here: the number that it has there, or a new one where that is another row's.
std::int64_t freeNumber(const Database& database, const std::string& table, const std::string& number,
                        std::int64_t there, const std::map<std::int64_t, std::int64_t>& given) {
    std::int64_t last = database.integer("SELECT coalesce(max(" + number + "), 0) FROM main." + table);
    const bool is_taken =
        database.integer("SELECT count(*) FROM main." + table + " WHERE " + number + "=" + std::to_string(there)) > 0;
    bool is_given = false;
    for (const auto& [other, here] : given) {
        last = std::max(last, here);
        is_given = is_given || here == there;
    }
    return is_taken || is_given ? last + 1 : there;
}

}  // namespace

Healer::Healer(const Database& database, std::string source)
    : database_(database), source_(std::move(source)), tables_(sessionTables(database)) {
    database_.execute(
        "CREATE TEMP TABLE IF NOT EXISTS heal_number(table_name TEXT, there INTEGER, here INTEGER, PRIMARY "
        "KEY(table_name, there)); CREATE TEMP TABLE IF NOT EXISTS heal_later(schema TEXT, table_name TEXT, number "
        "INTEGER)");
}

std::vector<std::string> Healer::healSession(const std::string& session_id) {
    session_ = session_id;
    std::vector<std::string> healed;
    const SessionDamage damage = damageOf(database_, tables_, "main", session_id);
    if (!damage.any()) return healed;
    look();
    healChunks(damage, healed);
    if (damage.list) {
        healList();
        look();
    }
    const auto rest = [&] { return damageOf(database_, tables_, "main", session_id, SampleCheck::LeftOut); };
    const auto fitChanges = [&] {
        const SessionDamage now = rest();
        if ((now.changes || !now.units.empty()) && healChanges())
            healed.push_back(damage.name + ", what was changed later");
    };
    fitChanges();
    const auto unitsToHeal = [&] {
        std::vector<std::string> units = rest().units;
        for (const std::string& unit : lost_)
            if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
        return units;
    };
    std::vector<std::string> units = unitsToHeal();
    for (bool went_on = true; went_on && !units.empty();) {
        went_on = false;
        std::sort(units.begin(), units.end(), [](const std::string& a, const std::string& b) {
            return std::pair(rankOf(a), a.size()) < std::pair(rankOf(b), b.size());
        });
        for (const std::string& unit : units) {
            if (!healUnit(unit)) continue;
            healed.push_back(damage.name + ", " + unit);
            went_on = true;
        }
        units = unitsToHeal();
    }
    fitChanges();
    if (damage.list && !rest().list) healed.push_back(damage.name + ", the list of its hashes");
    return healed;
}

/// What both consist of now, and which of their rows are the same ones.
void Healer::look() {
    here_ = sessionValues(database_, tables_, "main", session_);
    there_ = sessionValues(database_, tables_, source_, session_);
    hashes_here_ = unitHashes(database_, "main", session_, here_.rows);
    hashes_there_ = unitHashes(database_, source_, session_, there_.rows);
    kept_ = keptHashes(database_, "main", session_);
    database_.execute("DELETE FROM temp.heal_number; DELETE FROM temp.heal_later");
    numbers_.clear();
    Statement insert = database_.prepare("INSERT INTO temp.heal_number(table_name, there, here) VALUES(?, ?, ?)");
    for (const auto& [name, rows_there] : there_.names) {
        const auto& rows_here = here_.names.at(name);
        std::map<std::string, std::int64_t> by_name;
        std::vector<std::int64_t> nameless;  // a damaged row has a wrong name: its place among the others tells it
        std::set<std::string> wanted;
        for (const auto& [number, row] : rows_there) wanted.insert(row);
        for (const auto& [number, row] : rows_here)
            if (wanted.count(row) == 0 || !by_name.emplace(row, number).second) nameless.push_back(number);
        auto next = nameless.begin();
        const std::string number = table(name).number()->name;
        for (const auto& [there, row] : rows_there) {
            const auto known = by_name.find(row);
            std::int64_t here = 0;
            if (known != by_name.end())
                here = known->second;
            else if (rows_here.size() == rows_there.size() && next != nameless.end())
                here = *next++;
            else
                here = freeNumber(database_, name, number, there, numbers_[name]);
            numbers_[name][there] = here;
            insert.bind(name, there, here).run();
        }
    }
    lookAtLater();
}

/// Rows that came later: they are no part of what the run wrote. One that is known here and missing is to come back.
void Healer::lookAtLater() {
    const LaterChanges changes = laterChanges(database_, "main", session_);
    const LaterChanges changes_there = laterChanges(database_, source_, session_);
    const auto isNew = [](const LaterChanges& known, const std::string& sha256) {
        const auto change = known.find(sha256);
        return change != known.end() && !change->second;
    };
    Statement later = database_.prepare("INSERT INTO temp.heal_later(schema, table_name, number) VALUES(?, ?, ?)");
    std::set<std::string> met;
    unknown_.clear();
    for (const ValueRow& row : here_.rows) {
        met.insert(row.sha256);
        if (isNew(changes, row.sha256)) later.bind("main", row.table, row.number).run();
        if (changes.count(row.sha256) == 0) unknown_[row.unit].insert(row.sha256);
    }
    lacking_.clear();
    lost_.clear();
    for (const ValueRow& row : there_.rows) {
        const bool here = met.count(row.sha256) != 0;
        if (isNew(changes, row.sha256) ? here : isNew(changes_there, row.sha256))
            later.bind(source_, row.table, row.number).run();
        else if (!here)
            ++lacking_[row.unit];
        if (!here && isNew(changes, row.sha256)) lost_.insert(row.unit);
        if (const auto rows = unknown_.find(row.unit); rows != unknown_.end() && !isNew(changes_there, row.sha256))
            rows->second.erase(row.sha256);
    }
}

/// Where something that came later is not as it was left, a row too many may be it.
bool Healer::mayLoseLater(const std::string& unit) const {
    const auto unknown = unknown_.find(unit), none = unknown_.end();
    const auto lacking = lacking_.find(unit);
    return !hashes_here_.changes_whole && unknown != none &&
           unknown->second.size() > (lacking == lacking_.end() ? 0 : lacking->second);
}

/// Where the kept hashes do not fit their own hash: those of units that are the same there are taken from there.
void Healer::healList() {
    const KeptHashes there = keptHashes(database_, source_, session_);
    if (!there.list_whole || there.units.empty()) return;
    Savepoint point(database_);
    database_.prepare("DELETE FROM main.session_hash WHERE session_id=?").bind(session_).run();
    database_
        .prepare("INSERT INTO main.session_hash(session_id, unit, sha256) SELECT session_id, unit, sha256 FROM " +
                 source_ + ".session_hash WHERE session_id=?")
        .bind(session_)
        .run();
    // It is the list of this session if nothing that is here says otherwise.
    for (const auto& [unit, sha256] : hashes_here_.units)
        if (hashOf(there.units, unit) != sha256 && hashOf(kept_.units, unit) == sha256) return;
    point.keep();
}

/// Where what people changed later does not fit: as they left it there, if with that everything fits.
bool Healer::healChanges() {
    Savepoint point(database_);
    database_.prepare("DELETE FROM main.later_change WHERE session_id=?").bind(session_).run();
    database_
        .prepare(
            "INSERT INTO main.later_change(session_id, after_sha256, before_sha256) SELECT session_id, after_sha256, "
            "before_sha256 FROM " +
            source_ + ".later_change WHERE session_id=?")
        .bind(session_)
        .run();
    const SessionDamage damage = damageOf(database_, tables_, "main", session_, SampleCheck::LeftOut);
    if (damage.changes || !damage.units.empty()) return false;
    point.keep();
    return true;
}

bool Healer::healUnit(const std::string& unit) {
    const std::string kept = hashOf(kept_.units, unit);
    const bool lost = lost_.count(unit) != 0;
    if (!lost && (kept.empty() || hashOf(hashes_here_.units, unit) == kept)) return false;
    if (hashOf(hashes_there_.units, unit) != kept) return false;
    if (mayLoseLater(unit)) return false;
    bool healed = false;
    {
        Savepoint point(database_);
        if (replaceUnit(unit)) {
            look();
            healed = hashOf(hashes_here_.units, unit) == kept;
        }
        if (healed) point.keep();
    }
    if (!healed) look();
    return healed;
}

bool Healer::replaceUnit(const std::string& unit) {
    if (unit == "plan") return copy(table("trial_plan"), "t.session_id=?2", 0), true;
    for (const char* owner : {"attempt", "questionnaire_run", "segment"}) {
        for (const auto& [there, name] : there_.names.at(owner)) {
            if (unit == name) return replaceOwner(owner, there), true;
            if (!unit.starts_with(name + ", ")) continue;
            const std::string child = unit.substr(name.size() + 2);
            if (unit == name + kSamplesUnit) return replaceSamples(there), true;
            const auto found =
                std::find_if(tables_.begin(), tables_.end(), [&](const SessionTable& t) { return t.name == child; });
            if (found != tables_.end()) return replaceChildren(owner, there, *found), true;
        }
    }
    const auto found =
        std::find_if(tables_.begin(), tables_.end(), [&](const SessionTable& t) { return t.name == unit; });
    if (found == tables_.end()) return false;
    if (unit == "session")
        copy(*found, "t.session_id=?2", 0);
    else
        replaceRows(*found, "t.session_id=?2", 0, "t.session_id=?2", 0);
    return true;
}

const SessionTable& Healer::table(const std::string& name) const {
    return *std::find_if(tables_.begin(), tables_.end(), [&](const SessionTable& table) { return table.name == name; });
}

/// The columns of a row t there as they are to be here. A number by which nothing refers to the row is ?3; where that
/// is NULL, the one that it has there; where that is taken, a new one.
std::string Healer::valuesOf(const SessionTable& table) const {
    std::string values;
    for (const TableColumn& column : table.columns) {
        std::string value = "t." + column.name;
        const SessionTable* numbered = numberedBy(tables_, table, column);
        if (numbered != nullptr && numbers_.count(numbered->name) != 0)
            value =
                "(SELECT here FROM temp.heal_number WHERE table_name='" + numbered->name + "' AND there=" + value + ")";
        else if (numbered != nullptr)
            value = "coalesce(?3, CASE WHEN NOT EXISTS(SELECT 1 FROM main." + table.name + " x WHERE x." + column.name +
                    "=" + value + ") THEN " + value + " END)";
        else if (column.parent == "condition")
            value = "(SELECT m.condition_id FROM main.condition m JOIN " + source_ +
                    ".condition s USING(protocol_sha256, condition) WHERE s.condition_id=" + value + ")";
        values += (values.empty() ? "" : ", ") + value;
    }
    return values;
}

/// Rows of a table that others refer to: in their place, so that what belongs to them stays. ?1: `key`, ?2: session.
void Healer::copy(const SessionTable& table, const std::string& where, std::int64_t key) {
    std::string keys, changes;
    for (const TableColumn& column : table.columns) {
        std::string& list = column.key > 0 ? keys : changes;
        list += (list.empty() ? "" : ", ") + column.name + (column.key > 0 ? "" : "=excluded." + column.name);
    }
    database_
        .prepare("INSERT INTO main." + table.name + "(" + columnNames(table) + ") SELECT " + valuesOf(table) +
                 " FROM " + source_ + "." + table.name + " t WHERE (?1=?1 OR ?2=?2) AND " + where + " ON CONFLICT(" +
                 keys + ") DO UPDATE SET " + changes)
        .bind(key, session_)
        .run();
}

/// Rows that were added later are no part of what the run wrote: they stay.
std::string Healer::notLater(const SessionTable& table, const std::string& schema) const {
    const TableColumn* number = table.number();
    if (number == nullptr) return "";
    return " AND t." + number->name + " NOT IN (SELECT number FROM temp.heal_later WHERE schema='" + schema +
           "' AND table_name='" + table.name + "')";
}

/// Rows of a table that no other refers to. As many as were here get the numbers of those.
void Healer::replaceRows(const SessionTable& table, const std::string& where_here, std::int64_t here,
                         const std::string& where_there, std::int64_t there) {
    const std::string those = " t WHERE (?1=?1 OR ?2=?2) AND ";
    const std::string rows_here = where_here + notLater(table, "main");
    const std::string rows_there = where_there + notLater(table, source_);
    const std::string insert = "INSERT INTO main." + table.name + "(" + columnNames(table) + ") SELECT " +
                               valuesOf(table) + " FROM " + source_ + "." + table.name + those + rows_there;
    const auto numbers = [&](const std::string& schema, const std::string& where, std::int64_t key) {
        std::vector<std::int64_t> found;
        Statement rows = database_.prepare("SELECT t." + table.number()->name + " FROM " + schema + "." + table.name +
                                           those + where + " ORDER BY 1");
        for (rows.bind(key, session_); rows.step();) found.push_back(rows.integer(0));
        return found;
    };
    const bool numbered = table.number() != nullptr;
    const auto old = numbered ? numbers("main", rows_here, here) : std::vector<std::int64_t>();
    database_.prepare("DELETE FROM main." + table.name + " AS" + those + rows_here).bind(here, session_).run();
    if (!numbered) {
        database_.prepare(insert).bind(there, session_).run();
        return;
    }
    const auto coming = numbers(source_, rows_there, there);
    Statement row = database_.prepare(insert + " AND t." + table.number()->name + "=?4");
    for (std::size_t i = 0; i < coming.size(); ++i)
        row.bind(there, session_, old.size() == coming.size() ? std::optional(old[i]) : std::nullopt, coming[i]).run();
}

/// A row that others belong to.
void Healer::replaceOwner(const std::string& owner, std::int64_t there) {
    const std::int64_t here = numbers_[owner][there];
    const std::string where = "t." + table(owner).number()->name + "=?1";
    if (owner != "attempt") return copy(table(owner), where, there);
    std::string valid = "1", reason;
    Statement now =
        database_.prepare("SELECT valid, coalesce(invalid_reason, '') FROM main.attempt WHERE attempt_id=?");
    if (now.bind(here).step()) valid = now.text(0), reason = now.text(1);
    now.reset();
    copy(table(owner), where, there);
    keepLaterInvalidation(here, valid, reason);
}

/// What belongs to it in one table.
void Healer::replaceChildren(const std::string& owner, std::int64_t there, const SessionTable& child) {
    const std::string column = table(owner).number()->name;
    const auto where = [&](const std::string& schema) {
        std::string text = "t." + column + "=?1";
        const std::string attempts =
            "(SELECT a.attempt_id FROM " + schema + ".attempt a WHERE a.segment_id=t.segment_id)";
        // What a later segment says about an attempt is the later one's.
        if (child.find("segment_id") != nullptr && child.find("attempt_id") != nullptr)
            text += owner == "attempt" ? " AND t.attempt_id IN " + attempts
                                       : " AND (t.attempt_id IS NULL OR t.attempt_id NOT IN " + attempts + ")";
        return text;
    };
    if (child.number() != nullptr && numbers_.count(child.name) != 0)
        copy(child, where(source_), there);
    else
        replaceRows(child, where("main"), numbers_[owner][there], where(source_), there);
}

/// An attempt that people called invalid since stays so.
void Healer::keepLaterInvalidation(std::int64_t here, const std::string& valid, const std::string& reason) {
    const auto whole = [&] {
        return unitHashes(database_, "main", session_, sessionValues(database_, tables_, "main", session_).rows)
            .changes_whole;
    };
    if (whole()) return;
    Savepoint point(database_);
    database_.prepare("UPDATE main.attempt SET valid=?2, invalid_reason=?3 WHERE attempt_id=?1")
        .bind(here, static_cast<std::int64_t>(std::stoll(valid)), nullIfEmpty(reason))
        .run();
    if (whole()) point.keep();
}

}  // namespace passung::store
