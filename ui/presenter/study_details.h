#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/study_plan.h"
#include "study/session/order_rows.h"
#include "study/store/rows/rows.h"
#include "ui/presenter/design_balance.h"

namespace passung::presenter {

/// A block as it is planned for everybody.
struct BlockLine {
    std::string name;
    plan::Phase phase = plan::Phase::Main;
    plan::BlockOrder order = plan::BlockOrder::Williams;
    bool adaptive = false;
    int repetitions = 1, session = 1;
    double rest_s = 0.0;
};

/// One participant's session.
struct OrderLine {
    std::string code, group;  // group empty: there is one only
    int session = 1;
    std::size_t trials = 0;
    std::vector<session::OrderedBlock> blocks;
};

/// A study's design, expanded: what everybody will do.
struct StudyDetails {
    std::vector<std::string> conditions;  // names of those planned
    std::vector<BlockLine> blocks;
    std::vector<OrderLine> orders;
    std::vector<double> minutes;  // of each session by plan::longestDuration(), which is no bound
    DesignBalance balance;        // of these participants
};

/// Of the first so many participants. Errors: constraints that no order keeps to.
Result<StudyDetails> detailsOf(const plan::StudyPlan& plan, int participants);

/// A setting that was measured for accuracy over time.
struct AccuracyPoint {
    double time_us = 0.0, error_um = 0.0;  // 99th percentiles of a query's time and of the depth's error
    std::string mode;
    double tolerance_um = 0.0, spacing_mm = 0.0;
    std::int64_t budget_nodes = 0;
    std::vector<double> picked_for_us;
    bool front = false;  // none is both faster and at least as exact
};

/// Of the rows of one protocol those that were measured, the fastest first.
std::vector<AccuracyPoint> accuracyPoints(const std::vector<store::AccuracyRow>& rows,
                                          const std::string& protocol_sha256);

}  // namespace passung::presenter
