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

/// `hands`: several of them held parts.
ColumnsOf<PairRow> pairColumns(bool hands) {
    ColumnsOf<PairRow> columns;
    append(columns, attemptColumns(), attemptOf<PairRow>);
    if (hands)
        append(columns, {{"hand", "Hand that held the part; NA: the first", "text",
                          [](const PairRow& row) { return row.pair->hand; }}});
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
    bool hands = false;
    for (const store::AttemptRow& attempt : study.attempts) {
        std::int64_t scene = 1;
        const auto& pairs = attempt.contact_energy;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            rows.push_back({&attempt, scene, &pairs[i]});
            hands = hands || !pairs[i].hand.empty();
            // The last row of a hand; the next scene begins with the first one.
            if (pairs[i].obstacle.empty() && (i + 1 == pairs.size() || pairs[i + 1].hand.empty())) ++scene;
        }
    }
    return makeTable(
        "contact_energy.csv",
        "One row per attempt, scene and obstacle, and one per scene for what no obstacle pushed: the energy account of "
        "the pair of the held part and that obstacle when the scene ended. A scene's rows add up to its account, "
        "energy_J of its last tick.",
        pairColumns(hands), rows);
}

}  // namespace passung::exporter
