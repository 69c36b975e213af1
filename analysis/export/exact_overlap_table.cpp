#include "analysis/export/exact_overlap_table.h"

#include "analysis/export/shared_columns.h"

namespace passung::exporter {
namespace {

struct OverlapRow {
    const store::AttemptRow* attempt;
    const measures::TickOverlap* tick;
};

ColumnsOf<OverlapRow> overlapColumns() {
    const auto flag = [](bool measures::TickOverlap::*mark) {
        return [mark](const OverlapRow& row) { return std::int64_t{row.tick->*mark ? 1 : 0}; };
    };
    ColumnsOf<OverlapRow> columns;
    append(columns, attemptColumns(), attemptOf<OverlapRow>);
    append(
        columns,
        {{"tick", "Number of the tick in the attempt, as in samples", "integer",
          [](const OverlapRow& row) { return row.tick->tick; }},
         {"every_20th", "1: judged as one of every 20th contact tick", "integer",
          flag(&measures::TickOverlap::every_20th)},
         {"largest_depth", "1: judged as one of the 20 trial ticks of largest proxy_depth_m", "integer",
          flag(&measures::TickOverlap::largest_depth)},
         {"largest_force", "1: judged as one of the 20 trial ticks of largest force", "integer",
          flag(&measures::TickOverlap::largest_force)},
         {"overlap_m",
          "True overlap of what was shown: depth of the deepest point of either part's surface in the other that was "
          "found",
          "number",
          [](const OverlapRow& row) { return row.tick->depth; },
          {.unit = "m",
           .formula =
               "largest distance from the other part's surface of a point of one part's surface inside the other, "
               "at the recorded pose proxy_*; by closed forms and triangles, not by what contact is computed from"}},
         {"bound_m",
          "No point is deeper; more than 2 um and 3 % above overlap_m where the search ended early",
          "number",
          [](const OverlapRow& row) { return row.tick->bound; },
          {.unit = "m"}}});
    return columns;
}

}  // namespace

Table makeExactOverlap(const StudyData& study, const store::StoreReader& reader) {
    return makeLongTable<OverlapRow>(
        "exact_overlap.csv",
        "One row per attempt and tick that was judged after the trial: how deep the held part, as it was "
        "shown, and the obstacles truly reached into each other. The record's proxy_depth_m of the same tick "
        "is that of sample points.",
        overlapColumns(), [&study, &reader](const auto& take) -> Result<Done> {
            for (const store::AttemptRow& attempt : study.attempts) {
                const auto overlaps = reader.overlaps(attempt.attempt_id);
                if (!overlaps) return overlaps.errors();
                for (const measures::TickOverlap& tick : *overlaps) take({&attempt, &tick});
            }
            return Done{};
        });
}

}  // namespace passung::exporter
