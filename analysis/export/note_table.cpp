#include "analysis/export/note_table.h"

#include "analysis/export/shared_columns.h"

namespace passung::exporter {

using store::NoteRow;

Table makeNotes(const StudyData& study) {
    ColumnsOf<NoteRow> columns = participantSessionColumns<NoteRow>();
    append(columns, {{"t_utc", "When, by the session's epoch (see sessions.csv)", "time", &NoteRow::t_utc},
                     {"author", "Who said it", "text", &NoteRow::author, {.typed = true}},
                     {"entry", "note, or which command", "text", &NoteRow::entry},
                     {"accepted", "0: the command was refused", "0/1", &NoteRow::accepted, {.levels = {"0", "1"}}},
                     {"text", "The note, or the reason that was given", "text", &NoteRow::text, {.typed = true}},
                     {"refusal", "Why it was refused", "text", &NoteRow::refusal},
                     {"trial_index", "Trial that ran then, or whose attempt was invalidated later", "integer",
                      &NoteRow::trial_index},
                     {"attempt_no", "Its attempt", "integer", &NoteRow::attempt_no}});
    return makeTable("notes.csv",
                     "One row per note and per command of an experimenter to a session, in the order of time.", columns,
                     study.notes);
}

}  // namespace passung::exporter
