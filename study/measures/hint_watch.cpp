#include "study/measures/hint_watch.h"

namespace passung::measures {

bool mayBeNext(const scene::AssemblyStep& step, std::size_t index, scene::StepSet done) {
    return (done & scene::stepBit(index)) == 0 && (step.after & ~done) == 0;
}

std::optional<std::size_t> firstNext(std::span<const scene::AssemblyStep> steps, scene::StepSet done) {
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (mayBeNext(steps[i], i, done)) return i;
    return std::nullopt;
}

bool HintWatch::follow(std::int64_t time, scene::StepSet done) {
    if (after_ <= 0) return false;
    if (!since_ || done != done_) {
        since_ = time;
        done_ = done;
        shown_.reset();
        return false;
    }
    if (shown_ || time - *since_ < after_) return false;
    shown_ = firstNext(steps_, done);
    return shown_.has_value();
}

}  // namespace passung::measures
