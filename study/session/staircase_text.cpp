#include "study/session/staircase_text.h"

#include <fmt/format.h>

#include <vector>

#include "study/design/counted.h"

namespace passung::session {
namespace {

using design::AdaptiveMethod;
using design::AdaptiveParams;

std::string ruleText(const AdaptiveParams& params, const std::string& unit) {
    if (params.method == AdaptiveMethod::Psi)
        return fmt::format("psi, guess {:.6g}, lapse {:.6g}, sigma {:.6g} to {:.6g}{}", params.guess, params.lapse,
                           params.sigma_low, params.sigma_high, unit);
    std::string text = fmt::format("1 up, {} down, steps {:.6g} up and {:.6g} down{}", params.down_after,
                                   params.step_up, params.step_down, unit);
    if (params.late_factor < 1.0)
        text += fmt::format(", times {:.6g} after {}", params.late_factor,
                            design::counted(static_cast<std::size_t>(params.late_after), "reversal"));
    return text;
}

std::string stopText(const AdaptiveParams& params) {
    std::string text = design::counted(static_cast<std::size_t>(params.max_trials), "trial");
    if (params.max_reversals > 0)
        text += fmt::format(" or {}", design::counted(static_cast<std::size_t>(params.max_reversals), "reversal"));
    return text;
}

std::string staircaseText(const plan::StudyPlan& plan, const plan::Staircase& staircase) {
    const AdaptiveParams& params = staircase.tracks.front().params;
    const std::string unit = params.logarithmic ? " decades" : staircase.unit.empty() ? "" : " " + staircase.unit;
    std::string text =
        fmt::format("  {}  block {}: {} from {:.6g} to {:.6g}{}, {}\n    {}; settles at {:.3g} % positive\n",
                    staircase.name, plan.blocks[staircase.block].name, staircase.key, staircase.levels.front(),
                    staircase.levels.back(), staircase.unit.empty() ? "" : " " + staircase.unit,
                    design::counted(staircase.levels.size(), "level"), ruleText(params, unit), 100.0 * params.target());
    text += fmt::format("    positive: {} {} {:.6g}\n", staircase.measure, staircase.above ? "above" : "below",
                        staircase.threshold);
    std::vector<std::string> tracks;
    for (const plan::StaircaseTrack& track : staircase.tracks)
        tracks.push_back(track.params.method == AdaptiveMethod::Psi
                             ? track.name
                             : fmt::format("{} from {:.6g}", track.name, track.params.start));
    text += fmt::format("    tracks {}, each of {} for every condition", fmt::join(tracks, ", "), stopText(params));
    if (staircase.catch_trials > 0)
        text += fmt::format("; {} at {:.6g}", design::counted(staircase.catch_trials, "catch trial"),
                            staircase.catch_level);
    return text + "\n";
}

}  // namespace

std::string staircasesText(const plan::StudyPlan& plan) {
    if (plan.staircases.empty()) return "";
    std::string text = "Staircases\n";
    for (const plan::Staircase& staircase : plan.staircases) text += staircaseText(plan, staircase);
    return text + "\n";
}

bool mayEndEarly(const plan::StudyPlan& plan) {
    for (const plan::Staircase& staircase : plan.staircases)
        for (const plan::StaircaseTrack& track : staircase.tracks)
            if (track.params.max_reversals > 0) return true;
    return false;
}

}  // namespace passung::session
