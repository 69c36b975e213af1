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

}  // namespace passung::protocol
