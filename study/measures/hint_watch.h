#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/scene/assembly.h"

namespace passung::measures {

/// The step is not done, and all that it is after are.
bool mayBeNext(const scene::AssemblyStep& step, std::size_t index, scene::StepSet done);

/// The first of these in the order of the protocol; none: all are done.
std::optional<std::size_t> firstNext(std::span<const scene::AssemblyStep> steps, scene::StepSet done);

/// When a hint of an assembly comes up, and to which step: `after` periods in which no step is done or taken back, from
/// the first tick told on; to firstNext(). It stays until a step is done or taken back. From the ticks alone, so that a
/// screen and a judge of the records agree.
class HintWatch {
public:
    HintWatch() = default;  // of a study without hints
    /// `after` ≤ 0: never.
    HintWatch(std::vector<scene::AssemblyStep> steps, std::int64_t after) : steps_(std::move(steps)), after_(after) {}

    /// The next tick of the running trial. `time` [haptic periods, from any origin]; `done`: the steps that are. True:
    /// a hint comes up in it.
    bool follow(std::int64_t time, scene::StepSet done);

    /// The step that a hint now leads to.
    std::optional<std::size_t> shown() const { return shown_; }

private:
    std::vector<scene::AssemblyStep> steps_;
    std::int64_t after_ = 0;
    std::optional<std::int64_t> since_;  // time of the first tick, or of the newest change of what is done
    scene::StepSet done_ = 0;
    std::optional<std::size_t> shown_;
};

}  // namespace passung::measures
