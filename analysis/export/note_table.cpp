#include "analysis/export/note_table.h"

#include "study/plan/participant.h"

namespace passung::exporter {

Table makeNotes(const StudyData& study) {
    Table table{
        "notes.csv",
        "One row per note and per command of an experimenter to a session, in the order of time.",
        {{"participant_id", "Code of the participant", "", "text", "", 1, {}},
         {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
         {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
         {"t_utc", "When, by the session's epoch (see sessions.csv)", "", "time", "", 1, {}},
         {"author", "Who said it", "", "text", "", 1, {}},
         {"entry", "note, or which command", "", "text", "", 1, {}},
         {"accepted", "0: the command was refused", "", "0/1", "", 1, {"0", "1"}},
         {"text", "The note, or the reason that was given", "", "text", "", 1, {}},
         {"refusal", "Why it was refused", "", "text", "", 1, {}},
         {"trial_index", "Trial that ran then, or whose attempt was invalidated later", "", "integer", "", 1, {}},
         {"attempt_no", "Its attempt", "", "integer", "", 1, {}}},
        {}};
    for (const store::NoteRow& note : study.notes)
        table.rows.push_back({note.participant_id, note.kind, cell(note.session_ordinal), note.t_utc, note.author,
                              note.entry, cell(note.accepted), cell(note.text), cell(note.refusal),
                              cell(note.trial_index), cell(note.attempt_no)});
    return table;
}

}  // namespace passung::exporter
