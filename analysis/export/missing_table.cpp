#include "analysis/export/missing_table.h"

namespace passung::exporter {

Table makeMissing(const std::vector<store::DamageRow>& damages) {
    Table table{kMissingFile,
                "**What is damaged in the database and so is not in the other files**, one row each. `passung restore` "
                "heals it from a copy; then export again.",
                {{"participant_id", "Code of the participant; NA: a row of the study", "", "text", "", 1, {}},
                 {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
                 {"trial_index", "Trial in the session, from 0", "", "integer", "", 1, {}},
                 {"attempt_no", "Attempt at the trial, from 1", "", "integer", "", 1, {}},
                 {"part",
                  "What of it is damaged; samples: ticks of the file in samples/, which goes on after them",
                  "",
                  "text",
                  "",
                  1,
                  {}},
                 {"why", "What was found", "", "text", "", 1, {}}},
                {}};
    for (const store::DamageRow& damage : damages)
        table.rows.push_back({damage.participant_id.empty() ? kMissing : damage.participant_id,
                              cell(damage.session_ordinal), cell(damage.trial_index), cell(damage.attempt_no),
                              damage.part, damage.what});
    return table;
}

}  // namespace passung::exporter
