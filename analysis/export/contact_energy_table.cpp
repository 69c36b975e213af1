#include "analysis/export/contact_energy_table.h"

#include "analysis/export/shared_columns.h"

namespace passung::exporter {
namespace {

/// A pair of the held part and an obstacle in a scene of an attempt.
struct PairRow {
    const store::AttemptRow* attempt;
    std::int64_t scene;  // of the attempt, from 1
    const session::ContactEnergy* pair;
};

ColumnsOf<PairRow> pairColumns() {
    ColumnsOf<PairRow> columns;
    append(columns, attemptColumns(), attemptOf<PairRow>);
    append(
        columns,
        {{"scene", "Which of the scenes that were rendered one after the other, from 1; most trials have one",
          "integer", &PairRow::scene},
         {"obstacle", "Part that the held part touched; NA: what was sent without contact", "text",
          [](const PairRow& row) { return row.pair->obstacle; }},
         {"taken_in_J",
          "Energy that the controller has taken in through this pair since the trial's first tick; below 0: it gave",
          "number",
          [](const PairRow& row) { return row.pair->taken_in_J; },
          {.unit = "J",
           .formula = "- sum over the ticks of (force . motion + torque . turn of the handle); each contact's share of "
                      "what was sent by its contact forces"}},
         {"least_J",
          "The least that this account was at any tick",
          "number",
          [](const PairRow& row) { return row.pair->least_J; },
          {.unit = "J"}}});
    return columns;
}

}  // namespace

Table makeContactEnergy(const StudyData& study) {
    std::vector<PairRow> rows;
    for (const store::AttemptRow& attempt : study.attempts) {
        std::int64_t scene = 1;
        for (const session::ContactEnergy& pair : attempt.contact_energy) {
            rows.push_back({&attempt, scene, &pair});
            if (pair.obstacle.empty()) ++scene;  // the last row of a scene
        }
    }
    return makeTable(
        "contact_energy.csv",
        "One row per attempt, scene and obstacle, and one per scene for what no obstacle pushed: the energy account of "
        "the pair of the held part and that obstacle when the scene ended. A scene's rows add up to its account, "
        "energy_J of its last tick.",
        pairColumns(), rows);
}

}  // namespace passung::exporter
