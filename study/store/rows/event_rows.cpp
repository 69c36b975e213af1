#include "study/store/rows/event_rows.h"

#include "study/store/schema/sqlite.h"

namespace passung::store {

void insertEvent(const Database& database, std::int64_t segment_id, const session::Event& event,
                 const std::optional<std::string>& utc) {
    std::optional<std::int64_t> attempt_id;
    if (event.attempt) attempt_id = static_cast<std::int64_t>(*event.attempt);
    database
        .prepare(
            "INSERT INTO event(segment_id, attempt_id, t_ns, source, event, payload_json, t_utc) "
            "VALUES(?, ?, ?, ?, ?, ?, ?)")
        .bind(segment_id, attempt_id, event.t_ns, event.source, event.event, event.payload_json, utc)
        .run();
}

std::vector<EventRow> readEvents(const Database& database) {
    Statement row =
        database.prepare(std::string("SELECT s.participant_id, p.kind, s.ordinal, e.t_ns, ") + kEventUtc +
                         ", t.trial_index, a.attempt_no, e.source, e.event, e.payload_json FROM event e JOIN segment g "
                         "USING(segment_id) JOIN session s USING(session_id) JOIN participant p USING(participant_id) "
                         "LEFT JOIN attempt a ON a.attempt_id=e.attempt_id LEFT JOIN trial_plan t USING(trial_id) "
                         "ORDER BY s.participant_id, s.ordinal, g.segment_id, e.t_ns, e.event_id");
    std::vector<EventRow> rows;
    while (row.step())
        rows.push_back({row.text(0), row.text(1), row.integer(2), row.integer(3), row.text(4), row.optionalInteger(5),
                        row.optionalInteger(6), row.text(7), row.text(8), row.text(9)});
    return rows;
}

}  // namespace passung::store
