#include "study/session/plan_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/design/balance.h"
#include "study/design/counted.h"
#include "study/design/trial_order.h"
#include "study/design/williams.h"
#include "study/plan/duration.h"
#include "study/plan/language.h"
#include "study/session/order_rows.h"
#include "study/session/participant_order.h"
#include "study/session/staircase_text.h"

namespace passung::session {
namespace {

std::string factorsText(const plan::StudyPlan& plan) {
    if (plan.factors.empty()) return "";
    std::size_t width = 0;
    for (const auto& factor : plan.factors) width = std::max(width, factor.name.size());
    const bool within = std::all_of(plan.factors.begin(), plan.factors.end(),
                                    [](const auto& f) { return f.kind == plan::FactorKind::Within; });
    std::string text = within ? "Factors (within participants)\n" : "Factors\n";
    for (const auto& factor : plan.factors) {
        std::vector<std::string> labels;
        for (const auto& level : factor.levels) labels.push_back(level.label + (level.catch_trial ? " (catch)" : ""));
        text += fmt::format("  {:<{}}  {}{}{}{}\n", factor.name, width,
                            within ? "" : fmt::format("{}: ", plan::factorKindName(factor.kind)),
                            fmt::join(labels, ", "), factor.unit.empty() ? "" : " ", factor.unit);
    }
    return text + "\n";
}

std::string conditionsText(const plan::StudyPlan& plan) {
    std::string text = "Conditions\n";
    for (std::size_t i = 0; i < plan::plannedConditions(plan); ++i) {
        const plan::Condition& condition = plan.conditions[i];
        const scene::ContactSpec& contact = condition.scene.contact;
        text += fmt::format("  {:>3}  {}  (device {}", i + 1, condition.name, condition.device);
        if (condition.timed_by != plan::TimedBy::Program)
            text += fmt::format(" rests, timed by the {})\n", plan::timedByName(condition.timed_by));
        else if (!condition.scene.display_wrench)
            text += ", no force is displayed)\n";
        else
            text += fmt::format(", {:.6g} N/m, {:.6g} Nm/rad)\n", contact.stiffness, contact.rotational_stiffness);
    }
    return text + "\n";
}

/// Trials of each pass of a block, as everybody has them.
std::size_t trialsPerPass(const design::Design& design, std::size_t b, const plan::Block& block) {
    const auto cells = design::cellsOf(design.blocks[b], design::cellsOf(design, 0, 0, "", 0)).ordinary;
    const auto parts = design::partedBy(design, block.blocked, cells);
    return block.trials > 0 ? static_cast<std::size_t>(block.trials) : parts.empty() ? 0 : parts[0].size();
}

std::string blockText(const plan::StudyPlan& plan, const design::Design& design, std::size_t b) {
    const plan::Block& block = plan.blocks[b];
    std::string text =
        fmt::format("{}, order {}, {} x {}", plan::phaseName(block.phase), plan::blockOrderName(block.order),
                    design::counted(trialsPerPass(design, b, block), "trial"),
                    design::counted(static_cast<std::size_t>(block.repetitions), "repetition"));
    if (block.blocked)
        text += fmt::format(", blocked by {} (order {})", plan.factors[*block.blocked].name,
                            plan::blockOrderName(block.blocked_order));
    if (block.catches.trials > 0)
        text += fmt::format(", {} a pass", design::counted(block.catches.trials, "catch trial"));
    if (plan::sessionsOf(plan) > 1) text += fmt::format(", session {}", block.session);
    if (block.rest > 0.0) text += fmt::format(", after at least {:.6g} s of rest", block.rest);
    if (block.rest_ends != plan::RestEnds::ByTime)
        text += fmt::format(" that the {} ends", plan::restEndsName(block.rest_ends));
    if (!block.constraints.empty())
        text += fmt::format(", {}: {:.3g} % of plain shuffles keep to them",
                            design::counted(block.constraints.size(), "constraint"),
                            100.0 * design::acceptanceOf(design, b));
    return text;
}

std::string blocksText(const plan::StudyPlan& plan) {
    std::size_t width = 0;
    for (const auto& block : plan.blocks) width = std::max(width, block.name.size());
    const auto design = plan::designOf(plan);
    std::string text = "Blocks\n";
    for (std::size_t b = 0; b < plan.blocks.size(); ++b)
        text += fmt::format("  {:<{}}  {}\n", plan.blocks[b].name, width, blockText(plan, design, b));
    return text + "\n";
}

std::string questionnairesText(const plan::StudyPlan& plan) {
    if (plan.questionnaires.empty()) return "";
    std::string text = "Questionnaires\n";
    for (const auto& planned : plan.questionnaires) {
        const bool of_session =
            planned.moment == plan::Moment::SessionStart || planned.moment == plan::Moment::SessionEnd;
        text += fmt::format("  {} {}  {}{}, {}, {}\n", planned.definition.key, planned.definition.version,
                            plan::momentName(planned.moment),
                            of_session              ? ""
                            : planned.block.empty() ? " of every main block"
                                                    : " of block " + planned.block,
                            fmt::join(plan::languagesAsked(plan, planned), "/"),
                            design::counted(planned.definition.items.size(), "item"));
    }
    return text + "\n";
}

/// One participant's session: the condition numbers of each pass, blocks parted by |, catch trials marked with a star;
/// passes that repeat the one before are counted.
std::string orderText(const std::vector<OrderedBlock>& order) {
    std::string text;
    for (const OrderedBlock& block : order) {
        std::vector<std::string> passes;
        for (const OrderedPass& pass : block.passes) {
            std::string& written = passes.emplace_back();
            for (const OrderedTrial& trial : pass.trials)
                written += fmt::format("{}{}{}", written.empty() ? "" : " ", trial.condition + 1,
                                       trial.catch_trial ? "*" : "");
            if (pass.times > 1) written += fmt::format(" (x{})", pass.times);
        }
        text += fmt::format("{}{}", text.empty() ? "" : " | ", fmt::join(passes, ", "));
    }
    return text;
}

/// The design is one Williams square for everybody.
bool isPlainSquare(const design::Design& design) {
    const auto balancings = design::counterbalancingFactorsOf(design);
    return balancings.size() == 1 && balancings[0].what == design::CounterbalancingFactor::What::Conditions &&
           !balancings[0].factor && balancings[0].order == design::Order::Williams &&
           design::groupsOf(design).size() == 1;
}

}  // namespace

std::string describeBalance(const plan::StudyPlan& plan, const std::vector<DesignPlace>& places) {
    const auto design = plan::designOf(plan);
    if (places.empty() || design::evenNumber(design) < 2) return "";
    const auto groups = plan::groupNames(plan);
    std::string text = fmt::format("{}; all rows and groups meet equally often with multiples of {}.\n",
                                   design::counted(places.size(), "participant"), design::evenNumber(design));
    for (std::size_t group = 0; group < groups.size(); ++group) {
        std::vector<std::size_t> slots;
        for (const DesignPlace& place : places)
            if (place.group == group) slots.push_back(place.slot);
        if (groups.size() > 1)
            text += fmt::format("  group {}: {}\n", groups[group], design::counted(slots.size(), "participant"));
        for (const auto& line : design::balanceLines(design, slots)) text += fmt::format("  {}\n", line);
    }
    return text;
}

std::vector<std::string> planWarnings(const plan::StudyPlan& plan) {
    std::vector<std::string> warnings = plan.warnings;
    if (plan.conditions.empty()) return warnings;
    const auto design = plan::designOf(plan);
    const std::size_t whole = design::evenNumber(design);
    if (static_cast<std::size_t>(plan.participants) % whole != 0)
        warnings.push_back(fmt::format(
            "study.participants = {} is not a multiple of the {}: orders will not be balanced", plan.participants,
            isPlainSquare(design) ? fmt::format("{} rows of the Williams square", whole)
                                  : fmt::format("{} rows of all squares and groups together", whole)));
    return warnings;
}

Result<std::string> describePlan(const plan::StudyPlan& plan, int participants, int stations) {
    std::string text =
        fmt::format("{}\nstudy {}, version {}, seed {}, {} planned\n\n", plan.title, plan.name, plan.version, plan.seed,
                    design::counted(static_cast<std::size_t>(plan.participants), "participant"));
    text +=
        factorsText(plan) + conditionsText(plan) + blocksText(plan) + staircasesText(plan) + questionnairesText(plan);

    text += "Orders (numbers of conditions; blocks parted by |)\n";
    const auto groups = plan::groupNames(plan);
    const auto planned = plannedSessions(plan, participants, stations);
    if (!planned) return planned.errors();
    std::vector<DesignPlace> places;
    std::vector<double> longest(static_cast<std::size_t>(plan::sessionsOf(plan)));
    std::size_t count = 0;  // of the last participant's trials
    for (const PlannedSession& one : *planned) {
        if (one.session == 1) {
            places.push_back(one.place);
            count = 0;
        }
        text += fmt::format("  {}{}{}  {}\n", one.participant, groups.size() > 1 ? " " + groups[one.place.group] : "",
                            longest.size() > 1 ? fmt::format(", session {}", one.session) : "",
                            orderText(orderOf(plan, one.trials)));
        auto& most = longest[static_cast<std::size_t>(one.session - 1)];
        most = std::max(most, plan::longestDuration(plan, one.trials));
        count += one.trials.size();
    }
    const auto design = plan::designOf(plan);
    text += stations == 1 && !places.empty() && isPlainSquare(design)
                ? design::balanceSentence(places.size(), design::counterbalancingFactorsOf(design)[0].items) + ".\n"
                : describeBalance(plan, places);

    text += fmt::format("\nDuration\n  {}{} a participant,", mayEndEarly(plan) ? "at most " : "",
                        design::counted(count, "trial"));
    for (const double& seconds : longest)
        text += fmt::format("{} {:.1f} min", &seconds == &longest[0] ? "" : " +", seconds / 60.0);
    text +=
        " if each lasts to its time-out and rests are as short as they may be;\n"
        "  ways to the start, repeated attempts, questionnaires and instructions come on top\n";
    if (!plan.analyses.empty()) text += "\nPlanned analyses\n";
    for (const auto& analysis : plan.analyses)
        text += fmt::format("  {} by {}: {}\n", analysis.outcome, fmt::join(analysis.factors, ", "), analysis.test);
    for (const auto& warning : planWarnings(plan)) text += fmt::format("\nwarning: {}\n", warning);
    return text;
}

}  // namespace passung::session
