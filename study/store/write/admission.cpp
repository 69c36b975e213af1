#include "study/store/write/admission.h"

#include <stdexcept>

namespace passung::store {
namespace {

/// The latest decision on any text of the clause that this protocol has, in whatever language it was read, must be yes.
constexpr const char* kMissingClauses =
    "SELECT DISTINCT q.clause, q.position FROM consent_clause q WHERE q.protocol_sha256=?1 AND q.required "
    "AND coalesce((SELECT c.decision FROM consent c WHERE c.participant_id=?2 AND c.clause=q.clause AND c.text_sha256 "
    "IN(SELECT t.text_sha256 FROM consent_clause t WHERE t.protocol_sha256=?1 AND t.clause=q.clause) "
    "ORDER BY c.consent_id DESC LIMIT 1), '')<>'yes' ORDER BY q.position";

}  // namespace

void requireAdmission(const Database& database, const std::string& protocol_sha256, const std::string& participant,
                      std::optional<plan::ParticipantKind> newcomer) {
    Statement find = database.prepare("SELECT kind, status FROM participant WHERE participant_id=?");
    const bool enrolled = find.bind(participant).step();
    if (!enrolled && !newcomer) throw std::runtime_error("participant " + participant + " is not enrolled");
    const std::string status = enrolled ? find.text(1) : "";
    if (status == "excluded" || status == "withdrawn")
        throw std::runtime_error("participant " + participant + " is " + status + " and takes part no more");
    if ((enrolled ? find.text(0) : plan::participantKindName(*newcomer)) == "simulated") return;
    std::string missing;
    Statement clauses = database.prepare(kMissingClauses);
    clauses.bind(protocol_sha256, participant);
    while (clauses.step()) missing += (missing.empty() ? "" : ", ") + clauses.text(0);
    if (!missing.empty())
        throw std::runtime_error("participant " + participant +
                                 " has not consented to what this protocol requires: " + missing);
}

}  // namespace passung::store
