#include "study/store/rows/consent_rows.h"

#include "core/base/digest.h"
#include "study/store/schema/named_columns.h"

namespace passung::store {

void insertConsentClauses(const Database& database, const std::string& protocol_sha256,
                          const std::vector<plan::ConsentClause>& clauses) {
    std::int64_t position = 0;
    for (const plan::ConsentClause& clause : clauses) {
        for (const auto& [language, text] : clause.texts)
            insertRow(database, "consent_clause", Named{"protocol_sha256", protocol_sha256},
                      Named{"clause", clause.clause}, Named{"language", language}, Named{"text", text},
                      Named{"text_sha256", sha256Hex(text)}, Named{"required", clause.required},
                      Named{"position", position});
        ++position;
    }
}

std::vector<ConsentClauseRow> readConsentClauses(const Database& database) {
    const Selection<ConsentClauseRow> columns = {{"c.protocol_sha256", &ConsentClauseRow::protocol_sha256},
                                                 {"p.version", &ConsentClauseRow::protocol_version},
                                                 {"c.clause", &ConsentClauseRow::clause},
                                                 {"c.language", &ConsentClauseRow::language},
                                                 {"c.text", &ConsentClauseRow::text},
                                                 {"c.text_sha256", &ConsentClauseRow::text_sha256},
                                                 {"c.required", &ConsentClauseRow::required}};
    return columns.all(database,
                       "FROM consent_clause c JOIN protocol_version p USING(protocol_sha256) "
                       "ORDER BY p.name, p.version, p.protocol_sha256, c.position, c.language");
}

std::vector<ConsentRow> readConsents(const Database& database) {
    const Selection<ConsentRow> columns = {{"participant_id", &ConsentRow::participant_id},
                                           {"clause", &ConsentRow::clause},
                                           {"language", &ConsentRow::language},
                                           {"text_sha256", &ConsentRow::text_sha256},
                                           {"decision", &ConsentRow::decision},
                                           {"decided_utc", &ConsentRow::decided_utc}};
    return columns.all(database,
                       "FROM consent c WHERE consent_id=(SELECT max(consent_id) FROM consent d WHERE "
                       "d.participant_id=c.participant_id "
                       "AND d.clause=c.clause AND d.text_sha256=c.text_sha256) ORDER BY participant_id, consent_id");
}

}  // namespace passung::store
