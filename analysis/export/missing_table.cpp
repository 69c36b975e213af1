#include "analysis/export/missing_table.h"

#include "analysis/export/columns.h"

namespace passung::exporter {

using store::DamageRow;

Table makeMissing(const std::vector<DamageRow>& damages) {
    const ColumnsOf<DamageRow> columns = {
        {"participant_id", "Code of the participant; NA: a row of the study", "text", &DamageRow::participant_id},
        {"session", "Number of the participant's session, from 1", "integer", &DamageRow::session_ordinal},
        {"trial_index", "Trial in the session, from 0", "integer", &DamageRow::trial_index},
        {"attempt_no", "Attempt at the trial, from 1", "integer", &DamageRow::attempt_no},
        {"part", "What of it is damaged; samples: ticks of the file in samples/, which goes on after them", "text",
         &DamageRow::part},
        {"why", "What was found", "text", &DamageRow::what}};
    return makeTable(kMissingFile,
                     "**What is damaged in the database and so is not in the other files**, one row each. `passung "
                     "restore` heals it from a copy; then export again.",
                     columns, damages);
}

}  // namespace passung::exporter
