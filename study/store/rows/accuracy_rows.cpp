#include "study/store/rows/accuracy_rows.h"

#include "study/store/schema/named_columns.h"
#include "study/store/schema/row_hash.h"

namespace passung::store {

std::vector<AccuracyRow> readAccuracy(const Database& database) {
    if (database.integer("SELECT count(*) FROM sqlite_master WHERE name='accuracy_candidate'") == 0) return {};
    const Selection<AccuracyRow> columns = {{"protocol_sha256", &AccuracyRow::protocol_sha256},
                                            {"candidate", &AccuracyRow::candidate},
                                            {"mode", &AccuracyRow::mode},
                                            {"tolerance_um", &AccuracyRow::tolerance_um},
                                            {"spacing_mm", &AccuracyRow::spacing_mm},
                                            {"budget_nodes", &AccuracyRow::budget_nodes},
                                            {"points", &AccuracyRow::points},
                                            {"time_median_us", &AccuracyRow::time_median_us},
                                            {"time_p99_us", &AccuracyRow::time_p99_us},
                                            {"time_max_us", &AccuracyRow::time_max_us},
                                            {"error_mean_um", &AccuracyRow::error_mean_um},
                                            {"error_p99_um", &AccuracyRow::error_p99_um},
                                            {"error_max_um", &AccuracyRow::error_max_um},
                                            {"force_error_p99_percent", &AccuracyRow::force_error_p99_percent},
                                            {"direction_error_p99_deg", &AccuracyRow::direction_error_p99_deg},
                                            {"torque_error_p99_percent", &AccuracyRow::torque_error_p99_percent}};
    std::vector<AccuracyRow> rows =
        columns.all(database, "FROM accuracy_candidate ORDER BY protocol_sha256, candidate");
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
        insertRow(database, "accuracy_candidate", Named{"protocol_sha256", row.protocol_sha256},
                  Named{"candidate", row.candidate}, Named{"mode", row.mode}, Named{"tolerance_um", row.tolerance_um},
                  Named{"spacing_mm", row.spacing_mm}, Named{"budget_nodes", row.budget_nodes},
                  Named{"points", row.points}, Named{"time_median_us", row.time_median_us},
                  Named{"time_p99_us", row.time_p99_us}, Named{"time_max_us", row.time_max_us},
                  Named{"error_mean_um", row.error_mean_um}, Named{"error_p99_um", row.error_p99_um},
                  Named{"error_max_um", row.error_max_um},
                  Named{"force_error_p99_percent", row.force_error_p99_percent},
                  Named{"direction_error_p99_deg", row.direction_error_p99_deg},
                  Named{"torque_error_p99_percent", row.torque_error_p99_percent});
        for (const double budget : row.picked_for_us)
            insertRow(database, "accuracy_pick", Named{"protocol_sha256", row.protocol_sha256},
                      Named{"budget_us", budget}, Named{"candidate", row.candidate});
    }
    sealNewRows(database);
    transaction.commit();
}

}  // namespace passung::store
