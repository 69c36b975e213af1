#include "study/store/people/readmit.h"

#include <optional>
#include <stdexcept>

namespace passung::store {
namespace {

/// A slot by what it is, which is the same in every file.
struct FormerPlace {
    std::string protocol_sha256, group, state;
    std::int64_t sequence = 0, replicate = 0;
};

struct Exclusion {
    std::string status = "enrolled";  // before; of audits that do not say it
    std::optional<FormerPlace> place;
};

/// The newest thing that was done to the participant's standing, here or in a file that was merged, which has to be an
/// exclusion.
Exclusion lastExclusion(const Database& database, const std::string& code) {
    Statement find = database.prepare(
        "SELECT action, json_extract(detail_json, '$.status_before'), json_extract(detail_json, '$.place') IS NOT "
        "NULL, json_extract(detail_json, '$.place.protocol_sha256'), json_extract(detail_json, '$.place.group'), "
        "json_extract(detail_json, '$.place.state'), json_extract(detail_json, '$.place.sequence'), "
        "json_extract(detail_json, '$.place.replicate') "
        "FROM audit WHERE json_extract(detail_json, '$.participant')=? "
        "AND action IN('exclude', 'withdraw', 'readmit') ORDER BY t_utc DESC, audit_id DESC LIMIT 1");
    if (!find.bind(code).step() || find.text(0) == "readmit")
        throw std::runtime_error("participant " + code + " is not excluded");
    if (find.text(0) == "withdraw")
        throw std::runtime_error("participant " + code + " has withdrawn: only they could take that back");
    Exclusion exclusion;
    if (!find.isNull(1)) exclusion.status = find.text(1);
    if (find.integer(2) != 0)
        exclusion.place = {find.text(3), find.text(4), find.text(5), find.integer(6), find.integer(7)};
    return exclusion;
}

/// False if somebody else has it.
bool takePlaceBack(const Database& database, const std::string& code, const FormerPlace& place) {
    database
        .prepare(
            "UPDATE design_slot SET state=?2, participant_id=?1 WHERE protocol_sha256=?3 AND between_group=?4 AND "
            "sequence_index=?5 AND replicate=?6 AND kind=(SELECT kind FROM participant WHERE participant_id=?1) AND "
            "state='free'")
        .bind(code, place.state, place.protocol_sha256, place.group, place.sequence, place.replicate)
        .run();
    return database.changes() > 0;
}

}  // namespace

void describeStanding(const Database& database, const std::string& code, JsonObject& detail) {
    Statement find = database.prepare(
        "SELECT status, protocol_sha256, between_group, sequence_index, replicate, state FROM participant "
        "LEFT JOIN design_slot USING(participant_id) WHERE participant_id=?");
    if (!find.bind(code).step()) return;
    detail.text("status_before", find.text(0));
    if (find.isNull(1)) return;
    detail.json("place", JsonObject()
                             .text("protocol_sha256", find.text(1))
                             .text("group", find.text(2))
                             .integer("sequence", find.integer(3))
                             .integer("replicate", find.integer(4))
                             .text("state", find.text(5))
                             .str());
}

bool readmit(const Database& database, const Actor& actor, const std::string& code, const std::string& reason) {
    Transaction transaction(database);
    if (!database.prepare("SELECT 1 FROM participant WHERE participant_id=?").bind(code).step())
        throw std::runtime_error("participant " + code + " is not enrolled");
    const Exclusion exclusion = lastExclusion(database, code);
    database.prepare("UPDATE participant SET status=?2, status_reason=?3 WHERE participant_id=?1")
        .bind(code, exclusion.status, "readmitted: " + reason)
        .run();
    const bool placed = !exclusion.place || takePlaceBack(database, code, *exclusion.place);
    appendAudit(database, actor, "readmit",
                JsonObject()
                    .text("participant", code)
                    .text("status", exclusion.status)
                    .text("reason", reason)
                    .boolean("placed", placed));
    transaction.commit();
    return placed;
}

}  // namespace passung::store
