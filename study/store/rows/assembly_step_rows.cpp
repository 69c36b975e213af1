#include "study/store/rows/assembly_step_rows.h"

#include "study/store/schema/named_columns.h"

namespace passung::store {

void insertAssemblySteps(const Database& database, std::int64_t attempt_id,
                         const std::vector<session::StepEnd>& steps) {
    std::optional<Statement> insert;
    std::int64_t number = 0;
    for (const session::StepEnd& step : steps) {
        const measures::StepResult& result = step.result;
        insertRow(insert, database, "assembly_step", Named{"attempt_id", attempt_id}, Named{"step", number++},
                  Named{"name", step.name}, Named{"part", step.part}, Named{"picked_ms", result.picked},
                  Named{"done_ms", result.done}, Named{"place", result.place}, Named{"picks", result.picks},
                  Named{"drops", result.drops}, Named{"order_errors", result.order_errors},
                  Named{"undos", result.undos}, Named{"hands", std::int64_t{result.hands}},
                  Named{"held_ms", result.held_periods}, Named{"path_m", result.path},
                  Named{"peak_force_N", result.peak_force}, Named{"position_error_m", result.position_error},
                  Named{"angle_error_rad", result.angle_error}, Named{"free_path_m", result.free_path},
                  Named{"hints", result.hints});
    }
}

std::vector<session::StepEnd> readAssemblySteps(const Database& database, std::int64_t attempt_id) {
    std::vector<session::StepEnd> steps;
    Statement row = database.prepare(
        "SELECT name, part, picked_ms, done_ms, place, picks, drops, order_errors, undos, hands, held_ms, path_m, "
        "peak_force_N, position_error_m, angle_error_rad, free_path_m, hints FROM assembly_step WHERE attempt_id=? "
        "ORDER BY step");
    row.bind(attempt_id);
    while (row.step())
        steps.push_back({row.text(0),
                         row.text(1),
                         {.picked = row.optionalInteger(2),
                          .done = row.optionalInteger(3),
                          .place = row.integer(4),
                          .picks = row.integer(5),
                          .drops = row.integer(6),
                          .order_errors = row.integer(7),
                          .undos = row.integer(8),
                          .hints = row.integer(16),
                          .hands = static_cast<std::uint32_t>(row.integer(9)),
                          .held_periods = row.integer(10),
                          .path = row.real(11),
                          .peak_force = row.real(12),
                          .position_error = row.real(13),
                          .angle_error = row.real(14),
                          .free_path = row.optionalReal(15)}});
    return steps;
}

}  // namespace passung::store
