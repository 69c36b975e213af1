#include "study/store/people/participant_records.h"

#include <algorithm>
#include <stdexcept>

#include "study/store/people/erase.h"
#include "study/store/people/readmit.h"
#include "study/store/rows/consent_rows.h"
#include "study/store/rows/participant_rows.h"
#include "study/store/write/store.h"
#include "study/store/write/writer_thread.h"

namespace passung::store {
namespace {

constexpr const char* kWithdraw = "withdraw";

void requireEnrolled(const Database& database, const std::string& code) {
    if (!database.prepare("SELECT 1 FROM participant WHERE participant_id=?").bind(code).step())
        throw std::runtime_error("participant " + code + " is not enrolled");
}

/// Every yes that still holds is followed by its end.
void withdrawConsents(const Database& database, const Actor& actor, const std::string& code) {
    database
        .prepare(
            "INSERT INTO consent(participant_id, text_sha256, language, clause, decision, decided_utc) "
            "SELECT participant_id, text_sha256, language, clause, 'withdrawn', ?2 FROM consent c "
            "WHERE participant_id=?1 AND decision='yes' AND consent_id=(SELECT max(consent_id) FROM consent d "
            "WHERE d.participant_id=?1 AND d.clause=c.clause AND d.text_sha256=c.text_sha256) ORDER BY consent_id")
        .bind(code, actor.now_utc)
        .run();
}

/// Status, slot and audit of somebody who takes part no more.
void leave(const Database& database, const Actor& actor, const std::string& code, const char* status,
           const std::string& reason, const std::string& action) {
    Transaction transaction(database);
    requireEnrolled(database, code);
    JsonObject detail;
    detail.text("participant", code).text("status", status).text("reason", reason);
    describeStanding(database, code, detail);
    const bool excluded = std::string_view(status) == "excluded";
    Statement set = database.prepare(
        "UPDATE participant SET status=?2, status_reason=?3 WHERE participant_id=?1 AND status<>?2 "
        "AND status<>'excluded'");
    set.bind(code, status, reason).run();
    if (database.changes() == 0) throw std::runtime_error("participant " + code + " is already out of the study");
    database
        .prepare(std::string("UPDATE design_slot SET state='free', participant_id=NULL WHERE participant_id=?") +
                 (excluded ? "" : " AND state='assigned'"))
        .bind(code)
        .run();
    if (action == kWithdraw) withdrawConsents(database, actor, code);
    appendAudit(database, actor, action, detail);
    transaction.commit();
}

std::vector<ConsentClauseRow> latestClauses(const Database& database, const std::string& language) {
    std::vector<ConsentClauseRow> clauses = readConsentClauses(database);
    const std::string latest =
        database.text("SELECT protocol_sha256 FROM protocol_version ORDER BY rowid DESC LIMIT 1");
    std::erase_if(clauses, [&](const ConsentClauseRow& row) { return row.protocol_sha256 != latest; });
    if (clauses.empty()) throw std::runtime_error("the protocol in this database asks for no consent");
    std::erase_if(clauses, [&](const ConsentClauseRow& row) { return row.language != language; });
    if (clauses.empty()) throw std::runtime_error("the protocol has no text of consent in \"" + language + '"');
    return clauses;
}

}  // namespace

const char* consentName(Consent decision) {
    switch (decision) {
        case Consent::Yes:
            return "yes";
        case Consent::No:
            return "no";
        case Consent::Withdrawn:
            break;
    }
    return "withdrawn";
}

Result<Done> ParticipantRecords::enrol(const std::string& code, plan::ParticipantKind kind,
                                       const std::string& created_utc) {
    return store_.thread_->call([&](const Database& database) {
        Transaction transaction(database);
        if (!insertParticipant(database, code, kind, created_utc, store_.options_.station))
            throw std::runtime_error("participant " + code + " is already enrolled");
        appendAudit(database, actor_, "enrol",
                    JsonObject().text("participant", code).text("kind", plan::participantKindName(kind)));
        transaction.commit();
        return Done{};
    });
}

Result<std::vector<std::string>> ParticipantRecords::decide(const std::string& code,
                                                            const std::vector<std::string>& clauses,
                                                            const std::string& language, Consent decision) {
    return store_.thread_->call([&](const Database& database) {
        Transaction transaction(database);
        requireEnrolled(database, code);
        std::vector<ConsentClauseRow> asked = latestClauses(database, language);
        for (const std::string& name : clauses)
            if (std::none_of(asked.begin(), asked.end(), [&](const auto& row) { return row.clause == name; }))
                throw std::runtime_error("the protocol has no clause of consent \"" + name + '"');
        std::erase_if(asked, [&](const ConsentClauseRow& row) {
            return !clauses.empty() && std::find(clauses.begin(), clauses.end(), row.clause) == clauses.end();
        });
        std::vector<std::string> decided;
        Statement insert = database.prepare(
            "INSERT INTO consent(participant_id, text_sha256, language, clause, decision, decided_utc) "
            "VALUES(?, ?, ?, ?, ?, ?)");
        for (const ConsentClauseRow& row : asked) {
            insert.bind(code, row.text_sha256, language, row.clause, consentName(decision), actor_.now_utc).run();
            appendAudit(database, actor_, "consent",
                        JsonObject()
                            .text("participant", code)
                            .text("clause", row.clause)
                            .text("decision", consentName(decision))
                            .text("text_sha256", row.text_sha256));
            decided.push_back(row.clause);
        }
        transaction.commit();
        return decided;
    });
}

Result<Done> ParticipantRecords::withdraw(const std::string& code, const std::string& reason) {
    return store_.thread_->call([&](const Database& database) {
        leave(database, actor_, code, "withdrawn", reason, kWithdraw);
        return Done{};
    });
}

Result<Done> ParticipantRecords::exclude(const std::string& code, const std::string& reason,
                                         const std::string& action) {
    return store_.thread_->call([&](const Database& database) {
        leave(database, actor_, code, "excluded", reason, action);
        return Done{};
    });
}

Result<bool> ParticipantRecords::readmit(const std::string& code, const std::string& reason) {
    return store_.thread_->call(
        [&](const Database& database) { return store::readmit(database, actor_, code, reason); });
}

Result<std::string> ParticipantRecords::erase(const std::string& code) {
    return store_.thread_->call(
        [&](const Database& database) { return eraseParticipant(database, store_.thread_->path(), code, actor_); });
}

Result<bool> ParticipantRecords::eraseFromBackup(const std::string& code) {
    return store_.thread_->call([&](const Database& database) {
        Statement find = database.prepare("SELECT identity FROM participant WHERE participant_id=?");
        if (!find.bind(code).step()) throw std::runtime_error("participant " + code + " is not enrolled");
        return store::eraseFromBackup(store_.thread_->path(), find.text(0), actor_);
    });
}

}  // namespace passung::store
