#include "study/protocol/assembly_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "study/protocol/start_pose.h"

namespace passung::protocol {
namespace {

using scene::AssemblyStep;

std::string listed(const std::vector<std::string_view>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

/// One assembly's steps.
class StepsReader {
public:
    StepsReader(const std::vector<Node>& items, const std::string& path, double units, const scene::SceneSpec& scene,
                Errors& errors)
        : units_(units), scene_(scene), errors_(errors) {
        readers_.reserve(items.size());
        for (const Node& item : items)
            readers_.emplace_back(item, std::vector<std::string_view>{"task.step"}, path, errors);
    }

    /// In the order of the protocol.
    std::vector<AssemblyStep> steps;
    std::vector<plan::AskedStep> asked;

    void read() {
        const std::size_t before = errors_.size();
        if (readers_.size() > scene::kMostSteps)
            return readers_[scene::kMostSteps].fail("part", "is one step too many: an assembly has at most 63");
        for (const TableReader& read : readers_) readStep(read);
        for (std::size_t i = 0; i < readers_.size(); ++i) steps[i].after = stepsBefore(i);
        if (errors_.size() > before) return;
        for (const scene::StepProblem& problem : scene::problemsOf(steps, scene_))
            readers_[problem.step].fail(keyOf(problem.key), problem.message);
    }

private:
    void readStep(const TableReader& read) {
        AssemblyStep step;
        step.part = partOf(read, "part").value_or(0);
        if (read.has("into")) step.into = partOf(read, "into").value_or(AssemblyStep::kWorld);
        step.X_IGoal = readPose(read, "position", "rotation_deg", units_);
        step.position_tolerance = read.number("position_tolerance_mm");
        step.angle_tolerance = read.number("angle_tolerance_deg");
        step.folds = static_cast<int>(read.integer("symmetry"));
        step.locks = read.boolean("locks");
        plan::AskedStep named{read.has("name") ? read.text("name") : read.text("part"), read.number("insertion_mm"),
                              handOf(read)};
        for (const plan::AskedStep& other : asked)
            if (other.name == named.name) read.fail(read.has("name") ? "name" : "part", "is used by another step");
        steps.push_back(step);
        asked.push_back(std::move(named));
    }

    std::optional<std::size_t> partOf(const TableReader& read, const char* key) const {
        if (!read.has(key)) return std::nullopt;
        const std::string name = read.text(key);
        std::vector<std::string_view> names;
        for (std::size_t i = 0; i < scene_.parts.size(); ++i) {
            if (scene_.parts[i].name == name) return i;
            names.push_back(scene_.parts[i].name);
        }
        read.fail(key, "the scene has no part of this name; parts: " + listed(names));
        return std::nullopt;
    }

    std::size_t handOf(const TableReader& read) const {
        if (!read.has("hand")) return 0;
        std::vector<std::string_view> names;
        for (std::size_t i = 1; i < scene_.handCount(); ++i) {
            if (scene_.other_hands[i - 1].name == read.text("hand")) return i;
            names.push_back(scene_.other_hands[i - 1].name);
        }
        read.fail("hand", names.empty() ? "the scene has one hand"
                                        : "the scene has no such hand; further hands: " + listed(names));
        return 0;
    }

    scene::StepSet stepsBefore(std::size_t i) const {
        scene::StepSet before = 0;
        for (const Node& name : readers_[i].items("after")) {
            const auto found = std::find_if(asked.begin(), asked.end(),
                                            [&](const plan::AskedStep& step) { return step.name == name.text; });
            if (found != asked.end()) {
                before |= scene::stepBit(static_cast<std::size_t>(found - asked.begin()));
                continue;
            }
            std::vector<std::string_view> names;
            for (const plan::AskedStep& step : asked) names.push_back(step.name);
            errors_.push_back(errorAt(name.place, readers_[i].pathOf("after"), valueText(name),
                                      "no step has this name; steps: " + listed(names)));
        }
        return before;
    }

    static std::string_view keyOf(std::string_view key) {
        if (key == "position_tolerance") return "position_tolerance_mm";
        if (key == "angle_tolerance") return "angle_tolerance_deg";
        return key == "folds" ? "symmetry" : key;
    }

    double units_;
    const scene::SceneSpec& scene_;
    Errors& errors_;
    std::vector<TableReader> readers_;
};

}  // namespace

plan::AssemblyTask readAssembly(const TableReader& read, const StudyTables& tables, double units,
                                scene::SceneSpec& scene, Errors& errors) {
    plan::AssemblyTask assembly;
    assembly.hints = read.boolean("hints");
    if (!scene.effects.picks()) {
        errors.push_back(errorAt(tables.task.find("type")->place, "task.type", "\"assembly\"",
                                 "needs effects.pick: hands pick the parts up"));
        return assembly;
    }
    scene::Pick& pick = scene.effects.pick;
    if (read.has("undo_button")) pick.undo_button = static_cast<int>(read.integer("undo_button"));
    if (pick.undo_button == pick.button) read.fail("undo_button", "is that of effects.pick");
    for (std::size_t i = 0; i < scene.handCount(); ++i) {
        const scene::Navigation navigation = scene.hand(i).navigation;
        const bool taken =
            pick.undo_button == navigation.clutch.button || pick.undo_button == navigation.second_scale.button;
        if (pick.undo_button > 0 && taken) read.fail("undo_button", "is another effect's");
    }
    if (read.items("step").empty()) {
        read.fail("step", "needs at least one step");
        return assembly;
    }
    const std::size_t before = errors.size();
    StepsReader steps(read.items("step"), read.pathOf("step"), units, scene, errors);
    if (errors.size() > before) return assembly;
    steps.read();
    pick.steps = std::move(steps.steps);
    assembly.steps = std::move(steps.asked);
    return assembly;
}

namespace {

constexpr double kReachRounding = 1e-9;  // [m]

/// Where the step's part may be held: nobody can put a part where no point of it is within a hand's reach [m] beyond.
double beyondReach(const scene::HandSpec& hand, const DeviceDescription& device, const Pose& X_WP, double longest) {
    if (hand.navigation.any()) return 0.0;
    const scene::Registration& r = hand.registration;
    const double far = (r.X_WB.inverse() * X_WP.p).norm() - longest - r.X_DH.p.norm();
    return far - device.workspace_radius_m * r.scale;
}

}  // namespace

void checkAssembly(const StudyTables& tables, const plan::Condition& condition,
                   std::span<const DeviceDescription> devices, PartGeometries& geometries, Errors& errors) {
    const scene::SceneSpec& scene = condition.scene;
    const auto& steps = scene.effects.pick.steps;
    const auto& items = tables.task.find("step")->items;
    std::vector<Pose> X_WP;
    for (const scene::PartSpec& part : scene.parts) X_WP.push_back(part.X_WP);
    std::vector<bool> rests;
    for (const scene::PartSpec& part : scene.parts) rests.push_back(!part.moves());
    std::vector<scene::StepSet> before(steps.size());
    for (const std::size_t i : scene::orderOf(steps)) {
        const scene::AssemblyStep& step = steps[i];
        const scene::PartSpec& part = scene.parts[step.part];
        const Node& place = *items[i].find("position");
        const auto fail = [&](std::string message) {
            errors.push_back(errorAt(place.place, "task.step.position", valueText(place), std::move(message)));
        };
        X_WP[step.part] = scene::goalOf(step, X_WP);
        for (std::size_t other = 0; other < steps.size(); ++other)
            if ((step.after & scene::stepBit(other)) != 0) before[i] |= scene::stepBit(other) | before[other];
        const PartSurface* surface = geometries.of(part);
        if (surface == nullptr) continue;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t hand = 0; hand < scene.handCount(); ++hand) {
            const std::string& name = hand == 0 ? condition.device : condition.other_devices[hand - 1];
            const auto device =
                std::find_if(devices.begin(), devices.end(), [&](const auto& known) { return known.name == name; });
            if (device == devices.end() || !scene.canPick(hand)) continue;
            for (const Pose& X : {part.X_WP, X_WP[step.part]})
                least = std::min(least, beyondReach(scene.hand(hand), *device, X, surface->longest()));
        }
        if (least < std::numeric_limits<double>::infinity() && least > kReachRounding)
            fail(fmt::format("or its start is out of every hand's reach, by {:.4g} mm", 1e3 * least));
        const double slack = std::max(scene.contact.tolerance, step.position_tolerance);
        for (std::size_t other = 0; other < scene.parts.size(); ++other) {
            const auto places = [&](std::size_t s) {
                return steps[s].part == other && (before[i] & scene::stepBit(s));
            };
            bool is_there = rests[other];
            for (std::size_t s = 0; s < steps.size(); ++s) is_there = is_there || places(s);
            if (!is_there) continue;
            scene::PartSpec obstacle = scene.parts[other];
            obstacle.X_WP = X_WP[other];
            const double depth = depthAt(part, X_WP[step.part], obstacle, geometries);
            if (depth > slack)
                fail(fmt::format("there part {} stands {:.4g} mm deep in part {}, more than the tolerance of {:.4g} mm",
                                 part.name, 1e3 * depth, obstacle.name, 1e3 * slack));
        }
    }
}

}  // namespace passung::protocol
