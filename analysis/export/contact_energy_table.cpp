#include "analysis/export/contact_energy_table.h"

#include "study/plan/participant.h"

namespace passung::exporter {

Table makeContactEnergy(const StudyData& study) {
    Table table{
        "contact_energy.csv",
        "One row per attempt, scene and obstacle, and one per scene for what no obstacle pushed: the energy account of "
        "the pair of the held part and that obstacle when the scene ended. A scene's rows add up to its account, "
        "energy_J of its last tick.",
        {{"participant_id", "Code of the participant", "", "text", "", 1, {}},
         {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
         {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
         {"trial_index", "Number of the trial in the session, from 0", "", "integer", "", 1, {}},
         {"attempt_no", "Number of the attempt at this trial, from 1", "", "integer", "", 1, {}},
         {"scene",
          "Which of the scenes that were rendered one after the other, from 1; most trials have one",
          "",
          "integer",
          "",
          1,
          {}},
         {"obstacle", "Part that the held part touched; NA: what was sent without contact", "", "text", "", 1, {}},
         {"taken_in_J",
          "Energy that the controller has taken in through this pair since the trial's first tick; below 0: it gave",
          "J",
          "number",
          "- sum over the ticks of (force . motion + torque . turn of the handle); each contact's share of what was "
          "sent by its contact forces",
          1,
          {}},
         {"least_J", "The least that this account was at any tick", "J", "number", "", 1, {}}},
        {}};
    for (const store::AttemptRow& attempt : study.attempts) {
        std::int64_t scene = 1;
        for (const session::ContactEnergy& pair : attempt.contact_energy) {
            table.rows.push_back({attempt.participant_id, attempt.kind, cell(attempt.session_ordinal),
                                  cell(attempt.trial_index), cell(attempt.attempt_no), cell(scene),
                                  pair.obstacle.empty() ? kMissing : pair.obstacle, cell(pair.taken_in_J),
                                  cell(pair.least_J)});
            if (pair.obstacle.empty()) ++scene;  // the last row of a scene
        }
    }
    return table;
}

}  // namespace passung::exporter
