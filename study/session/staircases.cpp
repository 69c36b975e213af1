#include "study/session/staircases.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/assert.h"
#include "core/base/random.h"
#include "study/design/interleaving.h"

namespace passung::session {
namespace {

std::optional<double> valueOf(const std::vector<measures::Value>& measures, const std::string& name) {
    for (const measures::Value& measure : measures)
        if (measure.name == name) return measure.value;
    return std::nullopt;
}

std::size_t indexOf(const std::vector<plan::StaircaseTrack>& tracks, const std::string& name) {
    const auto found =
        std::find_if(tracks.begin(), tracks.end(), [&](const auto& track) { return track.name == name; });
    PASSUNG_ASSERT(found != tracks.end());
    return static_cast<std::size_t>(found - tracks.begin());
}

}  // namespace

Staircases::Staircases(const plan::StudyPlan& plan, std::string participant, std::uint64_t seed, int ordinal)
    : plan_(plan), participant_(std::move(participant)), seed_(seed), ordinal_(ordinal) {}

const plan::Staircase* Staircases::find(const design::PlannedTrial& trial) const {
    return plan::staircaseOf(plan_, static_cast<std::size_t>(trial.block_index));
}

/// The condition's tracks as the answers so far have left them.
Staircases::Tracks& Staircases::tracks(const plan::Staircase& staircase, std::size_t condition) const {
    const auto index = static_cast<std::size_t>(&staircase - plan_.staircases.data());
    const auto [known, fresh] = tracks_.try_emplace({index, condition});
    Tracks& tracks = known->second;
    if (!fresh) return tracks;
    for (const plan::StaircaseTrack& track : staircase.tracks) tracks.emplace_back(track.params);
    for (const ToldStep& told : told_)
        if (told.staircase == index && told.condition == condition)
            if (auto& track = tracks[indexOf(staircase.tracks, told.track)]; !track.finished())
                track.answer(told.level, told.positive);
    return tracks;
}

/// By the number that the trial has among those of its condition.
bool Staircases::isCatch(const plan::Staircase& staircase, const design::PlannedTrial& trial) const {
    if (staircase.catch_trials == 0) return false;
    const std::string purpose = fmt::format("staircase|{}|catch|{}", ordinal_, plan_.conditions[trial.condition].name);
    Random random(streamSeed(plan_.name, participant_, trial.block, purpose, seed_));
    const auto catches = design::drawCatches(staircase.trials(), staircase.catch_trials, random);
    return catches.count(static_cast<std::size_t>(trial.repetition)) != 0;
}

std::optional<StaircaseStep> Staircases::next(const design::PlannedTrial& trial) const {
    const plan::Staircase* staircase = find(trial);
    PASSUNG_ASSERT(staircase != nullptr);
    const Tracks& all = tracks(*staircase, trial.condition);
    Random random(streamSeed(plan_.name, participant_, trial.block,
                             fmt::format("staircase|{}|{}", ordinal_, trial.trial_index), seed_));
    const auto track = design::drawTrack(all, random);
    if (!track) return std::nullopt;
    StaircaseStep step{staircase->name, "", staircase->catch_level, staircase->catch_level, 0};
    if (!isCatch(*staircase, trial)) {
        step.track = staircase->tracks[*track].name;
        step.wanted = all[*track].wantedLevel();
        step.level = all[*track].nextLevel();
    }
    const auto level = std::find(staircase->levels.begin(), staircase->levels.end(), step.level);
    PASSUNG_ASSERT(level != staircase->levels.end());
    step.condition = plan::variantOf(plan_, *staircase, trial.condition,
                                     static_cast<std::size_t>(level - staircase->levels.begin()));
    return step;
}

bool Staircases::needs(const design::PlannedTrial& trial) const {
    const plan::Staircase* staircase = find(trial);
    if (staircase == nullptr) return true;
    const Tracks& all = tracks(*staircase, trial.condition);
    return std::any_of(all.begin(), all.end(), [](const design::AdaptiveTrack& track) { return !track.finished(); });
}

std::optional<bool> Staircases::answerTo(const design::PlannedTrial& trial,
                                         const std::vector<measures::Value>& measures) const {
    const plan::Staircase* staircase = find(trial);
    PASSUNG_ASSERT(staircase != nullptr);
    const auto value = valueOf(measures, staircase->measure);
    if (!value) return std::nullopt;
    return staircase->above ? *value > staircase->threshold : *value < staircase->threshold;
}

StaircaseAnswer Staircases::take(AttemptId attempt, const design::PlannedTrial& trial, const StaircaseStep& step,
                                 const std::vector<measures::Value>& measures, bool counts) {
    const plan::Staircase* staircase = find(trial);
    PASSUNG_ASSERT(staircase != nullptr);
    StaircaseAnswer answer;
    if (counts) answer.positive = answerTo(trial, measures);
    if (step.track.empty()) return answer;
    const std::size_t which = indexOf(staircase->tracks, step.track);
    design::AdaptiveTrack& track = tracks(*staircase, trial.condition)[which];
    if (answer.positive) {
        answer.reversal = track.answer(step.level, *answer.positive);
        told_.push_back({attempt, static_cast<std::size_t>(staircase - plan_.staircases.data()), trial.condition,
                         step.track, step.level, *answer.positive});
    }
    answer.estimate = track.estimate();
    answer.deviation = track.uncertainty();
    return answer;
}

void Staircases::restore(ToldStep told) {
    told_.push_back(std::move(told));
    tracks_.clear();
}

void Staircases::forget(AttemptId attempt) {
    tracks_.clear();
    std::erase_if(told_, [&](const ToldStep& told) { return told.attempt == attempt; });
}

}  // namespace passung::session
