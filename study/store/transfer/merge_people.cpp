#include "study/store/transfer/merge_people.h"

#include <array>
#include <string>
#include <vector>

#include "study/store/rows/tombstone.h"
#include "study/store/schema/session_tables.h"

namespace passung::store {
namespace {

std::string statusRank(const std::string& alias) {
    return "CASE " + alias +
           ".status WHEN 'enrolled' THEN 0 WHEN 'active' THEN 1 WHEN 'complete' THEN 2 WHEN 'withdrawn' THEN 3 "
           "ELSE 4 END";
}

}  // namespace

void mergePeople(const Database& database) {
    const std::string columns = columnNames(describeTable(database, "participant"));
    database.execute("INSERT OR IGNORE INTO main.participant(" + columns + ") SELECT " + columns +
                     " FROM source.participant WHERE " + kKept);
    database.execute(
        "UPDATE main.participant AS m SET status=s.status, status_reason=s.status_reason "
        "FROM source.participant AS s WHERE s.participant_id=m.participant_id AND s." +
        kKept + " AND " + statusRank("s") + ">" + statusRank("m"));
    database.execute(
        "INSERT INTO main.consent(participant_id, text_sha256, language, clause, decision, decided_utc) "
        "SELECT participant_id, text_sha256, language, clause, decision, decided_utc FROM source.consent s "
        "WHERE NOT EXISTS(SELECT 1 FROM main.consent m WHERE (m.participant_id, m.text_sha256, m.clause, "
        "m.decision, m.decided_utc)=(s.participant_id, s.text_sha256, s.clause, s.decision, s.decided_utc)) "
        "AND " +
        kKept + " ORDER BY consent_id");
}

void settleStandings(const Database& database) {
    Statement acts = database.prepare(
        "SELECT p.participant_id, p.status IN('excluded', 'withdrawn'), a.action, "
        "json_extract(a.detail_json, '$.status'), json_extract(a.detail_json, '$.reason'), s.status "
        "FROM main.participant p JOIN main.audit a ON a.audit_id=(SELECT b.audit_id FROM main.audit b WHERE "
        "json_extract(b.detail_json, '$.participant')=p.participant_id AND b.action IN('exclude', 'withdraw', "
        "'readmit') ORDER BY b.t_utc DESC, b.audit_id DESC LIMIT 1) "
        "JOIN source.participant s ON s.participant_id=p.participant_id WHERE s." +
        kKept);
    std::vector<std::array<std::string, 3>> settled;
    while (acts.step()) {
        const bool out = acts.integer(1) != 0, back = acts.text(2) == "readmit";
        if (back && !out) continue;
        const bool goes_on = back && acts.text(5) != "excluded" && acts.text(5) != "withdrawn";
        settled.push_back(
            {acts.text(0), goes_on ? acts.text(5) : acts.text(3), (back ? "readmitted: " : "") + acts.text(4)});
    }
    for (const auto& [code, status, reason] : settled)
        database.prepare("UPDATE main.participant SET status=?2, status_reason=?3 WHERE participant_id=?1")
            .bind(code, status, reason)
            .run();
}

}  // namespace passung::store
