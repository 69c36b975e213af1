#include "study/store/staircase_rows.h"

#include <optional>
#include <stdexcept>

#include "study/store/sqlite.h"

namespace passung::store {

void insertStaircaseStep(const Database& database, const std::string& session_id, std::int64_t attempt_id,
                         const session::StaircaseStep& step) {
    Statement find = database.prepare(
        "SELECT condition_id FROM condition JOIN session USING(protocol_sha256) WHERE session_id=? AND position=?");
    if (!find.bind(session_id, static_cast<std::int64_t>(step.condition)).step())
        throw std::runtime_error("staircase " + step.staircase +
                                 " presents a condition that the protocol does not have");
    const auto track = step.track.empty() ? std::nullopt : std::optional(step.track);
    database
        .prepare(
            "INSERT INTO staircase_step(attempt_id, staircase, track, wanted_level, level, condition_id) "
            "VALUES(?, ?, ?, ?, ?, ?)")
        .bind(attempt_id, step.staircase, track, step.wanted, step.level, find.integer(0))
        .run();
}

void storeStaircaseAnswer(const Database& database, std::int64_t attempt_id, const session::StaircaseAnswer& answer) {
    const auto positive = answer.positive ? std::optional<std::int64_t>(*answer.positive ? 1 : 0) : std::nullopt;
    database.prepare("UPDATE staircase_step SET positive=?, reversal=?, estimate=?, estimate_sd=? WHERE attempt_id=?")
        .bind(positive, answer.reversal, answer.estimate, answer.deviation, attempt_id)
        .run();
}

std::vector<StaircaseStepRow> readStaircaseSteps(const Database& database) {
    Statement row = database.prepare(
        "SELECT attempt_id, staircase, track, wanted_level, level, positive, reversal, estimate, estimate_sd "
        "FROM staircase_step ORDER BY attempt_id");
    std::vector<StaircaseStepRow> rows;
    while (row.step()) {
        StaircaseStepRow step{row.integer(0),      row.text(1),         {},
                              row.real(3),         row.real(4),         {},
                              row.integer(6) != 0, row.optionalReal(7), row.optionalReal(8)};
        if (!row.isNull(2)) step.track = row.text(2);
        if (!row.isNull(5)) step.positive = row.integer(5) != 0;
        rows.push_back(std::move(step));
    }
    return rows;
}

}  // namespace passung::store
