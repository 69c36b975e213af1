#include "study/measures/assembly_watch.h"

#include <algorithm>
#include <utility>

#include "study/measures/tick_facts.h"
#include "study/measures/type_measures.h"

namespace passung::measures {

namespace {

double forceOn(const TickRecord& record) {
    return Vec3(record.force_N[0], record.force_N[1], record.force_N[2]).norm();
}

}  // namespace

const char* stepStateName(StepState state) {
    constexpr std::array<const char*, 6> kNames = {"idle", "picked", "carried", "near", "inserted", "locked"};
    return kNames[static_cast<std::size_t>(state)];
}

StepState stateInHand(const scene::AssemblyStep& step, std::span<const Pose> X_WP, double moved) {
    if (scene::isAtGoal(step, X_WP)) return StepState::Inserted;
    const scene::GoalError error = scene::goalError(X_WP[step.part], scene::goalOf(step, X_WP), step.folds);
    if (error.position <= kNear * step.position_tolerance) return StepState::Near;
    return moved > kCarried ? StepState::Carried : StepState::Picked;
}

AssemblyWatch::AssemblyWatch(const scene::SceneSpec& spec)
    : steps_(spec.effects.pick.steps),
      parts_(spec),
      before_(parts_),
      states_(steps_.size(), StepState::Idle),
      taken_at_(steps_.size(), Vec3::Zero()),
      results_(steps_.size()) {}

std::optional<std::size_t> AssemblyWatch::stepOf(std::size_t part) const {
    const auto found =
        std::find_if(steps_.begin(), steps_.end(), [part](const auto& step) { return step.part == part; });
    if (found == steps_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - steps_.begin());
}

scene::GoalError AssemblyWatch::errorOf(std::size_t step) const {
    const scene::AssemblyStep& asked = steps_[step];
    return scene::goalError(parts_.poses()[asked.part], scene::goalOf(asked, parts_.poses()), asked.folds);
}

void AssemblyWatch::enter(std::size_t step, StepState state, std::size_t hand, std::vector<StepChange>& changes) {
    if (states_[step] == state) return;
    states_[step] = state;
    changes.push_back({step, StepChange::What::State, state, hand});
}

void AssemblyWatch::follow(std::span<const TickRecord* const> hands, std::int64_t time,
                           std::vector<StepChange>& changes) {
    const bool began = time_.has_value();
    const std::int64_t periods = began ? time - *time_ : 1;
    time_ = time;
    before_ = parts_;
    parts_.follow(hands);
    for (std::size_t i = 0; i < hands.size(); ++i) {
        const auto part = parts_.heldBy(i);
        const auto step = part ? stepOf(*part) : std::nullopt;
        if (!step || hands[i] == nullptr) continue;
        const Vec3& from = before_.poses()[*part].p;
        if (before_.heldBy(i) != part || !began) {
            results_[*step].hands |= 1u << i;
            if (!before_.isHeld(*part) || !began) take(*step, i, from, time, changes);
        }
        results_[*step].peak_force = std::max(results_[*step].peak_force, forceOn(*hands[i]));
        bool first = true;  // of two hands on one part
        for (std::size_t other = 0; other < i; ++other) first = first && parts_.heldBy(other) != part;
        if (first) carry(*step, i, from, periods, changes);
    }
    for (std::size_t i = 0; i < hands.size(); ++i)
        if (const auto left = before_.heldBy(i); left && !parts_.isHeld(*left))
            if (const auto step = stepOf(*left)) layDown(*step, i, changes);
    for (const TickRecord* record : hands)
        if (record != nullptr) return settle(record->steps_done, time, changes);
}

void AssemblyWatch::take(std::size_t step, std::size_t hand, const Vec3& from, std::int64_t time,
                         std::vector<StepChange>& changes) {
    StepResult& result = results_[step];
    ++result.picks;
    if (!result.picked) result.picked = time;
    taken_at_[step] = from;
    enter(step, StepState::Picked, hand, changes);
}

void AssemblyWatch::carry(std::size_t step, std::size_t hand, const Vec3& from, std::int64_t periods,
                          std::vector<StepChange>& changes) {
    const Vec3& p = parts_.poses()[steps_[step].part].p;
    results_[step].held_periods += periods;
    results_[step].path += (p - from).norm();
    const StepState now = stateInHand(steps_[step], parts_.poses(), (p - taken_at_[step]).norm());
    if (now > states_[step]) enter(step, now, hand, changes);
}

void AssemblyWatch::layDown(std::size_t step, std::size_t hand, std::vector<StepChange>& changes) {
    changes.push_back({step, StepChange::What::LetGo, StepState::Idle, hand});
    if (!isAtGoal(step)) {
        ++results_[step].drops;
    } else if ((steps_[step].after & ~done_) != 0) {
        ++results_[step].order_errors;
        changes.push_back({step, StepChange::What::OrderError, StepState::Idle, hand});
    }
    enter(step, StepState::Idle, hand, changes);
}

void AssemblyWatch::settle(std::uint64_t done, std::int64_t time, std::vector<StepChange>& changes) {
    for (std::size_t i = 0; i < steps_.size() && done != done_; ++i) {
        const scene::StepSet step = scene::stepBit(i);
        if ((done & step) == (done_ & step)) continue;
        if ((done & step) != 0) {
            results_[i].done = time;
            enter(i, StepState::Locked, 0, changes);
        } else {
            results_[i].done.reset();
            ++results_[i].undos;
            changes.push_back({i, StepChange::What::Undone, states_[i], 0});
            if (states_[i] == StepState::Locked) enter(i, StepState::Idle, 0, changes);
        }
    }
    done_ = done;
}

std::vector<StepResult> AssemblyWatch::results(std::int64_t start) const {
    std::vector<StepResult> results = results_;
    for (std::size_t i = 0; i < results.size(); ++i) {
        StepResult& result = results[i];
        const scene::GoalError error = errorOf(i);
        result.position_error = error.position;
        result.angle_error = error.angle;
        if (result.done)
            for (const StepResult& other : results_)
                if (other.done && *other.done <= *result.done) ++result.place;
    }
    for (StepResult& result : results) {
        if (result.picked) *result.picked -= start;
        if (result.done) *result.done -= start;
    }
    return results;
}

namespace {

/// Sum of a count over the steps.
template <class Count>
Optional sumOver(const Trial& trial, Count count) {
    const auto* facts = std::get_if<AssemblyFacts>(&trial.context.form);
    if (facts == nullptr || trial.ticks.empty()) return std::nullopt;
    double sum = 0.0;
    for (const StepResult& step : facts->steps) sum += static_cast<double>(count(step));
    return sum;
}

/// Of the steps that have one; steps of longer paths weigh more.
Optional pathRatio(const Trial& trial) {
    const auto* facts = std::get_if<AssemblyFacts>(&trial.context.form);
    if (facts == nullptr || trial.ticks.empty()) return std::nullopt;
    double way = 0.0, free = 0.0;
    for (const StepResult& step : facts->steps) {
        if (!step.pathRatio()) continue;
        way += step.path;
        free += *step.free_path;
    }
    if (!(free > 0.0)) return std::nullopt;
    return way / free;
}

}  // namespace

std::vector<Measure> assemblyMeasures() {
    const auto times = [](std::string name, std::string label, std::string what, Optional (*compute)(const Trial&)) {
        return Measure{{std::move(name), std::move(label), "1", std::move(what)}, compute};
    };
    return {
        times("steps_done", "Steps done",
              "number of steps that were done at the end tick: rows of assembly_steps.csv with done_s",
              [](const Trial& t) { return sumOver(t, [](const StepResult& s) { return s.done ? 1 : 0; }); }),
        times("order_errors", "Errors of order",
              "how often a part was let go at its goal before a step that comes before was done",
              [](const Trial& t) { return sumOver(t, [](const StepResult& s) { return s.order_errors; }); }),
        times("drops", "Parts let go elsewhere", "how often a step's part was let go where it does not belong",
              [](const Trial& t) { return sumOver(t, [](const StepResult& s) { return s.drops; }); }),
        times("regrasps", "Parts taken again",
              "how often a step's part was taken into a hand from none after the first time",
              [](const Trial& t) {
                  return sumOver(t, [](const StepResult& s) { return std::max<std::int64_t>(0, s.picks - 1); });
              }),
        times("undos", "Steps taken back", "how often a step that was done was taken back",
              [](const Trial& t) { return sumOver(t, [](const StepResult& s) { return s.undos; }); }),
        times("hints", "Hints", "how often a hint came up: rows of events.csv with hint_shown",
              [](const Trial& t) { return sumOver(t, [](const StepResult& s) { return s.hints; }); }),
        {{"path_ratio", "Way of the parts over free paths", "1",
          "sum of path_m over sum of free_path_m of the rows of assembly_steps.csv that have both and done_s; empty "
          "without such a row; 1: as far as the free path, which need not be the shortest"},
         pathRatio},
    };
}

}  // namespace passung::measures
