#include "study/store/rows/note_rows.h"

#include "study/store/rows/event_rows.h"

namespace passung::store {

std::vector<NoteRow> readNotes(const Database& database) {
    // A note that was taken down during a session is a row of both tables: here it comes from its own.
    Statement row = database.prepare(
        std::string("SELECT s.participant_id AS participant, p.kind, s.ordinal AS ordinal, n.t_utc AS t, "
                    "coalesce(n.author, ''), "
                    "'note', 1, n.text, NULL, NULL, NULL, 0 AS origin, n.note_id AS number "
                    "FROM note n JOIN session s USING(session_id) JOIN participant p USING(participant_id) "
                    "UNION ALL "
                    "SELECT s.participant_id, p.kind, s.ordinal, ") +
        kEventUtc +
        ", e.source, "
        "substr(e.event, 9), json_extract(e.payload_json, '$.accepted'), json_extract(e.payload_json, '$.text'), "
        "json_extract(e.payload_json, '$.refusal'), t.trial_index, a.attempt_no, 1, e.event_id "
        "FROM event e JOIN segment g USING(segment_id) JOIN session s USING(session_id) "
        "JOIN participant p USING(participant_id) LEFT JOIN attempt a ON a.attempt_id=e.attempt_id "
        "LEFT JOIN trial_plan t USING(trial_id) WHERE e.event GLOB 'command_*' "
        "AND NOT (e.event='command_note' AND json_extract(e.payload_json, '$.accepted')) "
        "ORDER BY participant, ordinal, t, origin, number");
    const auto text = [&](int column) { return row.isNull(column) ? std::nullopt : std::optional(row.text(column)); };
    std::vector<NoteRow> rows;
    while (row.step())
        rows.push_back({row.text(0), row.text(1), row.integer(2), row.text(3), row.text(4), row.text(5),
                        row.integer(6) != 0, text(7), text(8), row.optionalInteger(9), row.optionalInteger(10)});
    return rows;
}

}  // namespace passung::store
