#include "study/store/postgres/push_copies.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/hex_text.h"
#include "study/store/rows/tombstone.h"

namespace passung::store {
namespace {

std::string hexOf(std::span<const std::byte> bytes) {
    return hexText(std::span(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace

std::string typeThere(const std::string& type) {
    if (type == "INTEGER") return "BIGINT";
    if (type == "REAL") return "DOUBLE PRECISION";
    return type == "BLOB" ? "BYTEA" : "TEXT";
}

Values valuesOf(const Statement& row, const std::vector<TableColumn>& columns) {
    Values values;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const int column = static_cast<int>(i);
        if (row.isNull(column))
            values.emplace_back();
        else if (columns[i].type == "REAL")
            values.push_back(fmt::format("{:.17g}", row.real(column)));
        else if (columns[i].type == "BLOB")
            values.push_back("\\x" + hexOf(row.blob(column)));
        else
            values.push_back(row.text(column));
    }
    return values;
}

std::vector<Copy> studyCopies(const Database& database) {
    const auto copyOf = [&](const std::string& name, std::vector<std::string> keys, std::string where = "") {
        SessionTable table = describeTable(database, name);
        const TableColumn* number = table.number();
        const std::string numbering = number != nullptr ? number->name : "";
        std::erase_if(table.columns, [&](const TableColumn& column) { return column.name == numbering; });
        if (keys.empty())
            for (const TableColumn& column : table.columns)
                if (column.key > 0) keys.push_back(column.name);
        const bool of_person = table.find("participant_id") != nullptr && name != "participant";
        if (table.find("participant_id") != nullptr) where = " WHERE " + kKept + where;
        return Copy{name, table.columns, keys, of_person ? "REFERENCES participant ON DELETE CASCADE" : "",
                    "SELECT " + joined(table.columns, nameOf) + " FROM " + name + where};
    };
    std::vector<Copy> copies;
    for (const std::string& name : tableNames(database)) {
        const SessionTable table = describeTable(database, name);
        if (name == "session" || name == "design_slot" || table.find("protocol_sha256") == nullptr) continue;
        copies.push_back(copyOf(name, name == "condition" ? std::vector<std::string>{"protocol_sha256", "condition"}
                                                          : std::vector<std::string>{}));
    }
    copies.push_back(copyOf("measure", {}));
    copies.push_back(copyOf("questionnaire", {}));
    copies.push_back(copyOf("participant", {}));
    copies.push_back(copyOf("consent", {"participant_id", "text_sha256", "clause", "decided_utc", "decision"}));
    copies.push_back(copyOf("design_slot", {"participant_id"}, " AND participant_id IS NOT NULL"));
    return copies;
}

std::vector<Copy> sessionCopies(const std::vector<SessionTable>& tables) {
    std::vector<Copy> copies;
    for (const SessionTable& table : tables) {
        Copy copy{table.name, table.columns, {}, "REFERENCES session ON DELETE CASCADE", {}};
        for (const TableColumn& column : table.columns)
            if (column.key > 0) copy.keys.push_back(column.name);
        std::string columns = joined(table.columns, [](const TableColumn& column) { return "t." + column.name; });
        if (table.name == "session") copy.reference = "";
        if (table.find("session_id") == nullptr) {
            copy.columns.push_back({"session_id", "TEXT", 0, true, {}, {}});
            columns += ", ?1";
        }
        if (std::find(copy.keys.begin(), copy.keys.end(), "session_id") == copy.keys.end())
            copy.keys.insert(copy.keys.begin(), "session_id");
        if (table.find("condition_id") != nullptr) {
            copy.columns.push_back({"condition", "TEXT", 0, false, {}, {}});
            columns += ", (SELECT condition FROM condition c WHERE c.condition_id=t.condition_id)";
        }
        copy.query = "SELECT " + columns + " FROM " + table.name + " t WHERE t." + rowsOfSession(tables, table, "main");
        copies.push_back(copy);
    }
    return copies;
}

}  // namespace passung::store
