#include "study/store/transfer/merge_session.h"

#include <map>

namespace passung::store {
namespace {

/// What the session consists of, a line each; remarks on it apart.
std::string contents(const std::string& schema) {
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

std::int64_t least(const Database& database, const std::vector<SessionTable>& tables, const std::string& source,
                   const SessionTable& table, const TableColumn& number, const std::string& id) {
    Statement find = database.prepare("SELECT coalesce(min(" + number.name + "), 0) FROM " + source + "." + table.name +
                                      " WHERE " + rowsOfSession(tables, table, source));
    find.bind(id).step();
    return find.integer(0);
}

}  // namespace

bool sessionLacks(const Database& database, const std::string& one, const std::string& other, const std::string& id) {
    Statement find = database.prepare(contents(other) + " EXCEPT SELECT * FROM (" + contents(one) + ") LIMIT 1");
    return find.bind(id).step();
}

void copySession(const Database& database, const std::vector<SessionTable>& tables, const std::string& source,
                 const std::string& id) {
    std::map<std::string, std::int64_t> offsets;
    for (const SessionTable& table : tables)
        if (const TableColumn* number = table.number())
            offsets[table.name] =
                database.integer("SELECT coalesce(max(" + number->name + "), 0) FROM main." + table.name) -
                least(database, tables, source, table, *number, id) + 1;
    for (const SessionTable& table : tables) {
        std::string values;
        for (const TableColumn& column : table.columns) {
            std::string value = column.name;
            const SessionTable* numbered = numberedBy(tables, table, column);
            if (numbered != nullptr)
                value += " + " + std::to_string(offsets[numbered->name]);
            else if (column.parent == "condition")
                value = "(SELECT m.condition_id FROM main.condition m JOIN " + source +
                        ".condition s USING("
                        "protocol_sha256, condition) WHERE s.condition_id=t." +
                        column.name + ")";
            values += (values.empty() ? "" : ", ") + value;
        }
        database
            .prepare("INSERT INTO main." + table.name + "(" + columnNames(table) + ") SELECT " + values + " FROM " +
                     source + "." + table.name + " t WHERE " + rowsOfSession(tables, table, source))
            .bind(id)
            .run();
    }
}

}  // namespace passung::store
