#include "study/protocol/task_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "study/plan/scene_parts.h"
#include "study/protocol/assembly_reader.h"
#include "study/protocol/peg_in_hole_reader.h"
#include "study/protocol/scene_node.h"
#include "study/protocol/trial_types.h"

namespace passung::protocol {
namespace {

constexpr double kWayBack = 2.0;  // [s] that returning to the start of a pair's second interval is reckoned with

/// The part that the task is about; nullptr after reporting why there is none.
const scene::PartSpec* findTarget(const TableReader& read, const scene::SceneSpec& scene) {
    const scene::PartSpec* part = plan::partNamed(scene, read.text("target"));
    if (part != nullptr && part != plan::heldPart(scene)) return part;
    if (part != nullptr) {
        read.fail("target", "must not be the held part");
        return nullptr;
    }
    std::vector<std::string_view> names;
    for (const auto& other : scene.parts) names.push_back(other.name);
    read.fail("target", fmt::format("the scene has no part of this name; parts: {}", fmt::join(names, ", ")));
    return nullptr;
}

/// Units of the scene's lengths; what is wrong with `unit` is reported where the scene is read.
double unitsOf(const StudyTables& tables) {
    Errors reported;
    return unitsPerMetre(TableReader(tables.scene, {"scene"}, "scene", reported), 1e3);
}

plan::ContourFollowingTask readContour(const TableReader& read, double units, Errors& errors) {
    plan::ContourFollowingTask contour;
    contour.reach = read.number("reach_mm");
    contour.coverage = read.number("coverage");
    contour.force = read.number("force_N");
    for (const Node& item : read.items("points")) {
        const bool numbers = item.kind == Node::Kind::List && item.items.size() == 3 &&
                             std::all_of(item.items.begin(), item.items.end(), [](const Node& x) {
                                 return x.kind == Node::Kind::Integer || x.kind == Node::Kind::Number;
                             });
        if (!numbers) {
            errors.push_back(
                errorAt(item.place, read.pathOf("points"), valueText(item), "a point must be a list of three numbers"));
            continue;
        }
        contour.points.emplace_back(item.items[0].number / units, item.items[1].number / units,
                                    item.items[2].number / units);
        if (contour.points.size() > 1 && contour.points.back() == contour.points[contour.points.size() - 2])
            errors.push_back(
                errorAt(item.place, read.pathOf("points"), valueText(item), "is the same point as the one before"));
    }
    if (read.items("points").size() < 2) read.fail("points", "needs at least two points");
    return contour;
}

plan::FreePlacementTask readPlacement(const TableReader& read, double units) {
    plan::FreePlacementTask placement;
    placement.X_WGoal = readPose(read, "position", "rotation_deg", units);
    placement.round = read.boolean("symmetric_about_z");
    placement.position_tolerance = read.number("position_tolerance_mm");
    placement.angle_tolerance = read.number("angle_tolerance_deg");
    return placement;
}

plan::DiscriminationPairTask readPair(const TableReader& read, const StudyTables& tables, const scene::SceneSpec& scene,
                                      Errors& errors) {
    plan::DiscriminationPairTask pair;
    pair.interval = read.number("interval_s");
    pair.answer = read.number("answer_s");
    pair.question = read.text("question");
    const auto judged = std::find(plan::kJudgedNames.begin(), plan::kJudgedNames.end(), read.text("judged"));
    if (judged != plan::kJudgedNames.end())
        pair.judged = static_cast<plan::Judged>(judged - plan::kJudgedNames.begin());
    if (read.has("comparison") && read.node("comparison")->entries.empty())
        read.fail("comparison", "names no key: both intervals would be the same");
    const scene::StartGate& gate = scene.start_gate;
    if (!(gate.hold_ticks > 0 && gate.position_tolerance > 0.0))
        errors.push_back(errorAt(tables.task.find("type")->place, "task.type", "discrimination_pair",
                                 "needs a start_gate with position_tolerance_mm and hold_ms > 0: between the intervals "
                                 "the hand comes back to the start"));
    return pair;
}

/// Keys of a table as paths: { contact = { mode = 1 } } and { "contact.mode" = 1 } say the same.
void flatten(const Node& table, const std::string& path, std::vector<Override>& overrides) {
    for (const Entry& entry : table.entries) {
        const std::string name = path.empty() ? entry.key : path + "." + entry.key;
        if (entry.value.kind == Node::Kind::Table)
            flatten(entry.value, name, overrides);
        else
            overrides.push_back({name, entry.place, &entry.value});
    }
}

/// Why an interval must not change this key of the scene; empty if it may.
std::string_view sharedByIntervals(const std::string& path, const scene::SceneSpec& scene) {
    for (const char* shared : {"device", "registration", "start_gate", "hand"})
        if (overlap(path, shared)) return "is one for both intervals";
    for (const scene::PartSpec& part : scene.parts) {
        const std::string own = "part." + part.name;
        for (const char* shared : {".held", ".hand"})
            if (overlap(path, own + shared)) return "is one for both intervals";
        for (const char* shared : {".shape", ".mesh", ".pose"})
            if (part.held && overlap(path, own + shared)) return "both intervals are felt with one part from one start";
    }
    if (path.starts_with("task.") || path.starts_with("feedback.") || path.starts_with("secondary."))
        return "must be a key of the scene";
    return "";
}

}  // namespace

bool isTaskKey(const std::string& type, const std::string& key) {
    const std::string own = "task." + type;
    const std::array<std::string_view, 2> tables{"task", own};
    return findKey(tables, key) != nullptr;
}

plan::Task readTask(const StudyTables& tables, scene::SceneSpec* scene, Errors& errors) {
    const std::size_t before = errors.size();
    plan::Task task;
    const Node* type = tables.task.find("type");
    const auto known = trialTypes();
    const auto found = std::find_if(known.begin(), known.end(), [&](const TrialType& candidate) {
        return type != nullptr && type->kind == Node::Kind::Text && candidate.name == type->text;
    });
    // Without a type no other key can be told right from wrong.
    if (found == known.end()) {
        Node alone = emptyTable(tables.task.place);
        if (type != nullptr) alone.entries.push_back({"type", type->place, *type});
        const TableReader read(alone, {"task"}, "task", errors);
        return task;
    }
    const TableReader read(tables.task, {"task", found->keys}, "task", errors);
    const bool own_sound = errors.size() == before;
    const bool placement = found->name == "free_placement", pair = found->name == "discrimination_pair";
    const bool assembly = found->name == "assembly";
    const scene::PartSpec* target =
        placement || assembly || scene == nullptr || !read.has("target") ? nullptr : findTarget(read, *scene);
    if (!own_sound || scene == nullptr) return task;
    if (!placement && !assembly) task.target = read.text("target");
    task.motion_bandwidth = read.number("motion_bandwidth_hz");
    if (!pair) task.timeout = read.number("timeout_s");
    if (!pair) task.leave_radius = read.number("leave_radius_mm");
    if (!assembly && scene->effects.snap.any() && scene->effects.picks())
        read.fail("type", "must be assembly with effects.snap and effects.pick: its steps say where parts belong");
    if (assembly) {
        task.form = readAssembly(read, tables, unitsOf(tables), *scene, errors);
    } else if (placement) {
        task.form = readPlacement(read, unitsOf(tables));
    } else if (pair) {
        const auto form = readPair(read, tables, *scene, errors);
        task.timeout = 2.0 * form.interval + form.answer + kWayBack;
        task.form = form;
    } else if (found->name == "contour_following") {
        task.form = readContour(read, unitsOf(tables), errors);
    } else if (found->name == "narrow_passage") {
        task.form = plan::NarrowPassageTask{read.number("passage_length_mm"), read.number("passage_width_mm")};
    } else {
        task.form = readPegInHole(read, tables, *scene, target, task, unitsOf(tables), errors);
    }
    return task;
}

scene::SceneSpec readComparison(const StudyTables& tables, const plan::Condition& condition,
                                const SceneReading& reading, Errors& errors) {
    const std::size_t before = errors.size();
    std::vector<Override> overrides;
    flatten(*tables.task.find("comparison"), "", overrides);
    StudyTables changed = tables;
    for (const Override& change : overrides) {
        const auto why = sharedByIntervals(change.path, condition.scene);
        if (!why.empty()) {
            errors.push_back(errorAt(change.path_place, "task.comparison", change.path, std::string(why)));
            continue;
        }
        Errors found;
        applyOverride(change, changed, found);
        for (Error& error : found) error.key = "task.comparison";
        errors.insert(errors.end(), found.begin(), found.end());
    }
    if (errors.size() > before) return {};
    auto content = readSceneNode(changed.scene, {"scene"}, "scene", reading, errors);
    if (content.accuracy_budget > 0.0)
        errors.push_back(errorAt(tables.task.find("type")->place, "task.type", "discrimination_pair",
                                 "needs an accuracy that is named: contact.accuracy must not be \"auto\""));
    content.scene.display_wrench = condition.scene.display_wrench;  // feedback is one for both intervals
    return std::move(content.scene);
}

}  // namespace passung::protocol
