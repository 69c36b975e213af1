#include "study/measures/assembly_watch.h"

#include <algorithm>
#include <utility>

#include "study/measures/tick_facts.h"
#include "study/measures/type_measures.h"

namespace passung::measures {

namespace {

Pose proxyPose(const TickRecord& record) {
    const auto& q = record.proxy_quaternion;
    return {Quat(q[0], q[1], q[2], q[3]).normalized(), proxyPosition(record)};
}

double forceOn(const TickRecord& record) {
    return Vec3(record.force_N[0], record.force_N[1], record.force_N[2]).norm();
}

}  // namespace

const char* stepStateName(StepState state) {
    constexpr std::array<const char*, 6> kNames = {"idle", "picked", "carried", "near", "inserted", "locked"};
    return kNames[static_cast<std::size_t>(state)];
}

AssemblyWatch::AssemblyWatch(std::vector<scene::AssemblyStep> steps, const scene::SceneSpec& spec)
    : steps_(std::move(steps)),
      states_(steps_.size(), StepState::Idle),
      taken_at_(steps_.size(), Vec3::Zero()),
      results_(steps_.size()) {
    for (const scene::PartSpec& part : spec.parts) X_WP_.push_back(part.X_WP);
}

std::optional<std::size_t> AssemblyWatch::stepOf(std::int32_t part) const {
    const auto of_part = [part](const scene::AssemblyStep& step) { return std::cmp_equal(step.part, part); };
    const auto found = std::find_if(steps_.begin(), steps_.end(), of_part);
    if (found == steps_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - steps_.begin());
}

bool AssemblyWatch::isHeld(std::int32_t part) const {
    return std::any_of(holds_.begin(), holds_.end(), [part](const Hold& hold) { return hold.part == part; });
}

void AssemblyWatch::enter(std::size_t step, StepState state, std::size_t hand, std::vector<StepChange>& changes) {
    if (states_[step] == state) return;
    states_[step] = state;
    changes.push_back({step, StepChange::What::State, state, hand});
}

void AssemblyWatch::follow(std::span<const TickRecord* const> hands, std::int64_t time,
                           std::vector<StepChange>& changes) {
    const std::int64_t periods = time_ ? time - *time_ : 1;
    time_ = time;
    std::array<std::int32_t, scene::kMostHands> left{};
    left.fill(kNoPart);
    for (std::size_t i = 0; i < hands.size(); ++i)
        if (hands[i] != nullptr && hands[i]->held != holds_[i].part) left[i] = std::exchange(holds_[i].part, kNoPart);
    for (std::size_t i = 0; i < hands.size(); ++i) {
        if (hands[i] == nullptr || hands[i]->held < 0) continue;
        if (holds_[i].part != hands[i]->held) take(i, *hands[i], time, changes);
        carry(i, *hands[i], periods, changes);
    }
    for (std::size_t i = 0; i < hands.size(); ++i)
        if (left[i] >= 0 && !isHeld(left[i])) layDown(i, left[i], changes);
    for (const TickRecord* record : hands)
        if (record != nullptr) return settle(record->steps_done, time, changes);
}

void AssemblyWatch::take(std::size_t hand, const TickRecord& record, std::int64_t time,
                         std::vector<StepChange>& changes) {
    const auto step = stepOf(record.held);
    const bool from_hand = isHeld(record.held);
    holds_[hand] = {record.held, proxyPosition(record)};
    if (!step) return;
    StepResult& result = results_[*step];
    result.hands |= 1u << hand;
    if (from_hand) return;
    ++result.picks;
    if (!result.picked) result.picked = time;
    taken_at_[*step] = X_WP_[steps_[*step].part].p;
    enter(*step, StepState::Picked, hand, changes);
}

void AssemblyWatch::carry(std::size_t hand, const TickRecord& record, std::int64_t periods,
                          std::vector<StepChange>& changes) {
    const Pose X_W = proxyPose(record);
    X_WP_[static_cast<std::size_t>(record.held)] = X_W;
    const double way = (X_W.p - std::exchange(holds_[hand].before, X_W.p)).norm();
    const auto step = stepOf(record.held);
    if (!step) return;
    StepResult& result = results_[*step];
    result.peak_force = std::max(result.peak_force, forceOn(record));
    // Of two hands on one part the first one tells its way.
    for (std::size_t other = 0; other < hand; ++other)
        if (holds_[other].part == record.held) return;
    result.held_periods += periods;
    result.path += way;
    const scene::AssemblyStep& asked = steps_[*step];
    const scene::GoalError error = scene::goalError(X_W, scene::goalOf(asked, X_WP_), asked.folds);
    StepState now = (X_W.p - taken_at_[*step]).norm() > kCarried ? StepState::Carried : StepState::Picked;
    if (error.position <= kNear * asked.position_tolerance) now = StepState::Near;
    if (scene::isAtGoal(asked, X_WP_)) now = StepState::Inserted;
    if (now > states_[*step] || states_[*step] == StepState::Locked) enter(*step, now, hand, changes);
}

void AssemblyWatch::layDown(std::size_t hand, std::int32_t part, std::vector<StepChange>& changes) {
    const auto step = stepOf(part);
    if (!step) return;
    changes.push_back({*step, StepChange::What::LetGo, StepState::Idle, hand});
    if (!scene::isAtGoal(steps_[*step], X_WP_)) {
        ++results_[*step].drops;
    } else if ((steps_[*step].after & ~done_) != 0) {
        ++results_[*step].order_errors;
        changes.push_back({*step, StepChange::What::OrderError, StepState::Idle, hand});
    }
    enter(*step, StepState::Idle, hand, changes);
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
        const scene::GoalError error =
            scene::goalError(X_WP_[steps_[i].part], scene::goalOf(steps_[i], X_WP_), steps_[i].folds);
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
    };
}

}  // namespace passung::measures
