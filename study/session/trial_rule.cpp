#include "study/session/trial_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "study/measures/placement.h"
#include "study/measures/tick_facts.h"
#include "study/session/rendered_scenes.h"

namespace passung::session {
namespace {

constexpr std::int64_t kWayBackLimit = 60'000;  // [periods]

}  // namespace

TrialRule::TrialRule(const plan::Task& task, const scene::SceneSpec& scene, const Pose& X_WT,
                     std::uint64_t attempt_seed)
    : X_WT_(X_WT), form_(makeRule(task, scene, X_WT, attempt_seed)) {}

TrialRule::AnyRule TrialRule::makeRule(const plan::Task& task, const scene::SceneSpec& scene, const Pose& X_WT,
                                       std::uint64_t attempt_seed) {
    if (const auto* peg = std::get_if<plan::PegInHoleTask>(&task.form)) return Insertion{*peg, SuccessRule(*peg, X_WT)};
    if (const auto* passage = std::get_if<plan::NarrowPassageTask>(&task.form)) {
        const measures::PassageFacts facts{passage->length, passage->width};
        return Passage{facts, {facts, X_WT}};
    }
    if (const auto* contour = std::get_if<plan::ContourFollowingTask>(&task.form)) {
        const measures::ContourFacts facts{contour->points, contour->reach, contour->force};
        return Contour{facts, contour->coverage, {facts, X_WT}};
    }
    if (const auto* placement = std::get_if<plan::FreePlacementTask>(&task.form)) return Placement{*placement, {}};
    if (const auto* assembly = std::get_if<plan::AssemblyTask>(&task.form)) return makeAssembly(*assembly, scene);
    const auto& pair = std::get<plan::DiscriminationPairTask>(task.form);
    return Pair{std::llround(pair.answer / kTickSeconds), comparisonInterval(attempt_seed), {}};
}

TrialRule::Assembly TrialRule::makeAssembly(const plan::AssemblyTask& task, const scene::SceneSpec& scene) {
    const std::vector<scene::AssemblyStep>& steps = scene.effects.pick.steps;
    std::vector<std::optional<double>> free_paths(steps.size());
    for (std::size_t i = 0; i < std::min(steps.size(), task.steps.size()); ++i) free_paths[i] = task.steps[i].free_path;
    return {std::move(free_paths), measures::AssemblyWatch(scene),
            measures::HintWatch(steps, std::llround(task.hint_after / kTickSeconds)),
            std::vector<std::int64_t>(steps.size(), 0)};
}

std::optional<TrialState> TrialRule::follow(const TickRecord& record, std::span<const TickRecord* const> hands,
                                            std::int64_t time, std::vector<TrialEvent>& events) {
    return std::visit(
        [&](auto& form) -> Verdict {
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(form)>, Assembly>)
                return judge(form, hands, time, events);
            else
                return judge(form, record, time, events);
        },
        form_);
}

void TrialRule::await(std::span<const TickRecord* const> hands, std::int64_t time) {
    std::vector<measures::StepChange> unasked;
    if (auto* assembly = std::get_if<Assembly>(&form_)) assembly->watch.follow(hands, time, unasked);
}

TrialRule::Verdict TrialRule::judge(Insertion& form, const TickRecord& record, std::int64_t time,
                                    std::vector<TrialEvent>& events) const {
    if (!form.engaged &&
        measures::tipDepthInBore(record, X_WT_.inverse(), form.task.clearance) >= form.task.engagement_depth) {
        form.engaged = true;
        events.push_back({time, "engaged"});
    }
    return form.rule.fulfilledAt(record) ? Verdict(TrialState::Succeeded) : std::nullopt;
}

TrialRule::Verdict TrialRule::judge(Passage& form, const TickRecord& record, std::int64_t time,
                                    std::vector<TrialEvent>& events) const {
    const std::int64_t entries = form.watch.entries();
    form.watch.follow(record);
    if (form.watch.entries() > entries) events.push_back({time, "passage_entered"});
    return form.watch.through() ? Verdict(TrialState::Succeeded) : std::nullopt;
}

TrialRule::Verdict TrialRule::judge(Contour& form, const TickRecord& record, std::int64_t,
                                    std::vector<TrialEvent>&) const {
    form.watch.follow(record);
    return form.watch.progress() >= form.coverage ? Verdict(TrialState::Succeeded) : std::nullopt;
}

TrialRule::Verdict TrialRule::judge(Placement& form, const TickRecord& record, std::int64_t,
                                    std::vector<TrialEvent>&) const {
    if ((form.buttons.pressedIn(record) & ~form.task.other_buttons) == 0) return std::nullopt;
    const auto error = measures::placementError(record, X_WT_, form.task.round);
    const bool there = error.position <= form.task.position_tolerance && error.angle <= form.task.angle_tolerance;
    return there ? TrialState::Succeeded : TrialState::Failed;
}

TrialRule::Verdict TrialRule::judge(Pair& form, const TickRecord& record, std::int64_t time,
                                    std::vector<TrialEvent>& events) const {
    using Phase = measures::PairWatch::Phase;
    const Phase before = form.watch.phase();
    form.watch.follow(record, time);
    const Phase now = form.watch.phase();
    if (now != before) {
        if (now == Phase::Between || now == Phase::Question) events.push_back({time, "interval_ended"});
        if (now == Phase::Second) events.push_back({time, "interval_started"});
        if (now == Phase::Answered) return TrialState::Succeeded;
    }
    const std::int64_t waited = time - form.watch.since();
    if (now == Phase::Between && waited >= kWayBackLimit) return TrialState::Aborted;
    if (now == Phase::Question && waited >= form.answer_periods) return TrialState::TimedOut;
    return std::nullopt;
}

TrialRule::Verdict TrialRule::judge(Assembly& form, std::span<const TickRecord* const> hands, std::int64_t time,
                                    std::vector<TrialEvent>& events) {
    using What = measures::StepChange::What;
    if (!form.start) form.start = time;
    std::vector<measures::StepChange> changes;
    form.watch.follow(hands, time, changes);
    for (const measures::StepChange& change : changes) {
        const char* name = change.what == What::State        ? "step_state"
                           : change.what == What::LetGo      ? "part_let_go"
                           : change.what == What::OrderError ? "order_error"
                                                             : "step_undone";
        events.push_back({time, name, change});
    }
    if (form.hints.follow(time, form.watch.done())) {
        const std::size_t step = *form.hints.shown();
        ++form.hinted[step];
        events.push_back({time, "hint_shown", measures::StepChange{.step = step, .what = What::Hint}});
    }
    return form.watch.allDone() ? Verdict(TrialState::Succeeded) : std::nullopt;
}

void TrialRule::describe(measures::TrialContext& context) const {
    if (const auto* insertion = std::get_if<Insertion>(&form_)) {
        context.engagement_depth = insertion->task.engagement_depth;
        context.clearance = insertion->task.clearance;
    } else if (const auto* passage = std::get_if<Passage>(&form_)) {
        context.form = passage->facts;
    } else if (const auto* contour = std::get_if<Contour>(&form_)) {
        context.form = contour->facts;
    } else if (const auto* placement = std::get_if<Placement>(&form_)) {
        context.form = measures::PlacementFacts{placement->task.round};
    } else if (const auto* assembly = std::get_if<Assembly>(&form_)) {
        std::vector<measures::StepResult> steps = assembly->watch.results(assembly->start.value_or(0));
        for (std::size_t i = 0; i < steps.size(); ++i) {
            steps[i].free_path = assembly->free_paths[i];
            steps[i].hints = assembly->hinted[i];
        }
        context.form = measures::AssemblyFacts{std::move(steps)};
    } else {
        context.form = measures::PairFacts{std::get<Pair>(form_).comparison_interval};
        context.leave_radius = std::numeric_limits<double>::infinity();  // nothing is carried anywhere
    }
}

}  // namespace passung::session
