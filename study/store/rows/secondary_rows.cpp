#include "study/store/rows/secondary_rows.h"

#include "study/store/schema/named_columns.h"

namespace passung::store {

void insertDetections(const Database& database, std::int64_t attempt_id, std::int64_t start_ns,
                      const std::vector<measures::Detection>& detections) {
    const auto ns = [&](const std::optional<std::int64_t>& periods) {
        return periods ? std::optional(start_ns + *periods * kTickNanoseconds) : std::nullopt;
    };
    std::int64_t number = 0;
    for (const measures::Detection& d : detections)
        insertRow(database, "secondary_response", Named{"attempt_id", attempt_id}, Named{"number", ++number},
                  Named{"stimulus_ns", ns(d.stimulus)}, Named{"off_ns", ns(d.off)},
                  Named{"response_ns", ns(d.response)}, Named{"result", measures::detectionResultName(d.result)});
}

std::vector<DetectionRow> readDetections(const Database& database) {
    std::vector<DetectionRow> rows;
    Statement row = database.prepare(
        "SELECT r.attempt_id, r.number, r.stimulus_ns - a.start_ns, r.off_ns - a.start_ns, r.response_ns - a.start_ns, "
        "r.result FROM secondary_response r JOIN attempt a USING(attempt_id) JOIN trial_plan t USING(trial_id) "
        "JOIN session s USING(session_id) ORDER BY s.participant_id, s.ordinal, t.trial_index, a.attempt_no, r.number");
    const auto periods = [&row](int column) {
        const auto ns = row.optionalInteger(column);
        return ns ? std::optional(*ns / kTickNanoseconds) : std::nullopt;
    };
    while (row.step()) {
        const auto result = measures::detectionResultNamed(row.text(5));
        if (!result) throw std::runtime_error("secondary_response holds the unknown result " + row.text(5));
        rows.push_back({row.integer(0), row.integer(1), {*result, periods(2), periods(3), periods(4)}});
    }
    return rows;
}

}  // namespace passung::store
