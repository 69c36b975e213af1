#include "study/store/rows/staircase_rows.h"

#include <optional>
#include <stdexcept>

#include "study/store/schema/named_columns.h"

namespace passung::store {

void insertStaircaseStep(const Database& database, const std::string& session_id, std::int64_t attempt_id,
                         const session::StaircaseStep& step) {
    Statement find = database.prepare(
        "SELECT condition_id FROM condition JOIN session USING(protocol_sha256) WHERE session_id=? AND position=?");
    if (!find.bind(session_id, static_cast<std::int64_t>(step.condition)).step())
        throw std::runtime_error("staircase " + step.staircase +
                                 " presents a condition that the protocol does not have");
    const auto track = step.track.empty() ? std::nullopt : std::optional(step.track);
    insertRow(database, "staircase_step", Named{"attempt_id", attempt_id}, Named{"staircase", step.staircase},
              Named{"track", track}, Named{"wanted_level", step.wanted}, Named{"level", step.level},
              Named{"condition_id", find.integer(0)});
}

void storeStaircaseAnswer(const Database& database, std::int64_t attempt_id, const session::StaircaseAnswer& answer) {
    const auto positive = answer.positive ? std::optional<std::int64_t>(*answer.positive ? 1 : 0) : std::nullopt;
    database.prepare("UPDATE staircase_step SET positive=?, reversal=?, estimate=?, estimate_sd=? WHERE attempt_id=?")
        .bind(positive, answer.reversal, answer.estimate, answer.deviation, attempt_id)
        .run();
}

namespace {

/// A track as the plan's JSON has it; of its method's parameters those that are there.
struct StoredTrack {
    std::string protocol_sha256, staircase, track, method;
    std::vector<double> levels;
    bool logarithmic = false;
    std::int64_t max_trials = 0;
    std::int64_t down_after = 0, late_after = 0, max_reversals = 0, skip_reversals = 0;
    double start = 0.0, step_down = 0.0, step_up = 0.0, late_factor = 0.0;
    std::optional<double> reference;
    double guess = 0.0, lapse = 0.0, sigma_low = 0.0, sigma_high = 0.0;
};

std::vector<double> readNumbers(const Database& database, const std::string& json) {
    Statement number = database.prepare("SELECT value FROM json_each(?) ORDER BY key");
    number.bind(json);
    std::vector<double> numbers;
    while (number.step()) numbers.push_back(number.real(0));
    return numbers;
}

std::vector<StoredTrack> readStoredTracks(const Database& database) {
    using Row = StoredTrack;
    const Selection<Row> columns = {
        {"protocol_sha256", &Row::protocol_sha256},
        {"s.value->>'staircase'", &Row::staircase},
        {"t.value->>'track'", &Row::track},
        {"t.value->>'method'", &Row::method},
        {"s.value->>'levels'", [&database](const Statement& row, int column,
                                           Row& to) { to.levels = readNumbers(database, row.text(column)); }},
        {"s.value->>'logarithmic'", &Row::logarithmic},
        {"t.value->>'max_trials'", &Row::max_trials},
        {"t.value->>'down_after'", &Row::down_after},
        {"t.value->>'late_after'", &Row::late_after},
        {"t.value->>'max_reversals'", &Row::max_reversals},
        {"t.value->>'skip_reversals'", &Row::skip_reversals},
        {"t.value->>'start'", &Row::start},
        {"t.value->>'step_down'", &Row::step_down},
        {"t.value->>'step_up'", &Row::step_up},
        {"t.value->>'late_factor'", &Row::late_factor},
        {"t.value->>'guess'", &Row::guess},
        {"t.value->>'lapse'", &Row::lapse},
        {"t.value->>'sigma_low'", &Row::sigma_low},
        {"t.value->>'sigma_high'", &Row::sigma_high},
        {"s.value->>'reference'", &Row::reference}};
    return columns.all(database,
                       "FROM protocol_version, json_each(expanded_json, '$.staircases') s, "
                       "json_each(s.value, '$.tracks') t ORDER BY 1, s.key, t.key");
}

/// @pre the track has levels
design::AdaptiveParams paramsOf(const StoredTrack& track) {
    design::AdaptiveParams params;
    params.levels = track.levels;
    params.low = params.levels.front();
    params.high = params.levels.back();
    params.logarithmic = track.logarithmic;
    params.max_trials = static_cast<int>(track.max_trials);
    if (track.method == "psi") {
        params.method = design::AdaptiveMethod::Psi;
        params.start = params.low;
        params.guess = track.guess;
        params.lapse = track.lapse;
        params.sigma_low = track.sigma_low;
        params.sigma_high = track.sigma_high;
    } else {
        params.down_after = static_cast<int>(track.down_after);
        params.start = track.start;
        params.step_down = track.step_down;
        params.step_up = track.step_up;
        params.late_factor = track.late_factor;
        params.late_after = static_cast<int>(track.late_after);
        params.max_reversals = static_cast<int>(track.max_reversals);
        params.skip_reversals = static_cast<int>(track.skip_reversals);
    }
    return params;
}

}  // namespace

std::vector<StaircaseTrackRow> readStaircaseTracks(const Database& database) {
    std::vector<StaircaseTrackRow> rows;
    for (const StoredTrack& track : readStoredTracks(database))
        if (!track.levels.empty())
            rows.push_back({track.protocol_sha256, track.staircase, track.track, paramsOf(track), track.reference});
    return rows;
}

std::vector<StaircaseStepRow> readStaircaseSteps(const Database& database) {
    using Row = StaircaseStepRow;
    const Selection<Row> columns = {
        {"attempt_id", &Row::attempt_id},     {"staircase", &Row::staircase}, {"track", &Row::track},
        {"wanted_level", &Row::wanted_level}, {"level", &Row::level},         {"positive", &Row::positive},
        {"reversal", &Row::reversal},         {"estimate", &Row::estimate},   {"estimate_sd", &Row::estimate_sd}};
    return columns.all(database, "FROM staircase_step ORDER BY attempt_id");
}

}  // namespace passung::store
