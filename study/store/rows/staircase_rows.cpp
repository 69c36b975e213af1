#include "study/store/rows/staircase_rows.h"

#include <optional>
#include <stdexcept>

#include "study/store/schema/sqlite.h"

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

std::vector<StaircaseTrackRow> readStaircaseTracks(const Database& database) {
    std::vector<StaircaseTrackRow> rows;
    Statement row = database.prepare(
        "SELECT protocol_sha256, s.value->>'staircase', t.value->>'track', t.value->>'method', "
        "s.value->>'logarithmic', t.value->>'down_after', t.value->>'start', t.value->>'step_down', "
        "t.value->>'step_up', t.value->>'late_factor', t.value->>'late_after', t.value->>'max_reversals', "
        "t.value->>'skip_reversals', t.value->>'guess', t.value->>'lapse', t.value->>'sigma_low', "
        "t.value->>'sigma_high', t.value->>'max_trials', s.value->>'levels' FROM protocol_version, "
        "json_each(expanded_json, '$.staircases') s, json_each(s.value, '$.tracks') t ORDER BY 1, s.key, t.key");
    Statement level = database.prepare("SELECT value FROM json_each(?) ORDER BY key");
    while (row.step()) {
        design::AdaptiveParams params;
        const std::string levels = row.text(18);  // bound by reference
        level.bind(levels);
        while (level.step()) params.levels.push_back(level.real(0));
        if (params.levels.empty()) continue;
        params.low = params.levels.front();
        params.high = params.levels.back();
        params.logarithmic = row.integer(4) != 0;
        params.max_trials = static_cast<int>(row.integer(17));
        if (row.text(3) == "psi") {
            params.method = design::AdaptiveMethod::Psi;
            params.start = params.low;
            params.guess = row.real(13);
            params.lapse = row.real(14);
            params.sigma_low = row.real(15);
            params.sigma_high = row.real(16);
        } else {
            params.down_after = static_cast<int>(row.integer(5));
            params.start = row.real(6);
            params.step_down = row.real(7);
            params.step_up = row.real(8);
            params.late_factor = row.real(9);
            params.late_after = static_cast<int>(row.integer(10));
            params.max_reversals = static_cast<int>(row.integer(11));
            params.skip_reversals = static_cast<int>(row.integer(12));
        }
        rows.push_back({row.text(0), row.text(1), row.text(2), std::move(params)});
    }
    return rows;
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
