#include "study/protocol/condition_extras.h"

#include <fmt/format.h>

#include <array>

#include "study/protocol/table_reader.h"

namespace passung::protocol {
namespace {

template <class Enum, std::size_t n>
Enum named(const std::array<const char*, n>& names, const std::string& name) {
    for (std::size_t i = 0; i < n; ++i)
        if (name == names[i]) return static_cast<Enum>(i);
    return {};
}

void readFeedback(const Node& table, plan::Condition& condition, Errors& errors) {
    const TableReader read(table, {"feedback"}, "feedback", errors);
    condition.scene.display_wrench = read.boolean("kinesthetic");
    condition.shown = read.text("shown_pose") == "device" ? plan::ShownPose::Device : plan::ShownPose::Proxy;
    condition.shows_scene = read.boolean("scene");
    for (const plan::ShownResult result : {plan::ShownResult::Outcome, plan::ShownResult::Time})
        if (read.text("result") == plan::shownResultName(result)) condition.result = result;
    plan::Cues& cues = condition.cues;
    cues.masking_noise = read.boolean("masking_noise");
    cues.full_depth = read.number("cue_full_depth_mm");
    cues.full_speed = read.number("cue_full_speed_mm_per_s");
    cues.sound_decay = read.number("cue_sound_decay_ms");
    for (const Node& item : read.items("cues")) {
        bool* cue = item.text == "visual"         ? &cues.visual
                    : item.text == "vibrotactile" ? &cues.vibrotactile
                    : item.text == "audio"        ? &cues.audio
                                                  : nullptr;
        if (cue == nullptr || *cue)
            errors.push_back(
                errorAt(item.place, "feedback.cues", valueText(item),
                        cue == nullptr ? "must be \"visual\", \"vibrotactile\" or \"audio\"" : "is listed twice"));
        else
            *cue = true;
    }
    if (!condition.shows_scene && cues.visual)
        read.fail("scene", "must be true with the cue \"visual\": it colours the held part, which is not drawn");
}

void readSecondary(const Node& table, plan::Condition& condition, Errors& errors) {
    const std::size_t before = errors.size();
    const TableReader read(table, {"secondary"}, "secondary", errors);
    plan::SecondaryTask& task = condition.secondary;
    task.stimulus = named<plan::Stimulus>(plan::kStimulusNames, read.text("stimulus"));
    task.least_interval = read.number("interval_min_s");
    task.most_interval = read.number("interval_max_s");
    task.duration = read.number("stimulus_ms");
    task.earliest = read.number("response_min_ms");
    task.latest = read.number("response_max_ms");
    task.button = static_cast<int>(read.integer("button"));
    if (errors.size() > before || !task.any()) return;
    if (task.most_interval < task.least_interval) read.fail("interval_max_s", "must be at least interval_min_s");
    if (!(task.earliest < task.latest)) read.fail("response_min_ms", "must be less than response_max_ms");
    // Else a press could answer either of two.
    if (!(task.latest <= task.least_interval))
        read.fail("response_max_ms",
                  fmt::format("must be at most interval_min_s, {:.6g} ms: a response belongs to one stimulus",
                              1e3 * task.least_interval));
    if (!(task.duration <= task.least_interval))
        read.fail("stimulus_ms", fmt::format("must be at most interval_min_s, {:.6g} ms", 1e3 * task.least_interval));
    if (task.stimulus == plan::Stimulus::Audio && condition.cues.masking_noise)
        read.fail("stimulus", "cannot be heard with feedback.masking_noise = true");
    if (std::holds_alternative<plan::FreePlacementTask>(condition.task.form))
        read.fail("stimulus", "is not for free_placement: any button confirms the placement");
    if (std::holds_alternative<plan::DiscriminationPairTask>(condition.task.form) && task.button <= 2)
        read.fail("button", "must be 3 or above: the first two answer the pair");
}

/// The buttons of the first hand's effects, which answer nothing.
void checkButtons(const Node& scene, plan::Condition& condition, Errors& errors) {
    const scene::Navigation& navigation = condition.scene.effects.navigation;
    const bool pair = std::holds_alternative<plan::DiscriminationPairTask>(condition.task.form);
    const auto check = [&](const char* effect, int button) {
        if (button == 0) return;
        if (auto* placement = std::get_if<plan::FreePlacementTask>(&condition.task.form))
            placement->other_buttons |= 1u << (button - 1);
        const char* problem = pair && button <= 2 ? "must be 3 or above: the first two answer the pair"
                              : condition.secondary.any() && button == condition.secondary.button
                                  ? "is that of the secondary task"
                                  : nullptr;
        if (problem == nullptr) return;
        const Node* at = &scene;
        for (const char* key : {"effects", effect, "button"})
            if (const Node* inner = at->find(key)) at = inner;
        errors.push_back(
            errorAt(at->place, fmt::format("scene.effects.{}.button", effect), std::to_string(button), problem));
    };
    check("clutch", navigation.clutch.button);
    check("position_scale", navigation.second_scale.button);
}

}  // namespace

void readConditionExtras(const StudyTables& tables, plan::Condition& condition, Errors& errors) {
    readFeedback(tables.feedback, condition, errors);
    readSecondary(tables.secondary, condition, errors);
    checkButtons(tables.scene, condition, errors);
    // The table's other keys are the task reader's: looked up without a reader of its own.
    const Node* timed_by = tables.task.find("timed_by");
    if (timed_by == nullptr) return;
    condition.timed_by = named<plan::TimedBy>(plan::kTimedByNames, timed_by->text);
    if (condition.timed_by != plan::TimedBy::Program && condition.scene.display_wrench)
        errors.push_back(errorAt(timed_by->place, "task.timed_by", valueText(*timed_by),
                                 "needs feedback.kinesthetic = false: nothing may be rendered in such a trial"));
}

}  // namespace passung::protocol
