#include "study/protocol/human_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <tuple>

#include "study/protocol/distinct_conditions.h"
#include "study/protocol/part_surface.h"
#include "study/protocol/scene_node.h"

namespace passung::protocol {
namespace {

constexpr double kReaction = 0.15;    // [s] of the fastest
constexpr double kFelt = 0.1;         // [s] that an interval lasts in which something can be told
constexpr double kComfortable = 0.5;  // [s] below: hardly
constexpr double kStillest = 1e-5;    // [m/s] that no hand falls below for a while
constexpr double kCalm = 5e-4;        // [m/s] below: hardly
constexpr double kExactest = 1e-6;    // [m]
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFinestTurn = 0.01 * kDegree;
constexpr double kFineTurn = 0.5 * kDegree;  // below: hardly
constexpr double kLongRest = 3600.0;         // [s]

class HumanCheck {
public:
    HumanCheck(const StudyTables& tables, const plan::Condition& condition, const DeviceDescription& device,
               const std::string& stepped, Errors& errors, std::vector<std::string>& warnings)
        : tables_(tables),
          condition_(condition),
          device_(device),
          stepped_(stepped),
          errors_(errors),
          warnings_(warnings) {}

    void run() {
        const bool pair = std::holds_alternative<plan::DiscriminationPairTask>(condition_.task.form);
        if (!pair && condition_.task.timeout < kReaction)
            fail("timeout_s",
                 fmt::format("nobody can do anything in that time: a reaction alone takes {} s", kReaction));
        std::visit([this](const auto& form) { check(form); }, condition_.task.form);
        const auto& gate = condition_.scene.start_gate;
        checkTurn(tables_.scene.find("start_gate"), "scene.start_gate", gate.angle_tolerance);
        checkPlace(tables_.scene.find("start_gate"), "scene.start_gate", gate.position_tolerance);
        if (condition_.secondary.any() && condition_.secondary.latest < kReaction)
            failAt(&tables_.secondary, "secondary", "response_max_ms",
                   fmt::format("nobody answers so fast: a reaction takes {} ms or more", 1e3 * kReaction));
    }

private:
    void check(const plan::NarrowPassageTask&) {}
    void check(const plan::ContourFollowingTask&) {}
    void check(const plan::AssemblyTask&) {}
    void check(const plan::PegInHoleTask& peg) {
        if (condition_.timed_by != plan::TimedBy::Program || !(peg.hold > 0.0)) return;
        if (peg.max_speed < kStillest)
            fail("max_speed_mm_per_s", fmt::format("no hand is so calm for hold_s: at least {} mm/s", 1e3 * kStillest));
        else if (peg.max_speed < kCalm)
            warn(
                fmt::format("task.max_speed_mm_per_s = {:.3g}: a hand trembles by some mm/s, so that the depth is "
                            "hardly held",
                            1e3 * peg.max_speed));
        if (peg.hold > condition_.task.timeout - kReaction && stepped_ != "task.timeout_s")
            fail("hold_s", fmt::format("leaves no time to get there before timeout_s: at most {:.4g} s",
                                       condition_.task.timeout - kReaction));
    }
    void check(const plan::FreePlacementTask& placement) {
        checkTurn(&tables_.task, "task", placement.angle_tolerance);
        checkPlace(&tables_.task, "task", placement.position_tolerance);
    }
    void check(const plan::DiscriminationPairTask& pair) {
        if (pair.interval < kFelt)
            fail("interval_s", fmt::format("nobody can tell what is felt in that time: at least {} s", kFelt));
        else if (pair.interval < kComfortable)
            warn(fmt::format("task.interval_s = {:.3g}: hardly anybody reaches and judges a surface in that time",
                             pair.interval));
        if (pair.answer < kReaction)
            fail("answer_s", fmt::format("nobody answers in that time: at least {} s", kReaction));
    }

    /// A handle that does not turn keeps every tolerance.
    void checkTurn(const Node* table, const char* path, double tolerance) {
        if (device_.sensed_degrees < 6 || !(tolerance > 0.0)) return;
        const double finest = std::max(kFinestTurn, condition_.scene.limits.rotational_quantum);
        if (tolerance < finest)
            failAt(table, path, "angle_tolerance_deg",
                   fmt::format("is finer than a hand on {} is turned: at least {:.2g} degrees", device_.name,
                               finest / kDegree));
        else if (tolerance < kFineTurn)
            warn(fmt::format("{}.angle_tolerance_deg = {:.3g}: hardly anybody turns a part so exactly", path,
                             tolerance / kDegree));
    }
    void checkPlace(const Node* table, const char* path, double tolerance) {
        if (tolerance > 0.0 && tolerance < kExactest)
            failAt(table, path, "position_tolerance_mm",
                   fmt::format("is finer than any hand: at least {} mm", 1e3 * kExactest));
    }

    void fail(const char* key, std::string message) { failAt(&tables_.task, "task", key, std::move(message)); }
    void failAt(const Node* table, const char* path, const char* key, std::string message) {
        const std::string name = fmt::format("{}.{}", path, key);
        if (name == stepped_ || name == "scene." + stepped_) return;
        const Node* value = table != nullptr ? table->find(key) : nullptr;
        const Node& at = value != nullptr ? *value : table != nullptr ? *table : tables_.task;
        errors_.push_back(errorAt(at.place, name, value != nullptr ? valueText(at) : "", std::move(message)));
    }
    void warn(std::string sentence) {
        if (std::find(warnings_.begin(), warnings_.end(), sentence) == warnings_.end())
            warnings_.push_back(std::move(sentence));
    }

    const StudyTables& tables_;
    const plan::Condition& condition_;
    const DeviceDescription& device_;
    const std::string& stepped_;
    Errors& errors_;
    std::vector<std::string>& warnings_;
};

/// Are both intervals one scene?
bool comparesTheSame(const plan::Condition& condition) {
    plan::Condition reference = condition, comparison = condition;
    comparison.scene = *condition.comparison;
    reference.comparison.reset();
    comparison.comparison.reset();
    return whatReaches(reference) == whatReaches(comparison);
}

/// Does a proxy under the same hand go the same way? What only a force follows from does not move it.
bool movesTheSame(const scene::ContactSpec& a, const scene::ContactSpec& b) {
    if (a.method != b.method || a.rendersAtHand() != b.rendersAtHand()) return false;
    if (a.rendersAtHand()) return true;
    const auto fields = [](const scene::ContactSpec& c) {
        return std::tie(c.geometry, c.tolerance, c.cell, c.spacing, c.mode, c.budget_nodes, c.quality, c.two_way,
                        c.proxy_filter);
    };
    const auto tool = [](const scene::ContactSpec& c) {
        return std::tie(c.coupling, c.variant, c.stiffness, c.rotational_stiffness, c.damping, c.rotational_damping,
                        c.area_stiffness, c.penalty_stiffness, c.tool_mass, c.tool_inertia);
    };
    return fields(a) == fields(b) && (a.method != scene::ContactMethod::Penalty || tool(a) == tool(b));
}

/// Does each proxy hang from the same hand as far?
bool hangsTheSame(const scene::SceneSpec& a, const scene::SceneSpec& b) {
    const auto hang = [](const scene::SceneSpec& scene, std::size_t hand) -> std::array<double, 5> {
        const std::size_t held = scene.heldBy(hand);
        const double density = held < scene.parts.size() ? scene.parts[held].density : 0.0;
        const Vec3 pull = density * scene.effects.weight.gravity;
        if (pull.isZero(0.0)) return {};
        return {pull.x(), pull.y(), pull.z(), scene.contact.stiffness, scene.contact.rotational_stiffness};
    };
    bool same = a.handCount() == b.handCount();
    for (std::size_t hand = 0; same && hand < a.handCount(); ++hand) same = hang(a, hand) == hang(b, hand);
    return same;
}

bool looksTheSame(const scene::SceneSpec& a, const scene::SceneSpec& b, plan::ShownPose shown) {
    const bool proxy = shown == plan::ShownPose::Proxy && !(a.contact.rendersAtHand() && b.contact.rendersAtHand());
    const auto alike = [&](const scene::PartSpec& x, const scene::PartSpec& y) {
        return geometryKey(x) == geometryKey(y) && x.X_WP.p == y.X_WP.p && x.X_WP.q.coeffs() == y.X_WP.q.coeffs() &&
               x.shown_offset == y.shown_offset &&
               (!proxy || (x.friction == y.friction && x.sliding_friction == y.sliding_friction));
    };
    return std::equal(a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(), alike) &&
           (!proxy || (movesTheSame(a.contact, b.contact) && hangsTheSame(a, b)));
}

bool isShownOrHeard(const plan::Cues& cues) { return cues.visual || cues.vibrotactile || cues.audio; }

}  // namespace

void checkHuman(const StudyTables& tables, const plan::Condition& condition, const DeviceDescription& device,
                const std::string& stepped, Errors& errors, std::vector<std::string>& warnings) {
    HumanCheck(tables, condition, device, stepped, errors, warnings).run();
}

void checkComparisons(const plan::StudyPlan& plan, const Node& task, Errors& errors) {
    std::vector<const plan::Condition*> pairs;
    for (const plan::Condition& condition : plan.conditions)
        if (condition.comparison) pairs.push_back(&condition);
    if (pairs.empty()) return;
    const Node* comparison = task.find("comparison");
    const auto fail = [&](std::string message) {
        errors.push_back(
            errorAt(comparison != nullptr ? comparison->place : task.place, "task.comparison", "", std::move(message)));
    };
    if (std::all_of(pairs.begin(), pairs.end(), [](const plan::Condition* pair) { return comparesTheSame(*pair); }))
        return fail("is the same as its reference in every pair: there is nothing to tell apart");
    for (const plan::Condition* pair : pairs)
        if (!pair->scene.display_wrench && !isShownOrHeard(pair->cues) &&
            (!pair->shows_scene || looksTheSame(pair->scene, *pair->comparison, pair->shown)))
            return fail(
                fmt::format("differs in nothing that is felt, seen or heard with feedback.kinesthetic = false "
                            "and no cue; condition: {}",
                            pair->name));
}

std::vector<std::string> restWarnings(const plan::StudyPlan& plan) {
    std::vector<std::string> warnings;
    for (const plan::Block& block : plan.blocks)
        if (block.rest > kLongRest)
            warnings.push_back(
                fmt::format("block.rest_s = {:.6g} keeps a person waiting for more than an hour; for "
                            "another day there is block.session; block: {}",
                            block.rest, block.name));
    return warnings;
}

}  // namespace passung::protocol
