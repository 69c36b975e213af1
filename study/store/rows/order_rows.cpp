#include "study/store/rows/order_rows.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <stdexcept>

namespace passung::store {
namespace {

// As stored, in the order of the enumerators.
constexpr std::array<const char*, 3> kThenNames = {"done", "repeat_now", "repeat_at_block_end"};
constexpr std::array<const char*, 3> kDeciderNames = {"protocol", "experimenter", "interruption"};

template <class Value, std::size_t count>
Value named(const std::array<const char*, count>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw std::runtime_error("order_step: " + name + " is not known");
    return static_cast<Value>(std::distance(names.begin(), found));
}

}  // namespace

void insertOrderSteps(const Database& database, const std::string& session_id, std::int64_t segment_id,
                      std::span<const session::OrderStep> steps) {
    Statement insert = database.prepare(
        "INSERT INTO order_step(segment_id, trial_id, attempt_id, then_what, decided_by) VALUES(?2, (SELECT trial_id "
        "FROM trial_plan WHERE session_id=?1 AND trial_index=?3), ?4, ?5, ?6)");
    for (const session::OrderStep& step : steps) {
        std::optional<std::int64_t> attempt;
        if (step.attempt) attempt = static_cast<std::int64_t>(*step.attempt);
        insert
            .bind(session_id, segment_id, step.trial_index, attempt, kThenNames.at(static_cast<std::size_t>(step.then)),
                  kDeciderNames.at(static_cast<std::size_t>(step.decided_by)))
            .run();
    }
}

std::vector<session::OrderStep> readOrderSteps(const Database& database, const std::string& session_id) {
    Statement row = database.prepare(
        "SELECT trial_index, then_what, decided_by, attempt_id FROM order_step JOIN trial_plan USING(trial_id) "
        "WHERE session_id=? ORDER BY step_id");
    row.bind(session_id);
    std::vector<session::OrderStep> steps;
    while (row.step()) {
        session::OrderStep step{row.integer(0),
                                named<session::Then>(kThenNames, row.text(1)),
                                named<session::Decider>(kDeciderNames, row.text(2)),
                                {}};
        if (!row.isNull(3)) step.attempt = session::AttemptId{row.integer(3)};
        steps.push_back(step);
    }
    return steps;
}

}  // namespace passung::store
