#include "study/store/rows/accuracy_rows.h"

#include "study/store/schema/row_hash.h"

namespace passung::store {

std::vector<AccuracyRow> readAccuracy(const Database& database) {
    std::vector<AccuracyRow> rows;
    if (database.integer("SELECT count(*) FROM sqlite_master WHERE name='accuracy_candidate'") == 0) return rows;
    Statement row = database.prepare(
        "SELECT protocol_sha256, candidate, mode, tolerance_um, spacing_mm, budget_nodes, points, time_median_us, "
        "time_p99_us, time_max_us, error_mean_um, error_p99_um, error_max_um, force_error_p99_percent, "
        "direction_error_p99_deg, torque_error_p99_percent "
        "FROM accuracy_candidate ORDER BY protocol_sha256, candidate");
    while (row.step())
        rows.push_back({row.text(0), row.integer(1), row.text(2), row.real(3), row.real(4), row.integer(5),
                        row.integer(6), row.real(7), row.real(8), row.real(9), row.real(10), row.real(11), row.real(12),
                        row.optionalReal(13), row.optionalReal(14), row.optionalReal(15)});
    Statement pick =
        database.prepare("SELECT protocol_sha256, candidate, budget_us FROM accuracy_pick ORDER BY budget_us");
    while (pick.step())
        for (AccuracyRow& candidate : rows)
            if (candidate.protocol_sha256 == pick.text(0) && candidate.candidate == pick.integer(1))
                candidate.picked_for_us.push_back(pick.real(2));
    return rows;
}

void insertAccuracy(const Database& database, const std::vector<AccuracyRow>& rows) {
    Transaction transaction(database);
    for (const AccuracyRow& row : rows) {
        database.prepare("INSERT INTO accuracy_candidate VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
            .bind(row.protocol_sha256, row.candidate, row.mode, row.tolerance_um, row.spacing_mm, row.budget_nodes,
                  row.points, row.time_median_us, row.time_p99_us, row.time_max_us, row.error_mean_um, row.error_p99_um,
                  row.error_max_um, row.force_error_p99_percent, row.direction_error_p99_deg,
                  row.torque_error_p99_percent)
            .run();
        for (const double budget : row.picked_for_us)
            database.prepare("INSERT INTO accuracy_pick VALUES(?, ?, ?)")
                .bind(row.protocol_sha256, budget, row.candidate)
                .run();
    }
    sealNewRows(database);
    transaction.commit();
}

}  // namespace passung::store
