#include "study/store/transfer/merge_places.h"

#include <optional>

#include "study/store/rows/tombstone.h"

namespace passung::store {
namespace {

/// True if it is another place than there.
bool takePlace(const Database& database, const Statement& row) {
    const std::string who = row.text(0), sha256 = row.text(1), kind = row.text(2), group = row.text(3);
    const std::int64_t index = row.integer(4), wanted = row.integer(5);
    const std::string state = row.text(6);
    Statement own = database.prepare("SELECT 1 FROM main.design_slot WHERE participant_id=?");
    if (own.bind(who).step()) {
        database.prepare("UPDATE main.design_slot SET state=?1 WHERE participant_id=?2 AND state<>?1")
            .bind(state, who)
            .run();
        return false;
    }
    const auto place = [&](std::int64_t replicate) {
        Statement take = database.prepare(
            "UPDATE main.design_slot SET state=?, participant_id=?, station=? WHERE protocol_sha256=? AND kind=? "
            "AND between_group=? AND sequence_index=? AND replicate=? AND participant_id IS NULL");
        const auto station = row.isNull(7) ? std::nullopt : std::optional(row.text(7));
        take.bind(state, who, station, sha256, kind, group, index, replicate).run();
        return database.changes() == 1;
    };
    if (place(wanted)) return false;
    for (std::int64_t replicate = 0; !place(replicate); ++replicate)
        database
            .prepare(
                "INSERT OR IGNORE INTO main.design_slot(protocol_sha256, between_group, sequence_index, replicate, "
                "state, kind) SELECT protocol_sha256, between_group, sequence_index, ?5, 'free', kind FROM "
                "main.design_slot WHERE protocol_sha256=?1 AND kind=?2 AND between_group=?3 AND replicate=?4")
            .bind(sha256, kind, group, wanted, replicate + 1)
            .run();
    return true;
}

}  // namespace

std::vector<std::string> mergePlaces(const Database& database) {
    database.execute(
        "INSERT OR IGNORE INTO main.design_slot(protocol_sha256, between_group, sequence_index, replicate, "
        "state, kind) SELECT protocol_sha256, between_group, sequence_index, replicate, 'free', kind "
        "FROM source.design_slot");
    database.execute(
        "UPDATE main.design_slot SET state='free', participant_id=NULL WHERE participant_id IN(SELECT "
        "participant_id FROM main.participant WHERE status='excluded')");
    Statement taken = database.prepare(
        "SELECT s.participant_id, s.protocol_sha256, s.kind, s.between_group, s.sequence_index, s.replicate, "
        "s.state, s.station FROM source.design_slot s JOIN main.participant p USING(participant_id) "
        "WHERE p.status<>'excluded' AND s." +
        kKept + " ORDER BY s.replicate, s.sequence_index, s.participant_id");
    std::vector<std::string> moved;
    while (taken.step())
        if (takePlace(database, taken)) moved.push_back(taken.text(0));
    return moved;
}

}  // namespace passung::store
