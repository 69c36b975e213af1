#include "study/protocol/study_plan.h"

namespace passung::protocol {

const char* phaseName(Phase phase) { return phase == Phase::Practice ? "practice" : "main"; }

const char* blockOrderName(BlockOrder order) {
    switch (order) {
        case BlockOrder::Williams:
            return "williams";
        case BlockOrder::Random:
            return "random";
        case BlockOrder::Listed:
            return "listed";
    }
    return "";
}

const char* momentName(Moment moment) {
    switch (moment) {
        case Moment::SessionStart:
            return "session_start";
        case Moment::BeforeBlock:
            return "before_block";
        case Moment::AfterBlock:
            return "after_block";
        case Moment::AfterTrial:
            return "after_trial";
        case Moment::AfterCondition:
            return "after_condition";
        case Moment::SessionEnd:
            return "session_end";
    }
    return "";
}

}  // namespace passung::protocol
