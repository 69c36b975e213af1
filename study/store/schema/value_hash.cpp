#include "study/store/schema/value_hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <set>

#include "core/base/digest.h"
#include "study/store/schema/row_text.h"

namespace passung::store {
namespace {

/// Tables that hold hashes, of nothing that a run wrote.
constexpr std::array<const char*, 2> kHashTables = {"session_hash", "later_change"};

constexpr const char* kWhole = "";  // the unit over all units

/// What rows are called whatever their numbers: by table, then by number.
class RowNames {
public:
    RowNames(const Database& database, const std::string& schema, const std::string& session_id)
        : database_(database), schema_(schema), session_id_(session_id) {
        number("segment",
               "SELECT segment_id, 'segment ' || row_number() OVER (ORDER BY segment_id) FROM $.segment "
               "WHERE session_id=?1");
        number("trial_plan", "SELECT trial_id, 'trial ' || (trial_index + 1) FROM $.trial_plan WHERE session_id=?1");
        number("attempt",
               "SELECT attempt_id, 'trial ' || (trial_index + 1) || ', attempt ' || attempt_no FROM "
               "$.attempt JOIN $.trial_plan USING(trial_id) WHERE session_id=?1");
        number("questionnaire_run",
               "SELECT run_id, 'form ' || row_number() OVER (ORDER BY run_id) FROM "
               "$.questionnaire_run WHERE session_id=?1");
        number("stream",
               "SELECT stream_id, 'segment ' || n || ', ' || stream FROM $.stream JOIN (SELECT segment_id, "
               "row_number() OVER (ORDER BY segment_id) AS n FROM $.segment WHERE session_id=?1) "
               "USING(segment_id)");
        Statement segments = prepare(
            "SELECT attempt_id, a.segment_id FROM $.attempt a JOIN $.trial_plan "
            "USING(trial_id) WHERE session_id=?1");
        while (segments.step()) segment_of_[segments.integer(0)] = segments.integer(1);
    }

    /// "?" for a number that no row of the session has; tables without names of their own: the number's place.
    std::string name(const std::string& table, std::int64_t number) const {
        const auto names = names_.find(table);
        if (names == names_.end()) return "?";
        const auto found = names->second.find(number);
        return found == names->second.end() ? "?" : found->second;
    }
    const std::map<std::string, std::map<std::int64_t, std::string>>& all() const { return names_; }

    /// The segment in which the attempt ran; 0 if the session has no such attempt.
    std::int64_t segmentOf(std::int64_t attempt) const {
        const auto found = segment_of_.find(attempt);
        return found == segment_of_.end() ? 0 : found->second;
    }

private:
    Statement prepare(std::string sql) const {
        for (std::size_t at = 0; (at = sql.find("$.", at)) != std::string::npos;) sql.replace(at, 1, schema_);
        Statement statement = database_.prepare(sql);
        statement.bind(session_id_);
        return statement;
    }
    void number(const std::string& table, const std::string& sql) {
        auto& names = names_[table];
        Statement rows = prepare(sql);
        while (rows.step()) names[rows.integer(0)] = rows.text(1);
    }

    const Database& database_;
    const std::string& schema_;
    const std::string& session_id_;
    std::map<std::string, std::map<std::int64_t, std::string>> names_;
    std::map<std::int64_t, std::int64_t> segment_of_;
};

/// Reads one table's rows of a session.
class RowReader {
public:
    RowReader(const std::vector<SessionTable>& tables, const SessionTable& table, const RowNames& names)
        : table_(table), names_(names) {
        for (const TableColumn& column : table.columns) {
            const SessionTable* numbered = numberedBy(tables, table, column);
            refers_to_.push_back(numbered == nullptr ? "" : numbered->name);
        }
    }

    std::string query(const std::vector<SessionTable>& tables, const std::string& schema) const {
        std::string columns;
        for (const TableColumn& column : table_.columns) {
            std::string value = "t." + column.name;
            if (column.type == "BLOB") value = "NULL";  // samples: their checksum stands beside them
            if (column.parent == "condition")
                value = "(SELECT condition FROM " + schema + ".condition c WHERE c.condition_id=" + value + ")";
            columns += (columns.empty() ? "" : ", ") + value;
        }
        return "SELECT " + columns + " FROM " + schema + "." + table_.name + " t WHERE t." +
               rowsOfSession(tables, table_, schema);
    }

    ValueRow read(const Statement& row) const {
        ValueRow value{table_.name, 0, table_.name, {}};
        RowText text(table_.name);
        const TableColumn* own = table_.number();
        for (std::size_t i = 0; i < table_.columns.size(); ++i) {
            const TableColumn& column = table_.columns[i];
            const int at = static_cast<int>(i);
            if (own != nullptr && own->name == column.name)
                value.number = row.integer(at);
            else if (!refers_to_[i].empty() && !row.isNull(at))
                text.add(column.name, names_.name(refers_to_[i], row.integer(at)));
            else if (column.parent == "condition" && !row.isNull(at))
                text.add(column.name, row.text(at));
            else
                text.add(column, row, at);
        }
        value.unit = unitOf(row, value.number);
        value.sha256 = text.sha256();
        return value;
    }

private:
    /// The row's number in the table that it refers to; 0: none.
    std::int64_t reference(const Statement& row, const std::string& to) const {
        for (std::size_t i = 0; i < refers_to_.size(); ++i)
            if (refers_to_[i] == to && table_.columns[i].parent == to && !row.isNull(static_cast<int>(i)))
                return row.integer(static_cast<int>(i));
        return 0;
    }

    std::string unitOf(const Statement& row, std::int64_t number) const {
        const std::string& table = table_.name;
        if (table == "trial_plan") return "plan";
        if (table == "attempt" || table == "questionnaire_run" || table == "segment") return names_.name(table, number);
        const std::int64_t attempt = reference(row, "attempt"), segment = reference(row, "segment");
        // What a later segment says about an attempt of an earlier one is the later one's.
        if (attempt != 0 && (segment == 0 || segment == names_.segmentOf(attempt)))
            return names_.name("attempt", attempt) + (table == "sample_chunk" ? kSamplesUnit : ", " + table);
        if (segment != 0) return names_.name("segment", segment) + ", " + table;
        if (const std::int64_t form = reference(row, "questionnaire_run"); form != 0)
            return names_.name("questionnaire_run", form) + ", " + table;
        return table;
    }

    const SessionTable& table_;
    const RowNames& names_;
    std::vector<std::string> refers_to_;  // by column: the table whose numbers it holds; empty: none
};

bool holdsHashes(const SessionTable& table) {
    return std::find(kHashTables.begin(), kHashTables.end(), table.name) != kHashTables.end();
}

std::string hashOfAll(const std::map<std::string, std::string>& units) {
    Sha256 digest;
    for (const auto& [unit, sha256] : units) digest.update(unit + "=" + sha256 + "\n");
    return digest.hex();
}

/// Attempts, forms, segments and the plan have ended with the part that wrote them; the rest grows.
bool grows(const std::string& unit) { return unit.find(' ') == std::string::npos && unit != "plan"; }

/// A row that was changed before keeps what it was at first.
void insertChange(const Database& database, const std::string& session_id, const LaterChanges& earlier,
                  const std::string& after, std::optional<std::string> before) {
    if (const auto first = before ? earlier.find(*before) : earlier.end(); first != earlier.end()) {
        database.prepare("DELETE FROM later_change WHERE session_id=? AND after_sha256=?")
            .bind(session_id, first->first)
            .run();
        before = first->second;
    }
    database.prepare("INSERT OR IGNORE INTO later_change(session_id, after_sha256, before_sha256) VALUES(?, ?, ?)")
        .bind(session_id, after, before)
        .run();
}

}  // namespace

LaterChanges laterChanges(const Database& database, const std::string& schema, const std::string& session_id) {
    LaterChanges changes;
    Statement rows =
        database.prepare("SELECT after_sha256, before_sha256 FROM " + schema + ".later_change WHERE session_id=?");
    rows.bind(session_id);
    while (rows.step()) changes.emplace(rows.text(0), rows.optionalText(1));
    return changes;
}

SessionValues sessionValues(const Database& database, const std::vector<SessionTable>& tables,
                            const std::string& schema, const std::string& session_id) {
    const RowNames names(database, schema, session_id);
    SessionValues values;
    for (const SessionTable& table : tables) {
        if (holdsHashes(table)) continue;
        const RowReader reader(tables, table, names);
        Statement rows = database.prepare(reader.query(tables, schema));
        rows.bind(session_id);
        while (rows.step()) values.rows.push_back(reader.read(rows));
    }
    values.names = names.all();
    return values;
}

UnitHashes unitHashes(const Database& database, const std::string& schema, const std::string& session_id,
                      const std::vector<ValueRow>& rows) {
    const LaterChanges changes = laterChanges(database, schema, session_id);
    std::set<std::string> met;
    std::map<std::string, std::vector<std::string>> by_unit;
    for (const ValueRow& row : rows) {
        auto& hashes = by_unit[row.unit];
        const auto changed = changes.find(row.sha256);
        if (changed != changes.end()) met.insert(row.sha256);
        if (changed == changes.end())
            hashes.push_back(row.sha256);
        else if (changed->second)
            hashes.push_back(*changed->second);
    }
    UnitHashes found;
    found.changes_whole = met.size() == changes.size();
    for (auto& [unit, hashes] : by_unit) {
        if (hashes.empty()) continue;  // all of it came later
        std::sort(hashes.begin(), hashes.end());
        Sha256 digest;
        for (const std::string& hash : hashes) digest.update(hash);
        found.units[unit] = digest.hex();
    }
    return found;
}

KeptHashes keptHashes(const Database& database, const std::string& schema, const std::string& session_id) {
    KeptHashes kept;
    Statement rows = database.prepare("SELECT unit, sha256 FROM " + schema + ".session_hash WHERE session_id=?");
    rows.bind(session_id);
    std::string whole;
    while (rows.step()) {
        if (rows.text(0) == kWhole)
            whole = rows.text(1);
        else
            kept.units[rows.text(0)] = rows.text(1);
    }
    kept.list_whole = (kept.units.empty() && whole.empty()) || whole == hashOfAll(kept.units);
    return kept;
}

void sealSession(const Database& database, const std::string& session_id) {
    const SessionValues values = sessionValues(database, sessionTables(database), "main", session_id);
    const KeptHashes before = keptHashes(database, "main", session_id);
    auto kept = before.units;
    for (const auto& [unit, sha256] : unitHashes(database, "main", session_id, values.rows).units)
        if ((grows(unit) && before.list_whole) || kept.count(unit) == 0) kept[unit] = sha256;
    Statement insert =
        database.prepare("INSERT OR REPLACE INTO session_hash(session_id, unit, sha256) VALUES(?, ?, ?)");
    for (const auto& [unit, sha256] : kept) insert.bind(session_id, unit, sha256).run();
    if (before.list_whole) insert.bind(session_id, kWhole, hashOfAll(kept)).run();
}

void keepDamageKnown(const Database& database, const std::string& session_id) {
    const KeptHashes kept = keptHashes(database, "main", session_id);
    const SessionValues values = sessionValues(database, sessionTables(database), "main", session_id);
    const auto now = unitHashes(database, "main", session_id, values.rows).units;
    const bool whole = std::all_of(kept.units.begin(), kept.units.end(), [&](const auto& unit) {
        const auto found = now.find(unit.first);
        return !grows(unit.first) || (found != now.end() && found->second == unit.second);
    });
    if (whole) return;
    database.prepare("DELETE FROM session_hash WHERE session_id=? AND unit=?").bind(session_id, kWhole).run();
}

void changeLater(const Database& database, const std::string& session_id, const std::function<void()>& change) {
    if (!database.prepare("SELECT 1 FROM session_hash WHERE session_id=? LIMIT 1").bind(session_id).step())
        return change();
    const auto tables = sessionTables(database);
    std::map<std::pair<std::string, std::int64_t>, std::string> numbered;
    std::set<std::string> known;
    for (const ValueRow& row : sessionValues(database, tables, "main", session_id).rows) {
        if (row.number != 0) numbered[{row.table, row.number}] = row.sha256;
        known.insert(row.sha256);
    }
    change();
    const LaterChanges earlier = laterChanges(database, "main", session_id);
    for (const ValueRow& row : sessionValues(database, tables, "main", session_id).rows) {
        if (known.count(row.sha256) != 0) continue;
        const auto before = numbered.find({row.table, row.number});
        insertChange(database, session_id, earlier, row.sha256,
                     before == numbered.end() ? std::nullopt : std::optional(before->second));
    }
}

}  // namespace passung::store
