#include "study/store/rows/audit.h"

#include <set>

#include "core/base/digest.h"
#include "study/store/rows/tombstone.h"

namespace passung::store {
namespace {

std::string linkHash(const std::string& previous, const std::string& t_utc, const std::string& actor,
                     const std::string& action, const std::string& detail_sha256) {
    return sha256Hex(JsonObject()
                         .text("prev_hash", previous)
                         .text("t_utc", t_utc)
                         .text("actor", actor)
                         .text("action", action)
                         .text("detail_sha256", detail_sha256)
                         .str());
}

/// What stands in the place of details that were taken away.
std::set<std::string> erasedDetails(const Database& database) {
    std::set<std::string> details;
    Statement erased =
        database.prepare("SELECT json_extract(detail_json, '$.surrogate') FROM audit WHERE action='erase'");
    while (erased.step()) details.insert(erasedDetail(erased.text(0)));
    return details;
}

std::string linkHash(const AuditRow& row) {
    return linkHash(row.prev_hash, row.t_utc, row.actor, row.action, row.detail_sha256);
}

}  // namespace

std::string erasedDetail(const std::string& surrogate) { return JsonObject().text("erased", surrogate).str(); }

void appendAudit(const Database& database, const Actor& actor, const std::string& action, JsonObject detail) {
    const std::string text = detail.text("nonce", randomHex(16)).str();
    const std::string detail_sha256 = sha256Hex(text);
    const std::string previous = database.text("SELECT hash FROM audit ORDER BY audit_id DESC LIMIT 1");
    const std::string hash = linkHash(previous, actor.now_utc, actor.name, action, detail_sha256);
    database
        .prepare(
            "INSERT INTO audit(t_utc, actor, action, detail_json, prev_hash, hash, detail_sha256) "
            "VALUES(?, ?, ?, ?, ?, ?, ?)")
        .bind(actor.now_utc, actor.name, action, text, previous, hash, detail_sha256)
        .run();
}

void eraseAuditDetails(const Database& database, const std::string& participant, const std::string& surrogate) {
    database.prepare("UPDATE audit SET detail_json=?2 WHERE json_extract(detail_json, '$.participant')=?1")
        .bind(participant, erasedDetail(surrogate))
        .run();
}

std::vector<AuditRow> auditRows(const Database& database, const std::string& schema,
                                const std::map<std::string, std::string>& left_out) {
    std::vector<AuditRow> rows;
    Statement row = database.prepare(
        "SELECT t_utc, actor, action, detail_json, prev_hash, hash, detail_sha256, "
        "json_extract(detail_json, '$.participant'), json_extract(detail_json, '$.erased') IS NOT NULL FROM " +
        schema + ".audit ORDER BY audit_id");
    while (row.step()) {
        const auto erased = left_out.find(row.text(7));
        const bool leaves = erased != left_out.end();
        rows.push_back({row.text(0), row.text(1), row.text(2), leaves ? erasedDetail(erased->second) : row.text(3),
                        row.text(4), row.text(5), row.text(6), leaves || row.integer(8) != 0});
    }
    return rows;
}

void mergeAudit(const Database& database, const std::vector<AuditRow>& rows) {
    Statement known = database.prepare("SELECT 1 FROM audit WHERE hash=?");
    Statement insert = database.prepare(
        "INSERT INTO audit(t_utc, actor, action, detail_json, prev_hash, hash, detail_sha256) "
        "VALUES(?, ?, ?, ?, ?, ?, ?)");
    for (const AuditRow& row : rows)
        if (!known.bind(row.hash).step())
            insert.bind(row.t_utc, row.actor, row.action, row.detail_json, row.prev_hash, row.hash, row.detail_sha256)
                .run();
}

std::int64_t erasedCodesTo(const Database& database, plan::ParticipantKind kind) {
    Statement last = database.prepare(
        "SELECT coalesce(max(json_extract(detail_json, '$.codes_to')), 0) FROM audit "
        "WHERE action='erase' AND json_extract(detail_json, '$.kind')=?");
    last.bind(plan::participantKindName(kind)).step();
    return last.integer(0);
}

std::vector<std::string> healAudit(const Database& database, const std::string& source) {
    std::map<std::string, AuditRow> whole;  // by hash
    for (AuditRow& row : auditRows(database, source, erasedPeople(database, "main", source)))
        if (linkHash(row) == row.hash && (row.erased || sha256Hex(row.detail_json) == row.detail_sha256))
            whole.emplace(row.hash, std::move(row));
    const std::set<std::string> erased = erasedDetails(database);
    std::vector<std::pair<std::int64_t, const AuditRow*>> healed;
    Statement row = database.prepare(
        "SELECT audit_id, t_utc, actor, action, detail_json, prev_hash, hash, detail_sha256 FROM main.audit");
    while (row.step()) {
        const std::string own = linkHash(row.text(5), row.text(1), row.text(2), row.text(3), row.text(7));
        const bool detail_fits = erased.count(row.text(4)) != 0 || sha256Hex(row.text(4)) == row.text(7);
        if (own == row.text(6) && detail_fits) continue;
        auto there = whole.find(row.text(6));
        if (there == whole.end()) there = whole.find(own);  // the hash itself may be what is damaged
        if (there != whole.end()) healed.emplace_back(row.integer(0), &there->second);
    }
    row.reset();
    std::vector<std::string> lines;
    for (const auto& [number, is] : healed) {
        database
            .prepare(
                "UPDATE main.audit SET t_utc=?, actor=?, action=?, detail_json=?, prev_hash=?, hash=?, detail_sha256=? "
                "WHERE audit_id=?")
            .bind(is->t_utc, is->actor, is->action, is->detail_json, is->prev_hash, is->hash, is->detail_sha256, number)
            .run();
        lines.push_back("audit, row " + std::to_string(number));
    }
    return lines;
}

AuditReport checkAudit(const Database& database) {
    AuditReport report;
    const std::set<std::string> surrogates = erasedDetails(database);
    const auto report_fault = [&](std::int64_t row, const char* what) {
        report.faults.push_back("row " + std::to_string(row) + ": " + what);
    };
    std::set<std::string> before;
    Statement row = database.prepare(
        "SELECT audit_id, t_utc, actor, action, detail_json, prev_hash, hash, detail_sha256 FROM audit "
        "ORDER BY audit_id");
    while (row.step()) {
        const std::string detail = row.text(4), detail_sha256 = row.text(7);
        if (row.text(5).empty())
            ++report.chains;
        else if (before.count(row.text(5)) == 0)
            report_fault(row.integer(0), "does not follow a row before it");
        if (row.text(6) != linkHash(row.text(5), row.text(1), row.text(2), row.text(3), detail_sha256))
            report_fault(row.integer(0), "has been changed");
        const bool taken_away = surrogates.count(detail) > 0;
        if (!taken_away && sha256Hex(detail) != detail_sha256)
            report_fault(row.integer(0), "its detail has been changed");
        before.insert(row.text(6));
        ++report.rows;
        report.erased += taken_away ? 1 : 0;
    }
    return report;
}

}  // namespace passung::store
