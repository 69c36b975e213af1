#include "study/store/rows/exact_overlap_rows.h"

#include "study/store/schema/named_columns.h"

namespace passung::store {

void insertExactOverlaps(const Database& database, std::int64_t attempt_id,
                         const std::vector<measures::TickOverlap>& overlaps) {
    std::optional<Statement> insert;
    for (const measures::TickOverlap& tick : overlaps)
        insertRow(insert, database, "exact_overlap", Named{"attempt_id", attempt_id}, Named{"tick", tick.tick},
                  Named{"every_20th", tick.every_20th}, Named{"largest_depth", tick.largest_depth},
                  Named{"largest_force", tick.largest_force}, Named{"overlap_m", tick.depth},
                  Named{"bound_m", tick.bound});
}

std::vector<measures::TickOverlap> readExactOverlaps(const Database& database, std::int64_t attempt_id) {
    std::vector<measures::TickOverlap> overlaps;
    Statement row = database.prepare(
        "SELECT tick, every_20th, largest_depth, largest_force, overlap_m, bound_m FROM exact_overlap WHERE "
        "attempt_id=? ORDER BY tick");
    row.bind(attempt_id);
    while (row.step())
        overlaps.push_back(
            {row.integer(0), row.integer(1) != 0, row.integer(2) != 0, row.integer(3) != 0, row.real(4), row.real(5)});
    return overlaps;
}

}  // namespace passung::store
