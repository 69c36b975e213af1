#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "study/store/schema/revisions.h"
#include "study/store/schema/view_columns.h"

namespace passung::store {
namespace {

using ColumnName = std::pair<std::string, std::string>;  // with its table first

/// What the revisions' SQL says of tables, and when it added columns to them.
struct Remarks {
    struct Remark {
        int revision = 0;
        std::string text;
    };
    std::map<std::string, Remark> tables;     // by name
    std::map<ColumnName, int> added_columns;  // with the revision
};

/// The word after `start` at the beginning of the line, up to a space or bracket; empty: the line begins otherwise.
std::string wordAfter(const std::string& line, std::string_view start) {
    if (!line.starts_with(start)) return {};
    return line.substr(start.size(), line.find_first_of(" (", start.size()) - start.size());
}

/// A comment between statements holds until the next one, of several lines as a whole.
Remarks readRemarks() {
    Remarks remarks;
    for (const Revision& revision : revisions()) {
        std::istringstream sql(revision.sql);
        std::string comment;
        bool goes_on = false;
        for (std::string line; std::getline(sql, line);) {
            if (line.starts_with("-- ")) {
                comment = (goes_on ? comment + " " : "") + line.substr(3);
                goes_on = true;
                continue;
            }
            goes_on = false;
            if (const std::string table = wordAfter(line, "CREATE TABLE "); !table.empty())
                remarks.tables[table] = {revision.number, comment};
            if (const std::string table = wordAfter(line, "ALTER TABLE "); !table.empty()) {
                const std::string column = wordAfter(line, "ALTER TABLE " + table + " ADD COLUMN ");
                remarks.added_columns[{table, column}] = revision.number;
            }
        }
    }
    return remarks;
}

/// Columns and rules of the table: what stands between the brackets of a CREATE TABLE, without comments.
std::vector<std::string> clausesOf(const std::string& sql) {
    std::vector<std::string> clauses(1);
    int depth = 0;
    for (std::size_t i = sql.find('('); i < sql.size(); ++i) {
        const char c = sql[i];
        if (sql.compare(i, 2, "--") == 0) {
            i = sql.find('\n', i) - 1;
            continue;
        }
        if (c == '(' && ++depth == 1) continue;
        if (c == ')' && --depth == 0) break;
        std::string& text = clauses.back();
        if (c == ',' && depth == 1) {
            clauses.emplace_back();
        } else if (c != ' ' && c != '\n') {
            text += c;
        } else if (!text.empty() && text.back() != ' ') {
            text += ' ';
        }
    }
    return clauses;
}

/// By the end of its name, where a unit or form stands.
std::string unitOf(const std::string& column) {
    constexpr std::array<std::pair<std::string_view, const char*>, 16> kEnds = {{{"_N_per_m", "N/m"},
                                                                                 {"_Nm_per_rad", "N·m/rad"},
                                                                                 {"_ns", "ns"},
                                                                                 {"_us", "µs"},
                                                                                 {"_ms", "ms"},
                                                                                 {"_um", "µm"},
                                                                                 {"_mm", "mm"},
                                                                                 {"_J", "J"},
                                                                                 {"_hz", "Hz"},
                                                                                 {"_percent", "%"},
                                                                                 {"_deg", "°"},
                                                                                 {"_utc", "ISO 8601, UTC"},
                                                                                 {"_json", "JSON"},
                                                                                 {"sha256", "SHA-256"},
                                                                                 {"_ticks", "ticks"},
                                                                                 {"_frames", "pictures"}}};
    for (const auto& [end, unit] : kEnds)
        if (column.ends_with(end)) return unit;
    return {};
}

/// Meanings by table and column; table `*`: of every other one. The statements of released revisions cannot hold them,
/// because files keep the statements' text, comments included.
using Meanings = std::map<ColumnName, std::string>;

Meanings readMeanings() {
    Meanings meanings;
    std::ifstream stream(PASSUNG_SOURCE_DIR "/study/store/schema/column_meanings.txt");
    for (std::string line; std::getline(stream, line);) {
        if (line.empty() || line.front() == '#') continue;
        const std::size_t dot = line.find('.'), space = line.find(' ');
        meanings[{line.substr(0, dot), line.substr(dot + 1, space - dot - 1)}] = line.substr(space + 1);
    }
    return meanings;
}

std::string meaningOf(const Meanings& meanings, const std::string& table, const std::string& column) {
    auto found = meanings.find({table, column});
    if (found == meanings.end()) found = meanings.find({"*", column});
    return found == meanings.end() ? "" : found->second;
}

std::string columnLine(const std::string& table, const std::string& clause, const Remarks& remarks) {
    static const Meanings meanings = readMeanings();
    std::istringstream words(clause);
    std::string name, type, rule;
    words >> name >> type >> std::ws;
    std::getline(words, rule);
    std::string meaning = meaningOf(meanings, table, name);
    if (const auto added = remarks.added_columns.find({table, name}); added != remarks.added_columns.end())
        meaning += "; since revision " + std::to_string(added->second);
    return "| `" + name + "` | " + type + " | " + unitOf(name) + " | " + (rule.empty() ? "" : "`" + rule + "`") +
           " | " + meaning + " |\n";
}

bool isRuleOfTable(const std::string& clause) {
    return clause.starts_with("PRIMARY KEY") || clause.starts_with("UNIQUE") || clause.starts_with("FOREIGN KEY");
}

std::string tableText(const std::string& name, const std::string& sql, const Remarks& remarks) {
    const Remarks::Remark& remark = remarks.tables.at(name);
    std::string text = "\n## " + name + "\n\nRevision " + std::to_string(remark.revision) +
                       (remark.text.empty() ? "" : ": " + remark.text) +
                       "\n\n| column | type | unit | rule | meaning |\n| --- | --- | --- | --- | --- |\n";
    std::string rules;
    for (const std::string& clause : clausesOf(sql)) {
        if (isRuleOfTable(clause))
            rules += "\n`" + clause + "`\n";
        else
            text += columnLine(name, clause, remarks);
    }
    return text + rules;
}

std::string viewsText() {
    std::string text =
        "\n# Views\n\nFor people who query the database: the columns of an export's tables, by the same names, and of "
        "v_cells a row for each measure. In `v_trials`, `v_cells` and `v_thresholds` a column for each factor stands "
        "before the one that is marked f, in `v_trials` one for each measure before m. `column_doc` tells the same, "
        "and "
        "of factors and measures, in the database. NA is NULL. Where a number needs more than SQL, the view is NULL: "
        "`start_tick` and `end_tick` where cycles were missed, estimates of `v_thresholds` where an answer was "
        "invalidated later; fits of thresholds, labels and classes of scores are in exports alone.\n";
    for (const StudyView which : kStudyViews) {
        const ViewText& view = textOf(which);
        text += "\n## " + view.name + "\n\n| column | unit | meaning | formula |\n| --- | --- | --- | --- |\n";
        for (const ViewColumn& column : view.columns)
            text += "| " + std::string(column.name == view.factors_before ? "f " : "") +
                    (column.name == view.measures_before ? "m " : "") + "`" + column.name + "` | " + column.unit +
                    " | " + column.label + " | " + column.formula + " |\n";
    }
    return text;
}

std::string schemaDocument() {
    const Database database(":memory:", OpenMode::ReadWrite);
    upgradeSchema(database, "2000-01-01T00:00:00Z");
    std::string text =
        "# Schema of a study's database\n\nMade by a test from the numbered revisions and the meanings of columns in "
        "`schema`. Times in ns are monotonic, counted from the segment's zero. NULL means \"not measured\" where "
        "nothing else is said. All tables are STRICT.\n\n"
        "| revision | what it brought | oldest program that reads it knows revision |\n| --- | --- | --- |\n";
    for (const Revision& revision : revisions())
        text += "| " + std::to_string(revision.number) + " | " + revision.sentence + " | " +
                std::to_string(revision.oldest_reader) + " |\n";
    const Remarks remarks = readRemarks();
    Statement tables = database.prepare(
        "SELECT name, sql FROM sqlite_schema WHERE type='table' AND name NOT LIKE 'sqlite_%' ORDER BY rowid");
    while (tables.step()) text += tableText(tables.text(0), tables.text(1), remarks);
    return text + viewsText();
}

TEST(SchemaDocument, IsWhatTheCommittedFileSays) {
    // Truth: regression (study/store/SCHEMA.md; set PASSUNG_WRITE_SCHEMA=1 to write it anew after a new revision).
    const std::string path = PASSUNG_SOURCE_DIR "/study/store/SCHEMA.md";
    const std::string text = schemaDocument();
    if (std::getenv("PASSUNG_WRITE_SCHEMA") != nullptr) std::ofstream(path, std::ios::binary) << text;
    std::ifstream stream(path, std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), text);
}

TEST(SchemaDocument, HasEveryColumnThatTheDatabaseHas) {
    // Truth: SQLite's own list of columns.
    const Database database(":memory:", OpenMode::ReadWrite);
    upgradeSchema(database, "2000-01-01T00:00:00Z");
    const std::string text = schemaDocument();
    Statement columns = database.prepare(
        "SELECT t.name, c.name, c.type FROM sqlite_schema t, pragma_table_info(t.name) c WHERE t.type='table'");
    int found = 0;
    for (; columns.step(); ++found) {
        const std::size_t table = text.find("\n## " + columns.text(0) + "\n");
        ASSERT_NE(table, std::string::npos) << columns.text(0);
        const std::size_t end = text.find("\n## ", table + 1);
        EXPECT_NE(text.substr(table, end - table).find("\n| `" + columns.text(1) + "` | " + columns.text(2) + " |"),
                  std::string::npos)
            << columns.text(0) << "." << columns.text(1);
    }
    EXPECT_GT(found, 200);
}

TEST(SchemaDocument, SaysWhatEveryColumnMeansAndNothingOfOthers) {
    // Truth: SQLite's own list of columns.
    const Database database(":memory:", OpenMode::ReadWrite);
    upgradeSchema(database, "2000-01-01T00:00:00Z");
    Meanings unused = readMeanings();
    const Meanings meanings = unused;
    Statement columns = database.prepare(
        "SELECT t.name, c.name FROM sqlite_schema t, pragma_table_info(t.name) c WHERE t.type='table'");
    while (columns.step()) {
        const std::string table = columns.text(0), column = columns.text(1);
        EXPECT_NE(meaningOf(meanings, table, column), "") << table << "." << column;
        if (unused.erase({table, column}) == 0 && meanings.count({table, column}) == 0) unused.erase({"*", column});
    }
    for (const auto& [name, meaning] : unused) ADD_FAILURE() << name.first << "." << name.second << " is no column";
}

}  // namespace
}  // namespace passung::store
