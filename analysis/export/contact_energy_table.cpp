#include "analysis/export/contact_energy_table.h"

#include <algorithm>

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

/// Calls `take` with the pairs of an attempt, scene by scene.
void eachPair(const store::AttemptRow& attempt, const std::function<void(const PairRow&)>& take) {
    std::int64_t scene = 1;
    const auto& pairs = attempt.contact_energy;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        take({&attempt, scene, &pairs[i]});
        // The last row of a hand; the next scene begins with the first one.
        if (pairs[i].obstacle.empty() && (i + 1 == pairs.size() || pairs[i + 1].hand.empty())) ++scene;
    }
}

}  // namespace

Table makeContactEnergy(const StudyData& study) {
    const bool hands = std::any_of(study.attempts.begin(), study.attempts.end(), [](const auto& attempt) {
        return std::any_of(attempt.contact_energy.begin(), attempt.contact_energy.end(),
                           [](const session::ContactEnergy& pair) { return !pair.hand.empty(); });
    });
    return makeAttemptTable<PairRow>(
        study, "contact_energy.csv",
        "One row per attempt, scene and obstacle, and one per scene for what no obstacle pushed: the energy account of "
        "the pair of the held part and that obstacle when the scene ended. A scene's rows add up to its account, "
        "energy_J of its last tick.",
        pairColumns(hands), eachPair);
}

}  // namespace passung::exporter
