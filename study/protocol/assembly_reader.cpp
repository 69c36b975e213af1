#include "study/protocol/assembly_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

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
        if (read.has("path_mm")) named.free_path = read.number("path_mm");
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
    if (read.has("hint_after_s")) assembly.hint_after = read.number("hint_after_s");
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
    if (pick.locks)
        errors.push_back(errorAt(tables.scene.find("effects")->find("pick")->find("let_go")->place,
                                 "scene.effects.pick.let_go", "\"lock\"",
                                 "must be \"leave\" in an assembly: its steps lock what is where it belongs"));
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

/// How far a hand is from reaching any place of a part of this size [m]; 0: it may.
double beyondReach(const scene::HandSpec& hand, const DeviceDescription& device, const Pose& X_WP, double longest) {
    if (hand.navigation.any()) return 0.0;
    const scene::Registration& r = hand.registration;
    const double far = (r.X_WB.inverse() * X_WP.p).norm() - longest - r.X_DH.p.norm();
    return std::max(0.0, far - device.workspace_radius_m * r.scale);
}

/// One condition's steps, in an order in which they may be done.
class StepsCheck {
public:
    StepsCheck(const StudyTables& tables, const plan::Condition& condition, std::span<const DeviceDescription> devices,
               PartGeometries& geometries, Errors& errors, std::vector<std::string>& warnings)
        : tables_(tables),
          items_(tables.task.find("step")->items),
          condition_(condition),
          scene_(condition.scene),
          devices_(devices),
          geometries_(geometries),
          errors_(errors),
          warnings_(warnings) {
        for (const scene::PartSpec& part : scene_.parts) X_WP_.push_back(part.X_WP);
    }

    void run() {
        const auto& steps = scene_.effects.pick.steps;
        for (const std::size_t i : scene::orderOf(steps)) {
            X_WP_[steps[i].part] = scene::goalOf(steps[i], X_WP_);
            checkReach(i);
        }
        for (std::size_t i = 0; i < steps.size(); ++i) {
            checkRoom(i);
            checkStarts(i);
            checkDrawn(i);
        }
        checkLeaving();
    }

private:
    const scene::AssemblyStep& step(std::size_t i) const { return scene_.effects.pick.steps[i]; }

    void checkReach(std::size_t i) {
        const scene::PartSpec& part = scene_.parts[step(i).part];
        const PartSurface* surface = geometries_.of(part);
        std::optional<double> least;
        for (std::size_t hand = 0; surface != nullptr && hand < scene_.handCount(); ++hand) {
            const std::string& name = hand == 0 ? condition_.device : condition_.other_devices[hand - 1];
            const auto device =
                std::find_if(devices_.begin(), devices_.end(), [&](const auto& known) { return known.name == name; });
            if (device == devices_.end()) return;  // told elsewhere
            if (!scene_.canPick(hand)) continue;
            const auto beyond = [&](const Pose& X) {
                return beyondReach(scene_.hand(hand), *device, X, surface->longest());
            };
            const double missing = std::max(beyond(part.X_WP), beyond(X_WP_[step(i).part]));
            least = std::min(least.value_or(missing), missing);
        }
        if (least && *least > kReachRounding)
            fail(i, fmt::format("no hand reaches both this and the part's start: {:.4g} mm are missing", 1e3 * *least));
    }

    /// At success all parts with a step are where they belong, beside those that rest.
    void checkRoom(std::size_t i) {
        const scene::PartSpec& part = scene_.parts[step(i).part];
        const double slack = slackOf(i);
        for (std::size_t other = 0; other < scene_.parts.size(); ++other) {
            if (!isThere(other, i)) continue;
            scene::PartSpec obstacle = scene_.parts[other];
            obstacle.X_WP = X_WP_[other];
            const double depth = depthAt(part, X_WP_[step(i).part], obstacle, geometries_);
            if (depth > slack)
                fail(i,
                     fmt::format("there part {} stands {:.4g} mm deep in part {}, more than the tolerance of {:.4g} mm",
                                 part.name, 1e3 * depth, obstacle.name, 1e3 * slack));
        }
    }

    /// A part that starts at a step's goal and moves is in the way until a hand has taken it.
    void checkStarts(std::size_t i) {
        const scene::PartSpec& part = scene_.parts[step(i).part];
        for (std::size_t other = 0; other < scene_.parts.size(); ++other) {
            const scene::PartSpec& obstacle = scene_.parts[other];
            if (other == step(i).part || !obstacle.moves() || isMovedBefore(other, i)) continue;
            if (depthAt(part, X_WP_[step(i).part], obstacle, geometries_) <= slackOf(i)) continue;
            std::string sentence = fmt::format(
                "the goal of step {} is where part {} starts, which must be taken away first; after does "
                "not say so",
                nameOf(i), obstacle.name);
            if (std::find(warnings_.begin(), warnings_.end(), sentence) == warnings_.end())
                warnings_.push_back(std::move(sentence));
        }
    }

    /// Who goes by what is drawn brings the part to where its goal is drawn.
    void checkDrawn(std::size_t i) {
        Vec3 off = scene_.parts[step(i).part].shown_offset;
        if (step(i).into != scene::AssemblyStep::kWorld) off -= scene_.parts[step(i).into].shown_offset;
        if (off.norm() <= step(i).position_tolerance) return;
        const Node& place = *items_[i].find("part");
        errors_.push_back(
            errorAt(place.place, "task.step.part", valueText(place),
                    fmt::format("is drawn {:.4g} mm beside where it is touched, as seen from its goal (shown_offset): "
                                "must be at most the step's position_tolerance_mm, {:.4g}",
                                1e3 * off.norm(), 1e3 * step(i).position_tolerance)));
    }

    /// Some hand has to leave the sphere about its start, or the completion time never begins.
    void checkLeaving() {
        double farthest = 0.0;
        for (std::size_t hand = 0; hand < scene_.handCount(); ++hand) {
            if (!scene_.canPick(hand)) continue;
            const std::size_t held = scene_.heldBy(hand);
            const Vec3 start =
                held < scene_.parts.size() ? scene_.parts[held].X_WP.p : scene_.hand(hand).start_gate.X_WH.p;
            for (const scene::AssemblyStep& asked : scene_.effects.pick.steps) {
                const PartSurface* surface = geometries_.of(scene_.parts[asked.part]);
                if (surface == nullptr) return;  // told elsewhere
                for (const Pose& X : {scene_.parts[asked.part].X_WP, X_WP_[asked.part]})
                    farthest = std::max(farthest, (X.p - start).norm() + surface->size.norm());
            }
        }
        if (!(condition_.task.leave_radius >= farthest)) return;
        const Node* place = tables_.task.find("leave_radius_mm");
        if (place == nullptr) return;
        errors_.push_back(errorAt(place->place, "task.leave_radius_mm", valueText(*place),
                                  fmt::format("no part of a step starts or belongs outside this sphere about a hand's "
                                              "start: must be less than {:.4g}",
                                              1e3 * farthest)));
    }

    double slackOf(std::size_t i) const { return std::max(scene_.contact.tolerance, step(i).position_tolerance); }

    std::string nameOf(std::size_t i) const { return std::get<plan::AssemblyTask>(condition_.task.form).steps[i].name; }

    bool isMovedBefore(std::size_t part, std::size_t i) const {
        const auto& steps = scene_.effects.pick.steps;
        scene::StepSet before = step(i).after, known = 0;
        while (before != known) {
            known = before;
            for (std::size_t k = 0; k < steps.size(); ++k)
                if ((known & scene::stepBit(k)) != 0) before |= steps[k].after;
        }
        for (std::size_t k = 0; k < steps.size(); ++k)
            if (steps[k].part == part && (before & scene::stepBit(k)) != 0) return true;
        return false;
    }

    /// Once for each pair of steps.
    bool isThere(std::size_t part, std::size_t i) const {
        if (!scene_.parts[part].moves()) return true;
        const auto& steps = scene_.effects.pick.steps;
        return std::any_of(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(i),
                           [part](const scene::AssemblyStep& other) { return other.part == part; });
    }

    void fail(std::size_t i, std::string message) {
        const Node& place = *items_[i].find("position");
        errors_.push_back(errorAt(place.place, "task.step.position", valueText(place), std::move(message)));
    }

    const StudyTables& tables_;
    const std::vector<Node>& items_;
    const plan::Condition& condition_;
    const scene::SceneSpec& scene_;
    std::span<const DeviceDescription> devices_;
    PartGeometries& geometries_;
    Errors& errors_;
    std::vector<std::string>& warnings_;
    std::vector<Pose> X_WP_;  // at the end of the step that puts it there
};

}  // namespace

void checkAssembly(const StudyTables& tables, const plan::Condition& condition,
                   std::span<const DeviceDescription> devices, PartGeometries& geometries, Errors& errors,
                   std::vector<std::string>& warnings) {
    StepsCheck(tables, condition, devices, geometries, errors, warnings).run();
}

}  // namespace passung::protocol
