#include "study/store/schema/schema_text.h"

#include <algorithm>
#include <optional>

#include "study/store/schema/revisions.h"
#include "study/store/schema/study_views.h"

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

/// The schema of a file that was upgraded to this revision.
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

/// The revisions that the file says it has. They follow one another from 1 on.
std::vector<std::int64_t> saidRevisions(const Database& database) {
    std::vector<std::int64_t> said;
    try {
        Statement rows = database.prepare("SELECT revision FROM main.schema_revision ORDER BY revision");
        while (rows.step()) said.push_back(rows.integer(0));
    } catch (const SqliteError&) {
        said.clear();  // cannot say
    }
    return said;
}

/// The number that is not its own, if there is one.
std::optional<std::int64_t> wrongNumber(const std::vector<std::int64_t>& said) {
    for (std::size_t i = 0; i < said.size(); ++i)
        if (said[i] != static_cast<std::int64_t>(i) + 1) return said.back();
    return std::nullopt;
}

/// The views as they should be; none where what they follow from is damaged itself.
std::vector<StudyViewText> viewTexts(const Database& database) {
    try {
        return studyViewTexts(database);
    } catch (const SqliteError&) {
        return {};
    }
}

/// Views whose name or statement is not as it was written. They are each study's own, and tell it themselves.
std::vector<SchemaFault> viewFaults(const Database& database, const std::vector<SchemaRow>& here) {
    std::vector<SchemaFault> faults;
    for (const SchemaRow& row : here) {
        const std::string name = markedName(row.sql).value_or(isStudyView(row.name) ? row.name : "");
        const bool own_table = row.type == "table" && !markedName(row.sql);
        if (name.empty() || own_table) continue;
        if (row.type == "view" && row.name == name && row.table == name && isAsWritten({name, row.sql})) continue;
        faults.push_back({row.rowid, {0, "view", name, name, {}}});
        for (const StudyViewText& view : viewTexts(database))
            if (view.name == name) faults.back().written.sql = view.sql;
    }
    return faults;
}

/// What a file of one revision would have to be explained by.
struct Verdict {
    std::vector<SchemaFault> faults;
    std::size_t too_new = 0;  // objects of later revisions
    std::size_t unexplained() const { return faults.size() + too_new; }
};

Verdict judge(const std::vector<SchemaRow>& here, const std::vector<SchemaRow>& newest, int number) {
    const std::vector<SchemaRow> written = number == schemaNumber() ? newest : schemaOf(number);
    const auto has = [](const std::vector<SchemaRow>& rows, const SchemaRow& row) {
        return std::any_of(rows.begin(), rows.end(), [&](const SchemaRow& r) { return r.name == row.name; });
    };
    Verdict verdict{compare(here, written), 0};
    for (const SchemaRow& row : newest)
        if (!has(written, row) && has(here, row)) ++verdict.too_new;
    return verdict;
}

struct Finding {
    std::vector<SchemaFault> faults;
    std::optional<std::int64_t> wrong_number;  // of the last revision
};

/// Takes the revision that explains the file best; the one that the file says comes first.
Finding findFaults(const Database& database) {
    const std::vector<SchemaRow> here = readSchema(database);
    if (here.empty() || database.integer("PRAGMA application_id") != kApplicationId) return {};
    const std::vector<std::int64_t> revisions = saidRevisions(database);
    const auto wrong = wrongNumber(revisions);
    const int said = wrong ? 0 : static_cast<int>(revisions.size());
    if (said > schemaNumber()) return {};
    const std::vector<SchemaRow> newest = schemaOf(schemaNumber());
    Verdict best = judge(here, newest, said > 0 ? said : schemaNumber());
    for (int number = schemaNumber(); number > 0 && best.unexplained() > 1; --number)
        if (Verdict verdict = judge(here, newest, number); verdict.unexplained() < best.unexplained())
            best = std::move(verdict);
    for (SchemaFault& fault : viewFaults(database, here)) best.faults.push_back(std::move(fault));
    return {std::move(best.faults), wrong};
}

std::vector<std::string> titlesOf(const Finding& finding) {
    std::vector<std::string> titles;
    for (const SchemaFault& fault : finding.faults) titles.push_back(fault.title());
    if (finding.wrong_number) titles.push_back("the schema's number " + std::to_string(*finding.wrong_number));
    return titles;
}

void mend(const Database& database, const SchemaFault& fault) {
    if (fault.written.type == "view" && fault.written.sql.empty()) {
        database.prepare("DELETE FROM main.sqlite_schema WHERE rowid=?").bind(*fault.rowid).run();
        return;
    }
    database.prepare("UPDATE main.sqlite_schema SET type=?2, name=?3, tbl_name=?4, sql=?5 WHERE rowid=?1")
        .bind(*fault.rowid, fault.written.type, fault.written.name, fault.written.table, nullIfEmpty(fault.written.sql))
        .run();
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
        Finding finding = findFaults(database);
        std::erase_if(finding.faults, [](const SchemaFault& fault) { return !fault.rowid; });
        for (const SchemaFault& fault : finding.faults) mend(database, fault);
        if (finding.wrong_number)
            database
                .prepare(
                    "UPDATE main.schema_revision SET revision=(SELECT count(*) FROM main.schema_revision) WHERE "
                    "revision=?")
                .bind(*finding.wrong_number)
                .run();
        return titlesOf(finding);
    } catch (const SqliteError& error) {
        if (!isDamage(error)) throw;
        return {};
    }
}

}  // namespace passung::store
