#include "study/plan/plan_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace passung::plan {

namespace {

/// What conditions may have that nothing here can give a person.
struct WithoutOutput {
    bool (*has)(const Condition&);
    const char* sentence;
};

constexpr std::array kWithoutOutput = {
    WithoutOutput{
        [](const Condition& c) { return c.cues.vibrotactile; },
        "feedback.cues = [\"vibrotactile\"] can be given to simulated participants only: no device here has an "
        "actuator for it"},
    WithoutOutput{
        [](const Condition& c) { return c.secondary.stimulus == Stimulus::Vibrotactile; },
        "secondary.stimulus = \"vibrotactile\" can be given to simulated participants only: no device here has "
        "an actuator for it"},
    WithoutOutput{[](const Condition& c) { return c.secondary.stimulus == Stimulus::Visual; },
                  "secondary.stimulus = \"visual\" can be given to simulated participants only: no window draws it"},
};

bool isGoverned(const StudyPlan& plan, std::size_t block) {
    return std::any_of(plan.staircases.begin(), plan.staircases.end(),
                       [block](const Staircase& staircase) { return staircase.block == block; });
}

/// Does the protocol itself name the time, as a measure or as an outcome in this block?
bool namesTime(const StudyPlan& plan, const Block& block, bool chosen_measures) {
    constexpr std::string_view kTime = "time_s";
    return (chosen_measures && std::count(plan.measures.begin(), plan.measures.end(), kTime) > 0) ||
           std::any_of(plan.analyses.begin(), plan.analyses.end(), [&](const Analysis& analysis) {
               return analysis.outcome == kTime && (analysis.block.empty() || analysis.block == block.name);
           });
}

/// Pairs have no time-out that a repeated trial would hide.
bool hasPairsAlone(const StudyPlan& plan, const Block& block) {
    const bool own = block.first_condition > 0;
    const std::size_t shared = plan.shared_conditions > 0 ? plan.shared_conditions : plan.conditions.size();
    const std::size_t count = block.conditions.empty() ? shared : block.conditions.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t c = own ? block.first_condition + i : block.conditions.empty() ? i : block.conditions[i];
        if (c < plan.conditions.size() && !std::holds_alternative<DiscriminationPairTask>(plan.conditions[c].task.form))
            return false;
    }
    return true;
}

}  // namespace

std::vector<std::string> cuesWithoutOutput(std::span<const Condition> conditions) {
    std::vector<std::string> sentences;
    for (const WithoutOutput& cue : kWithoutOutput) {
        std::vector<std::string_view> names;
        for (const Condition& condition : conditions)
            if (cue.has(condition)) names.push_back(condition.name);
        if (!names.empty())
            sentences.push_back(fmt::format("{}; conditions: {}", cue.sentence, fmt::join(names, ", ")));
    }
    return sentences;
}

bool isForPeople(const StudyPlan& plan) {
    return cuesWithoutOutput(std::span(plan.conditions).first(plannedConditions(plan))).empty();
}

std::vector<std::string> conditionWarnings(std::span<const Condition> conditions) {
    std::vector<std::string> warnings;
    const auto warn = [&](std::string_view sentence, auto concerns) {
        std::vector<std::string_view> names;
        for (const Condition& condition : conditions)
            if (concerns(condition)) names.push_back(condition.name);
        if (!names.empty()) warnings.push_back(fmt::format("{}; conditions: {}", sentence, fmt::join(names, ", ")));
    };
    using scene::PenaltyVariant;
    const auto penalty = [](const Condition& condition) {
        return condition.scene.contact.method == scene::ContactMethod::Penalty;
    };
    const auto renders = [&](PenaltyVariant variant) {
        return [=](const Condition& condition) {
            return condition.scene.contact.rendersAtHand() && condition.scene.contact.variant == variant;
        };
    };
    warn(
        "contact.allow_unstable = true: nothing keeps the stiffness where the device is known to be stable; "
        "`explain` says how far the border is",
        [](const Condition& condition) { return condition.allow_unstable; });
    warn(
        "contact.variant = \"raw\" adds the stiffness up over all points in contact, so that nothing keeps the "
        "stiffness below the device's stable maximum",
        renders(PenaltyVariant::Raw));
    warn(
        "contact.variant = \"area_weighted\" has a stiffness that grows with the area, so that nothing keeps the "
        "stiffness below the device's stable maximum",
        renders(PenaltyVariant::AreaWeighted));
    const auto rubs = [](const Condition& condition, bool held) {
        const auto& parts = condition.scene.parts;
        return std::any_of(parts.begin(), parts.end(),
                           [=](const auto& part) { return part.held == held && part.friction > 0.0; });
    };
    warn("contact.method = \"penalty\" renders no friction: that of the parts is not felt",
         [&](const Condition& condition) {
             return penalty(condition) && rubs(condition, true) && rubs(condition, false);
         });
    warn("friction of one side only has no effect: the held part rubs with another if neither has 0",
         [&](const Condition& condition) { return rubs(condition, true) != rubs(condition, false); });
    for (std::string& sentence : cuesWithoutOutput(conditions)) warnings.push_back(std::move(sentence));
    warn("feedback.masking_noise = true covers the audio cue",
         [](const Condition& condition) { return condition.cues.masking_noise && condition.cues.audio; });
    warn("secondary.stimulus is a cue of the contact too: who answers one may mean the other", [](const auto& c) {
        return (c.cues.vibrotactile && c.secondary.stimulus == Stimulus::Vibrotactile) ||
               (c.cues.visual && c.secondary.stimulus == Stimulus::Visual) ||
               (c.cues.audio && c.secondary.stimulus == Stimulus::Audio);
    });
    return warnings;
}

std::vector<std::string> blockWarnings(const StudyPlan& plan, bool chosen_measures) {
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < plan.blocks.size(); ++i) {
        const Block& block = plan.blocks[i];
        if (block.phase != Phase::Main || isGoverned(plan, i)) continue;
        const bool never = block.on_invalid == Repeat::Never;
        if (never || block.max_attempts == 1)
            warnings.push_back(
                fmt::format("block.{}: after one attempt that does not count the session is not "
                            "complete unless the trial is repeated by hand or on resume; block: {}",
                            never ? "on_invalid = \"never\"" : "max_attempts = 1", block.name));
        if (block.on_timeout != Repeat::Never && block.max_attempts > 1 && namesTime(plan, block, chosen_measures) &&
            !hasPairsAlone(plan, block))
            warnings.push_back(
                fmt::format("block.on_timeout repeats trials after a time-out, and only the last attempt counts: "
                            "time_s, its restricted mean and finished look better than they are; with \"never\" a "
                            "time-out counts as not done by then; block: {}",
                            block.name));
    }
    return warnings;
}

std::vector<std::string> thresholdWarnings(const StudyPlan& plan) {
    std::vector<std::string> warnings;
    for (const Staircase& staircase : plan.staircases) {
        const bool analysed = std::any_of(plan.analyses.begin(), plan.analyses.end(),
                                          [&](const Analysis& a) { return a.staircase == staircase.name; });
        const bool steps = std::any_of(
            staircase.tracks.begin(), staircase.tracks.end(),
            [](const StaircaseTrack& track) { return track.params.method == design::AdaptiveMethod::UpDown; });
        if (analysed && steps)
            warnings.push_back(
                fmt::format("analysis.staircase: up and down in steps a track may turn too rarely to tell a threshold, "
                            "and whoever has none is left out of the analysis; rule = \"psi\" tells one after any "
                            "number of trials; staircase: {}",
                            staircase.name));
    }
    return warnings;
}

}  // namespace passung::plan
