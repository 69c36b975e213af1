#include "study/store/rows/note_rows.h"

#include <array>

#include "study/store/rows/event_rows.h"
#include "study/store/schema/named_columns.h"
#include "study/store/schema/view_columns.h"

namespace passung::store {
namespace {

/// A column of the list, and what stands there: of a note, of a command's event.
struct NoteColumn {
    const char *name, *of_note, *of_command;
};

constexpr std::array kNoteColumns = {
    NoteColumn{"participant_id", "s.participant_id", "s.participant_id"},
    NoteColumn{"kind", "p.kind", "p.kind"},
    NoteColumn{"ordinal", "s.ordinal", "s.ordinal"},
    NoteColumn{"t_utc", "n.t_utc", kEventUtc},
    NoteColumn{"author", "coalesce(n.author, '')", "e.source"},
    NoteColumn{"entry", "'note'", "substr(e.event, 9)"},
    NoteColumn{"accepted", "1", "json_extract(e.payload_json, '$.accepted')"},
    NoteColumn{"text", "n.text", "json_extract(e.payload_json, '$.text')"},
    NoteColumn{"refusal", "NULL", "json_extract(e.payload_json, '$.refusal')"},
    NoteColumn{"trial_index", "NULL", "t.trial_index"},
    NoteColumn{"attempt_no", "NULL", "a.attempt_no"},
    NoteColumn{"origin", "0", "1"},
    NoteColumn{"number", "n.note_id", "e.event_id"},
};

/// "SELECT s.participant_id AS participant_id, …"
std::string selectText(const char* NoteColumn::*what) {
    std::string text;
    for (const NoteColumn& column : kNoteColumns)
        text += (text.empty() ? "SELECT " : ", ") + std::string(column.*what) + " AS " + column.name;
    return text;
}

}  // namespace

std::vector<NoteRow> readNotes(const Database& database) {
    const Selection<NoteRow> columns = {{"participant_id", &NoteRow::participant_id},
                                        {"kind", &NoteRow::kind},
                                        {"ordinal", &NoteRow::session_ordinal},
                                        {"t_utc", &NoteRow::t_utc},
                                        {"author", &NoteRow::author},
                                        {"entry", &NoteRow::entry},
                                        {"accepted", &NoteRow::accepted},
                                        {"text", &NoteRow::text},
                                        {"refusal", &NoteRow::refusal},
                                        {"trial_index", &NoteRow::trial_index},
                                        {"attempt_no", &NoteRow::attempt_no}};
    // A note that was taken down during a session is a row of both tables: here it comes from its own.
    return columns.all(database,
                       "FROM (" + selectText(&NoteColumn::of_note) +
                           " FROM note n JOIN session s USING(session_id) JOIN participant p USING(participant_id) "
                           "UNION ALL " +
                           selectText(&NoteColumn::of_command) +
                           " FROM event e JOIN segment g USING(segment_id) JOIN session s USING(session_id) "
                           "JOIN participant p USING(participant_id) LEFT JOIN attempt a ON a.attempt_id=e.attempt_id "
                           "LEFT JOIN trial_plan t USING(trial_id) WHERE e.event GLOB 'command_*' "
                           "AND NOT (e.event='command_note' AND json_extract(e.payload_json, '$.accepted'))) "
                           "ORDER BY participant_id, ordinal, t_utc, origin, number");
}

}  // namespace passung::store
