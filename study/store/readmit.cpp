#include "study/store/readmit.h"

#include <stdexcept>

namespace passung::store {
namespace {

struct Exclusion {
    std::string status = "enrolled";  // before; of audits that do not say it
    std::int64_t slot_id = 0;         // 0: none
    std::string slot_state;
};

/// The newest thing that was done to the participant's standing, which has to be an exclusion.
Exclusion lastExclusion(const Database& database, const std::string& code) {
    Statement find = database.prepare(
        "SELECT action, json_extract(detail_json, '$.status_before'), json_extract(detail_json, '$.slot_id'), "
        "json_extract(detail_json, '$.slot_state') FROM audit WHERE json_extract(detail_json, '$.participant')=? "
        "AND action IN('exclude', 'withdraw', 'readmit') ORDER BY audit_id DESC LIMIT 1");
    if (!find.bind(code).step() || find.text(0) == "readmit")
        throw std::runtime_error("participant " + code + " is not excluded");
    if (find.text(0) == "withdraw")
        throw std::runtime_error("participant " + code + " has withdrawn: only they could take that back");
    Exclusion exclusion;
    if (!find.isNull(1)) exclusion.status = find.text(1);
    if (!find.isNull(2)) exclusion.slot_id = find.integer(2);
    if (!find.isNull(3)) exclusion.slot_state = find.text(3);
    return exclusion;
}

}  // namespace

void describeStanding(const Database& database, const std::string& code, protocol::JsonObject& detail) {
    Statement find = database.prepare(
        "SELECT status, slot_id, state FROM participant LEFT JOIN design_slot USING(participant_id) "
        "WHERE participant_id=?");
    if (!find.bind(code).step()) return;
    detail.text("status_before", find.text(0));
    if (!find.isNull(1)) detail.integer("slot_id", find.integer(1)).text("slot_state", find.text(2));
}

bool readmit(const Database& database, const Actor& actor, const std::string& code, const std::string& reason) {
    Transaction transaction(database);
    if (!database.prepare("SELECT 1 FROM participant WHERE participant_id=?").bind(code).step())
        throw std::runtime_error("participant " + code + " is not enrolled");
    const Exclusion exclusion = lastExclusion(database, code);
    database.prepare("UPDATE participant SET status=?2, status_reason=?3 WHERE participant_id=?1")
        .bind(code, exclusion.status, "readmitted: " + reason)
        .run();
    database.prepare("UPDATE design_slot SET state=?3, participant_id=?1 WHERE slot_id=?2 AND state='free'")
        .bind(code, exclusion.slot_id, exclusion.slot_state)
        .run();
    const bool placed = exclusion.slot_id == 0 || database.changes() > 0;
    appendAudit(database, actor, "readmit",
                protocol::JsonObject()
                    .text("participant", code)
                    .text("status", exclusion.status)
                    .text("reason", reason)
                    .boolean("placed", placed));
    transaction.commit();
    return placed;
}

}  // namespace passung::store
