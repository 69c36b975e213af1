#include "study/session/plan_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/design/counted.h"
#include "study/design/williams.h"
#include "study/protocol/participant.h"
#include "study/session/participant_order.h"

namespace passung::session {
namespace {

std::string factorsText(const protocol::StudyPlan& plan) {
    if (plan.factors.empty()) return "";
    std::size_t width = 0;
    for (const auto& factor : plan.factors) width = std::max(width, factor.name.size());
    std::string text = "Factors (within participants)\n";
    for (const auto& factor : plan.factors) {
        std::vector<std::string_view> labels;
        for (const auto& level : factor.levels) labels.push_back(level.label);
        text += fmt::format("  {:<{}}  {}{}{}\n", factor.name, width, fmt::join(labels, ", "),
                            factor.unit.empty() ? "" : " ", factor.unit);
    }
    return text + "\n";
}

std::string conditionsText(const protocol::StudyPlan& plan) {
    std::string text = "Conditions\n";
    for (std::size_t i = 0; i < plan.conditions.size(); ++i)
        text += fmt::format("  {:>3}  {}  (device {}, {:.6g} N/m, {:.6g} Nm/rad)\n", i + 1, plan.conditions[i].name,
                            plan.conditions[i].device, plan.conditions[i].scene.contact.stiffness,
                            plan.conditions[i].scene.contact.rotational_stiffness);
    return text + "\n";
}

std::size_t trialsPerPass(const protocol::StudyPlan& plan, const protocol::Block& block) {
    return block.trials > 0 ? static_cast<std::size_t>(block.trials) : plan.conditions.size();
}

std::string blocksText(const protocol::StudyPlan& plan) {
    std::size_t width = 0;
    for (const auto& block : plan.blocks) width = std::max(width, block.name.size());
    std::string text = "Blocks\n";
    for (const auto& block : plan.blocks) {
        const std::size_t trials = trialsPerPass(plan, block);
        text += fmt::format("  {:<{}}  {}, order {}, {} x {}\n", block.name, width, protocol::phaseName(block.phase),
                            protocol::blockOrderName(block.order), design::counted(trials, "trial"),
                            design::counted(static_cast<std::size_t>(block.repetitions), "repetition"));
    }
    return text + "\n";
}

/// One participant's blocks: the condition numbers of each pass; a pass that is repeated unchanged is written once.
std::string orderText(const protocol::StudyPlan& plan, const std::vector<design::PlannedTrial>& trials) {
    std::string text;
    std::size_t next = 0;
    for (const auto& block : plan.blocks) {
        std::vector<std::string> passes(static_cast<std::size_t>(block.repetitions));
        for (auto& pass : passes)
            for (std::size_t i = 0; i < trialsPerPass(plan, block); ++i)
                pass += fmt::format("{}{}", i == 0 ? "" : " ", trials[next++].condition + 1);
        const bool repeated = block.order != protocol::BlockOrder::Random && passes.size() > 1;
        text += text.empty() ? "" : " | ";
        text +=
            repeated ? fmt::format("{} (x{})", passes[0], passes.size()) : fmt::format("{}", fmt::join(passes, ", "));
    }
    return text;
}

/// [s], if every trial runs into its time-out.
double longestSession(const protocol::StudyPlan& plan, const std::vector<design::PlannedTrial>& trials) {
    double seconds = 0.0;
    for (const auto& trial : trials) seconds += plan.conditions[trial.condition].task.timeout;
    return seconds;
}

bool hasWilliams(const protocol::StudyPlan& plan) {
    return std::any_of(plan.blocks.begin(), plan.blocks.end(),
                       [](const auto& block) { return block.order == protocol::BlockOrder::Williams; });
}

}  // namespace

std::vector<std::string> planWarnings(const protocol::StudyPlan& plan) {
    std::vector<std::string> warnings = plan.warnings;
    if (!hasWilliams(plan) || plan.conditions.empty()) return warnings;
    const std::size_t rows = design::williamsRows(plan.conditions.size());
    if (static_cast<std::size_t>(plan.participants) % rows != 0)
        warnings.push_back(
            fmt::format("study.participants = {} is not a multiple of the {} rows of the Williams square: orders will "
                        "not be balanced",
                        plan.participants, rows));
    return warnings;
}

std::string describePlan(const protocol::StudyPlan& plan, int participants) {
    std::string text =
        fmt::format("{}\nstudy {}, version {}, seed {}, {} planned\n\n", plan.title, plan.name, plan.version, plan.seed,
                    design::counted(static_cast<std::size_t>(plan.participants), "participant"));
    text += factorsText(plan) + conditionsText(plan) + blocksText(plan);

    text += "Orders (numbers of conditions; blocks parted by |)\n";
    double longest = 0.0;
    std::size_t count = 0;
    for (int number = 1; number <= participants; ++number) {
        const auto code = protocol::participantCode(protocol::ParticipantKind::Real, number);
        const auto trials = planTrials(plan, static_cast<std::size_t>(number - 1), code);
        text += fmt::format("  {}  {}\n", code, orderText(plan, trials));
        longest = std::max(longest, longestSession(plan, trials));
        count = trials.size();
    }
    if (hasWilliams(plan) && participants > 0)
        text += fmt::format("{}.\n",
                            design::balanceSentence(static_cast<std::size_t>(participants), plan.conditions.size()));

    text += fmt::format(
        "\nDuration\n  {} a participant, at most {:.1f} min (every trial to its time-out, pauses not "
        "counted)\n",
        design::counted(count, "trial"), longest / 60.0);
    for (const auto& warning : planWarnings(plan)) text += fmt::format("\nwarning: {}\n", warning);
    return text;
}

}  // namespace passung::session
