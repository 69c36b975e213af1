#include "study/store/rows/consent_rows.h"

#include "core/base/digest.h"

namespace passung::store {

void insertConsentClauses(const Database& database, const std::string& protocol_sha256,
                          const std::vector<protocol::ConsentClause>& clauses) {
    Statement insert = database.prepare("INSERT INTO consent_clause VALUES(?, ?, ?, ?, ?, ?, ?)");
    std::int64_t position = 0;
    for (const protocol::ConsentClause& clause : clauses) {
        for (const auto& [language, text] : clause.texts)
            insert.bind(protocol_sha256, clause.clause, language, text, sha256Hex(text), clause.required, position)
                .run();
        ++position;
    }
}

std::vector<ConsentClauseRow> readConsentClauses(const Database& database) {
    std::vector<ConsentClauseRow> rows;
    Statement row = database.prepare(
        "SELECT c.protocol_sha256, p.version, c.clause, c.language, c.text, c.text_sha256, c.required "
        "FROM consent_clause c JOIN protocol_version p USING(protocol_sha256) "
        "ORDER BY p.name, p.version, p.protocol_sha256, c.position, c.language");
    while (row.step())
        rows.push_back(
            {row.text(0), row.text(1), row.text(2), row.text(3), row.text(4), row.text(5), row.integer(6) != 0});
    return rows;
}

std::vector<ConsentRow> readConsents(const Database& database) {
    std::vector<ConsentRow> rows;
    Statement row = database.prepare(
        "SELECT participant_id, clause, language, text_sha256, decision, decided_utc FROM consent c "
        "WHERE consent_id=(SELECT max(consent_id) FROM consent d WHERE d.participant_id=c.participant_id "
        "AND d.clause=c.clause AND d.text_sha256=c.text_sha256) ORDER BY participant_id, consent_id");
    while (row.step()) rows.push_back({row.text(0), row.text(1), row.text(2), row.text(3), row.text(4), row.text(5)});
    return rows;
}

}  // namespace passung::store
