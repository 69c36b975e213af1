#include "study/store/schema_text.h"

#include <algorithm>
#include <optional>

#include "study/store/revisions.h"

namespace passung::store {
namespace {

/// A row of sqlite_schema.
struct SchemaRow {
    std::int64_t rowid = 0;
    std::string type, name, table, sql;
};

/// A row of the file, and what it was.
struct SchemaFault {
    std::optional<std::int64_t> rowid;  // nothing: it is gone
    SchemaRow written;
    std::string title() const {
        const std::string what = written.type + " " + written.name;
        return rowid ? "the schema's text of " + what : "the schema lacks " + what;
    }
};

std::vector<SchemaRow> readSchema(const Database& database) {
    std::vector<SchemaRow> all;
    Statement rows = database.prepare(
        "SELECT rowid, type, name, tbl_name, coalesce(sql, '') FROM main.sqlite_schema ORDER BY rowid");
    while (rows.step()) all.push_back({rows.integer(0), rows.text(1), rows.text(2), rows.text(3), rows.text(4)});
    return all;
}

bool isSame(const SchemaRow& one, const SchemaRow& other) {
    return one.type == other.type && one.name == other.name && one.table == other.table && one.sql == other.sql;
}

/// As a file holds it that was upgraded to this revision.
std::vector<SchemaRow> schemaOf(int number) {
    const Database fresh(":memory:", OpenMode::ReadWrite);
    for (const Revision& revision : revisions())
        if (revision.number <= number) fresh.execute(revision.sql);
    return readSchema(fresh);
}

/// The row of the file that was `written` and is no other one's. One flipped bit leaves the name or the statement.
const SchemaRow* partnerOf(const SchemaRow& written, const std::vector<const SchemaRow*>& left) {
    const auto find = [&](auto fits) {
        const auto found = std::find_if(left.begin(), left.end(), [&](const SchemaRow* row) { return fits(*row); });
        return found == left.end() ? nullptr : *found;
    };
    if (const SchemaRow* row = find([&](const SchemaRow& r) { return r.name == written.name; })) return row;
    return find([&](const SchemaRow& r) {
        return r.sql == written.sql && (!r.sql.empty() || r.table == written.table);  // an index that a table implies
    });
}

std::vector<SchemaFault> compare(const std::vector<SchemaRow>& here, const std::vector<SchemaRow>& written) {
    std::vector<const SchemaRow*> left;
    for (const SchemaRow& row : here) left.push_back(&row);
    std::vector<SchemaRow> differ;
    for (const SchemaRow& row : written) {
        const auto same = std::find_if(left.begin(), left.end(), [&](const SchemaRow* r) { return isSame(*r, row); });
        if (same == left.end())
            differ.push_back(row);
        else
            left.erase(same);
    }
    std::vector<SchemaFault> faults;
    for (const SchemaRow& row : differ) {
        const SchemaRow* partner = partnerOf(row, left);
        faults.push_back({partner == nullptr ? std::nullopt : std::optional(partner->rowid), row});
        std::erase(left, partner);
    }
    return faults;
}

/// While it lives, SQLite reads a schema whose text it does not understand, as far as it does.
class LenientSchema {
public:
    explicit LenientSchema(const Database& database) : database_(database) {
        database_.execute("PRAGMA writable_schema=ON");
    }
    ~LenientSchema() {
        try {
            database_.execute("PRAGMA writable_schema=RESET");
        } catch (const SqliteError&) {
            // the next statement meets the same
        }
    }
    LenientSchema(const LenientSchema&) = delete;
    LenientSchema& operator=(const LenientSchema&) = delete;

private:
    const Database& database_;
};

/// The revision that the file says it has; 0 where it cannot say.
int saidRevision(const Database& database) {
    try {
        return fileSchemaNumber(database);
    } catch (const SqliteError&) {
        return 0;
    }
}

/// By the revision that the file is nearest to, where the one that it says does not explain it.
std::vector<SchemaFault> findFaults(const Database& database) {
    const std::vector<SchemaRow> here = readSchema(database);
    const int said = saidRevision(database);
    if (here.empty() || database.integer("PRAGMA application_id") != kApplicationId || said > schemaNumber()) return {};
    std::vector<SchemaFault> fewest = compare(here, schemaOf(said > 0 ? said : schemaNumber()));
    for (int number = schemaNumber(); number > 0 && fewest.size() > 1; --number)
        if (std::vector<SchemaFault> faults = compare(here, schemaOf(number)); faults.size() < fewest.size())
            fewest = std::move(faults);
    return fewest;
}

std::vector<std::string> titlesOf(const std::vector<SchemaFault>& faults) {
    std::vector<std::string> titles;
    for (const SchemaFault& fault : faults) titles.push_back(fault.title());
    return titles;
}

}  // namespace

std::vector<std::string> schemaFaults(const Database& database) {
    try {
        const LenientSchema lenient(database);
        return titlesOf(findFaults(database));
    } catch (const SqliteError& error) {
        if (!isDamage(error)) throw;
        return {};  // SQLite's own check tells it
    }
}

std::vector<std::string> mendSchema(const Database& database) {
    try {
        const LenientSchema lenient(database);
        std::vector<SchemaFault> faults = findFaults(database);
        std::erase_if(faults, [](const SchemaFault& fault) { return !fault.rowid; });
        for (const SchemaFault& fault : faults)
            database.prepare("UPDATE main.sqlite_schema SET type=?2, name=?3, tbl_name=?4, sql=?5 WHERE rowid=?1")
                .bind(*fault.rowid, fault.written.type, fault.written.name, fault.written.table,
                      nullIfEmpty(fault.written.sql))
                .run();
        return titlesOf(faults);
    } catch (const SqliteError& error) {
        if (!isDamage(error)) throw;
        return {};
    }
}

}  // namespace passung::store
