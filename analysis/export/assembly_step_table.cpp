#include "analysis/export/assembly_step_table.h"

#include <optional>

#include "analysis/export/shared_columns.h"

namespace passung::exporter {
namespace {

struct StepRow {
    const store::AttemptRow* attempt;
    std::int64_t number;  // from 1
    const session::StepEnd* end;

    const measures::StepResult& result() const { return end->result; }
};

std::optional<double> seconds(const std::optional<std::int64_t>& periods) {
    if (!periods) return std::nullopt;
    return static_cast<double>(*periods) / 1000.0;
}

ColumnsOf<StepRow> whatAndWhen() {
    return {
        {"step", "Number of the step in the protocol, from 1", "integer",
         [](const StepRow& row) { return row.number; }},
        {"step_name", "Name of the step", "string", [](const StepRow& row) { return row.end->name; }},
        {"part", "Part that the step puts where it belongs", "string",
         [](const StepRow& row) { return row.end->part; }},
        {"done", "1: done at the end of the trial", "integer",
         [](const StepRow& row) { return std::int64_t{row.result().done ? 1 : 0}; }},
        {"place", "Place among the steps that were done at the end, from 1 in time; 0: not done", "integer",
         [](const StepRow& row) { return row.result().place; }},
        {"picked_s",
         "When its part was first taken; NA: never",
         "number",
         [](const StepRow& row) { return seconds(row.result().picked); },
         {.unit = "s", .formula = "from the start tick to the first tick with the part in a hand"}},
        {"done_s",
         "When it was done, for the last time; NA: not done at the end",
         "number",
         [](const StepRow& row) { return seconds(row.result().done); },
         {.unit = "s",
          .formula = "from the start tick to the tick that began with the step done: its part had been let go within "
                     "both tolerances of its goal, and the steps before it were done"}}};
}

ColumnsOf<StepRow> counts() {
    return {{"picks", "How often its part was taken into a hand from none", "integer",
             [](const StepRow& row) { return row.result().picks; }},
            {"drops", "How often it was let go elsewhere than at its goal", "integer",
             [](const StepRow& row) { return row.result().drops; }},
            {"order_errors", "How often it was let go at its goal before a step that comes before was done", "integer",
             [](const StepRow& row) { return row.result().order_errors; }},
            {"undos", "How often the step was taken back", "integer",
             [](const StepRow& row) { return row.result().undos; }},
            {"hints",
             "How often a hint came up that leads to it",
             "integer",
             [](const StepRow& row) { return row.result().hints; },
             {.formula = "task.hint_after_s after the trial's start or after a step was done or taken back, where no "
                         "step was in between: rows of events.csv with hint_shown"}},
            {"hands",
             "Hands that held the part",
             "integer",
             [](const StepRow& row) { return std::int64_t{row.result().hands}; },
             {.formula = "sum of 1 for the first hand, 2 for the second, 4 for the third, 8 for the fourth"}}};
}

ColumnsOf<StepRow> movement() {
    return {{"held_s",
             "Time for which a hand held the part",
             "number",
             [](const StepRow& row) { return static_cast<double>(row.result().held_periods) / 1000.0; },
             {.unit = "s"}},
            {"path_m",
             "Path of the part's origin while it was held",
             "number",
             [](const StepRow& row) { return row.result().path; },
             {.unit = "m",
              .formula = "sum of the proxy's steps over the ticks with the part in a hand; with two hands on "
                         "it those of the first"}},
            {"free_path_m",
             "Length of a collision-free path of the part's origin",
             "number",
             [](const StepRow& row) { return row.result().free_path; },
             {.unit = "m", .formula = "task.step.path_mm of the protocol / 1000; NA: it has none"}},
            {"path_ratio",
             "Path over the free path; NA: not done at the end, or no free path",
             "number",
             [](const StepRow& row) { return row.result().pathRatio(); },
             {.unit = "1",
              .formula = "path_m / free_path_m; all that the part went in hands counts, also to where it was dropped "
                         "or taken back; 1: as far as the free path, which need not be the shortest"}},
            {"peak_force_N",
             "Largest force on a hand that held it",
             "number",
             [](const StepRow& row) { return row.result().peak_force; },
             {.unit = "N"}},
            {"position_error_m",
             "Distance of the part from its goal at the end of the trial",
             "number",
             [](const StepRow& row) { return row.result().position_error; },
             {.unit = "m", .formula = "of its origin from the goal where the part that the goal is in then was"}},
            {"angle_error_rad",
             "Angle of the part from its goal at the end of the trial",
             "number",
             [](const StepRow& row) { return row.result().angle_error; },
             {.unit = "rad",
              .formula = "least over the turns about its z axis that make no difference (task.step.symmetry)"}}};
}

}  // namespace

Table makeAssemblySteps(const StudyData& study) {
    ColumnsOf<StepRow> columns;
    append(columns, attemptColumns(), attemptOf<StepRow>);
    for (const auto& more : {whatAndWhen(), counts(), movement()}) append(columns, more);
    return makeAttemptTable<StepRow>(
        study, "assembly_steps.csv",
        "One row per attempt at an assembly and step of it: what became of the step. Times count from the "
        "trial's start.",
        std::move(columns), [](const store::AttemptRow& attempt, const auto& take) {
            std::int64_t number = 0;
            for (const session::StepEnd& step : attempt.steps) take({&attempt, ++number, &step});
        });
}

}  // namespace passung::exporter
