#include "ui/app/simulated_perception.h"

#include <cmath>
#include <utility>

#include "core/base/random.h"

namespace passung::app {
namespace {

double onAxis(const protocol::Staircase& staircase, double level) {
    return staircase.tracks.front().params.logarithmic ? std::log10(level) : level;
}

}  // namespace

SimulatedPerception::SimulatedPerception(const protocol::StudyPlan& plan, std::string participant)
    : plan_(plan), participant_(std::move(participant)) {}

person::Perception SimulatedPerception::of(std::size_t staircase) const {
    const protocol::Staircase& known = plan_.staircases[staircase];
    return person::perceptionOf(plan_.name, participant_, plan_.seed, known.name, onAxis(known, known.levels.front()),
                                onAxis(known, known.levels.back()));
}

std::optional<bool> SimulatedPerception::notices(const protocol::Condition& condition, std::int64_t trial_index,
                                                 double guess) const {
    if (!condition.stimulus) return std::nullopt;
    const protocol::Staircase& staircase = plan_.staircases[condition.stimulus->staircase];
    Random random(streamSeed(plan_.name, participant_, "perception",
                             "simulated|" + staircase.name + "|" + std::to_string(trial_index), plan_.seed));
    return person::perceives(of(condition.stimulus->staircase), onAxis(staircase, condition.stimulus->level), guess,
                             random);
}

}  // namespace passung::app
