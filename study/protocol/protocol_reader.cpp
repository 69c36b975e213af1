#include "study/protocol/protocol_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "study/protocol/analysis_reader.h"
#include "study/protocol/block_reader.h"
#include "study/protocol/condition_extras.h"
#include "study/protocol/consent_reader.h"
#include "study/protocol/duration.h"
#include "study/protocol/factors.h"
#include "study/protocol/include.h"
#include "study/protocol/measures_reader.h"
#include "study/protocol/plan_contents.h"
#include "study/protocol/plan_json.h"
#include "study/protocol/plan_warnings.h"
#include "study/protocol/planned_questionnaires.h"
#include "study/protocol/scene_node.h"
#include "study/protocol/session_rules.h"
#include "study/protocol/staircase_reader.h"
#include "study/protocol/start_pose.h"
#include "study/protocol/task_reader.h"
#include "study/protocol/texts_reader.h"
#include "study/protocol/trial_types.h"

namespace passung::protocol {
namespace {

constexpr std::size_t kMaxConditions = 1000;

/// Everything of a condition that can be felt or seen, as text; names of parts are none of it.
std::string fingerprint(Condition condition) {
    std::string meshes;
    if (condition.comparison)
        for (auto& part : condition.comparison->parts)
            if (const auto* mesh = std::get_if<model::MeshFile>(&part.geometry)) meshes += mesh->path + '\n';
    for (std::size_t i = 0; i < condition.scene.parts.size(); ++i) {
        auto& part = condition.scene.parts[i];
        if (part.name == condition.task.target) condition.task.target = std::to_string(i);
        part.name.clear();
        // In full: files of one name in two folders differ.
        if (const auto* mesh = std::get_if<model::MeshFile>(&part.geometry)) meshes += mesh->path + '\n';
    }
    return paramsJson(condition) + meshes;
}

/// Reads one study file, step by step; every step adds to errors_. A step is left out only if what it would say follows
/// from an error that is known already.
class ProtocolReader {
public:
    ProtocolReader(const Node& document, std::span<const DeviceDescription> devices,
                   std::span<const std::string> known_measures)
        : document_(document),
          devices_(devices),
          known_measures_(known_measures),
          root_(document, {"protocol"}, "", errors_) {}

    /// The plan as far as it can be read; complete if there are no errors.
    Examined read() {
        const bool study = isSound([&] { readStudy(); });
        readConditions();
        const bool blocks = isSound([&] { readBlockTables(); });
        const bool staircases = isSound([&] {
            staircases_ = readStaircases(root_.items("staircase"), root_.items("block"), factors_, known_measures_,
                                         plan_.blocks, errors_);
        });
        plan_.questionnaires = readQuestionnaires(root_.items("questionnaire"), plan_.blocks, errors_);
        readLoop();
        plan_.resume = readResume(root_, errors_);
        plan_.consent = readConsent(root_, errors_);
        readTexts(root_, plan_, errors_);
        const bool expands = levels_sound_ && !plan_.conditions.empty() && !plan_.blocks.empty();
        const bool design = expands && study && blocks && staircases &&
                            isSound([&] { checkBlocks(root_.items("block"), plan_, errors_); });
        if (expands) readBlockConditions();
        // A block may have another type of trial than the rest.
        plan_.measures = readMeasures(root_, tasks_sound_ ? &plan_ : nullptr, known_measures_, errors_);
        plan_.analyses = readAnalyses(root_.items("analysis"), plan_, errors_);
        if (expands && staircases) readStaircaseConditions();
        if (design && tasks_sound_) checkDuration();
        if (!root_.has("measures")) dropUnused();
        plan_.meshes = meshesOf(plan_, document_.place.file);
        plan_.stable_stiffness = stableStiffnessOf(plan_, devices_);
        tidy(errors_);
        if (errors_.empty()) {
            plan_.warnings = conditionWarnings(std::span(plan_.conditions).first(plannedConditions(plan_)));
            for (std::string& warning : blockWarnings(plan_)) plan_.warnings.push_back(std::move(warning));
            plan_.expanded_json = expandedJson(plan_);
        }
        return {std::move(plan_), std::move(errors_)};
    }

private:
    /// Does the step find nothing wrong?
    template <class Step>
    bool isSound(Step step) {
        const std::size_t before = errors_.size();
        step();
        return errors_.size() == before;
    }

    void readStudy() {
        const Node* table = root_.node("study");
        if (table == nullptr) return;
        const TableReader read(*table, {"study"}, "study", errors_);
        plan_.name = read.text("name");
        plan_.version = read.text("version");
        plan_.title = read.has("title") ? read.text("title") : plan_.name;
        plan_.seed = static_cast<std::uint64_t>(read.integer("seed"));
        plan_.participants = static_cast<int>(read.integer("participants"));
        plan_.max_session = 60.0 * read.number("max_session_minutes");
        plan_.allocation_blocks = static_cast<int>(read.integer("allocation_blocks"));
    }

    /// nullptr if there is none that can be read.
    const Node* findScene() {
        const Node* table = root_.node("scene");
        if (table == nullptr) return nullptr;
        for (const Entry& entry : table->entries) {
            if (entry.key != "file") continue;
            errors_.push_back(errorAt(entry.place, "scene.file", valueText(entry.value),
                                      "a study holds its scene itself, so that the stored text is all of it"));
            return nullptr;
        }
        return table;
    }

    void readConditions() {
        const Node* scene = findScene();
        levels_sound_ = isSound([&] { factors_ = readFactors(root_.items("factor"), known_measures_, errors_); });
        std::size_t count = 1;
        for (const auto& factor : factors_) {
            plan_.factors.push_back(factor.factor);
            count = std::min(count * std::max<std::size_t>(1, factor.factor.levels.size()), kMaxConditions + 1);
        }
        if (count > kMaxConditions)
            return root_.fail("factor", fmt::format("more than {} combinations of levels", kMaxConditions));
        std::vector<Exclusion> exclusions;
        const bool excluded =
            isSound([&] { exclusions = readExclusions(root_.items("exclude"), plan_.factors, errors_); });
        levels_sound_ = levels_sound_ && excluded;
        if (scene == nullptr) return;
        const std::size_t before = errors_.size();
        for (auto& levels : combinations(factors_))
            if (!isExcluded(exclusions, levels)) readCondition(*scene, std::move(levels), nullptr);
        plan_.shared_conditions = plan_.conditions.size();
        if (!levels_sound_ || errors_.size() > before) return;
        if (plan_.conditions.empty()) root_.fail("exclude", "leaves no condition");
        checkDistinct();
    }

    /// Blocks with a `set` have conditions of their own: the shared ones with the keys that the block changes.
    void readBlockConditions() {
        const Node* scene = root_.node("scene");
        const auto& tables = root_.items("block");
        for (std::size_t b = 0; b < tables.size() && scene != nullptr; ++b) {
            const Node* set = tables[b].find("set");
            if (set == nullptr || tables[b].find("name") == nullptr) continue;
            for (const Entry& entry : set->entries)
                for (const auto& factor : factors_)
                    for (const auto& level : factor.overrides)
                        for (const Override& change : level)
                            if (overlap(change.path, entry.key))
                                errors_.push_back(errorAt(
                                    entry.place, "block." + plan_.blocks[b].name + ".set", entry.key,
                                    fmt::format("is changed by factor {}, whose level would win", factor.factor.name)));
            if (plan_.conditions.size() + plan_.shared_conditions > kMaxConditions)
                return root_.fail("block",
                                  fmt::format("more than {} conditions with those that blocks change", kMaxConditions));
            plan_.blocks[b].first_condition = plan_.conditions.size();
            for (std::size_t c = 0; c < plan_.shared_conditions; ++c)
                readCondition(*scene, plan_.conditions[c].levels, &tables[b]);
        }
    }

    /// Every level of a staircase in place of every condition of its block, so that each is looked at before the first
    /// participant, and a level is the same scene whenever it comes.
    void readStaircaseConditions() {
        const Node* scene = root_.node("scene");
        const std::size_t planned = plan_.conditions.size();
        if (scene == nullptr || staircases_.empty()) return;
        for (StaircaseContent& content : staircases_) {
            Staircase& staircase = content.staircase;
            const Block& block = plan_.blocks[staircase.block];
            const Node* own = block.first_condition > 0 ? &root_.items("block")[staircase.block] : nullptr;
            for (std::size_t c = 0; c < plan_.shared_conditions; ++c) {
                staircase.first_variant.push_back(plan_.conditions.size());
                for (std::size_t level = 0; level < staircase.levels.size(); ++level) {
                    const Override step = content.change(level);
                    readCondition(*scene, plan_.conditions[c].levels, own, &step,
                                  fmt::format("@{}={:.6g}", staircase.name, staircase.levels[level]));
                    plan_.conditions.back().stimulus = {plan_.staircases.size(), step.value->number};
                }
            }
            if (tasks_sound_) checkMeasure(content);
            plan_.staircases.push_back(std::move(staircase));
        }
        if (plan_.conditions.size() > kMaxConditions)
            root_.fail("staircase", fmt::format("levels make more than {} conditions", kMaxConditions));
        plan_.first_variant = planned;
    }

    /// A measure that no trial of the type has would never answer.
    void checkMeasure(const StaircaseContent& content) {
        const Block& block = plan_.blocks[content.staircase.block];
        const TrialType* type = &typeOf(plan_.conditions[block.first_condition].task);
        const auto measures = measuresOf(std::span(&type, 1), known_measures_);
        if (std::find(measures.begin(), measures.end(), content.staircase.measure) == measures.end())
            errors_.push_back(errorAt(content.measure_place, "staircase." + content.staircase.name + ".measure",
                                      "\"" + content.staircase.measure + "\"",
                                      fmt::format("a trial of the type {} does not have it", type->name)));
    }

    /// Adds the condition of these levels; `block`: with the keys that this block sets, before the levels' own.
    /// `step`: the level that a staircase puts into it; `suffix`: what its name ends with then.
    void readCondition(const Node& scene, std::vector<std::size_t> levels, const Node* block,
                       const Override* step = nullptr, const std::string& suffix = {}) {
        const auto& factors = factors_;
        const auto copyOf = [&](std::string_view name) {
            const Node* table = root_.node(name);
            return table != nullptr ? *table : emptyTable(document_.place);
        };
        StudyTables tables{scene, copyOf("task"), copyOf("feedback"), copyOf("secondary")};
        Condition condition;
        if (block != nullptr)
            for (const Entry& entry : block->find("set")->entries)
                applyOverride({entry.key, entry.place, &entry.value}, tables, errors_);
        for (std::size_t i = 0; i < factors.size(); ++i) {
            for (const Override& change : factors[i].overrides[levels[i]]) applyOverride(change, tables, errors_);
            if (i > 0) condition.name += '/';
            condition.name += factors[i].factor.levels[levels[i]].label;
        }
        if (step != nullptr) applyOverride(*step, tables, errors_);
        if (factors.empty()) condition.name = "single";
        if (block != nullptr) condition.name += "@" + block->find("name")->text;
        condition.name += suffix;

        const std::size_t before = errors_.size();
        auto content = readSceneNode(tables.scene, {"scene"}, "scene", devices_, errors_);
        const Node* device = tables.scene.find("device");
        const bool names_device =
            device != nullptr && (device->kind != Node::Kind::Table || device->find("preset") != nullptr);
        if (!names_device)
            errors_.push_back(errorAt(device != nullptr ? device->place : tables.scene.place, "device.preset", "",
                                      "required in a study"));
        condition.scene = std::move(content.scene);
        condition.accuracy_budget = content.accuracy_budget;
        condition.accuracy_line = content.accuracy_place.line;
        condition.accuracy_column = content.accuracy_place.column;
        condition.allow_unstable = content.allow_unstable;
        condition.device = std::move(content.device);
        const bool task = content.parts_sound && isSound([&] {
                              if (root_.has("task")) condition.task = readTask(tables, &condition.scene, errors_);
                          });
        if (!content.parts_sound && root_.has("task")) readTask(tables, nullptr, errors_);
        tasks_sound_ = tasks_sound_ && task && root_.has("task");
        readConditionExtras(tables, condition, errors_);
        const bool pair = std::holds_alternative<DiscriminationPairTask>(condition.task.form);
        if (task && pair) condition.comparison = readComparison(tables, condition, devices_, errors_);
        if (content.sound) checkStartPose(tables.scene, "scene", condition.scene, errors_);
        if (errors_.size() == before && pair) checkStartPose(tables.scene, "scene", *condition.comparison, errors_);
        condition.levels_json = levelsJson(plan_.factors, levels);
        condition.levels = std::move(levels);
        if (errors_.size() == before) condition.params_json = paramsJson(condition);
        plan_.conditions.push_back(std::move(condition));
    }

    /// Two conditions that nobody can tell apart are one: a level that changes nothing.
    void checkDistinct() {
        std::map<std::string, const Condition*> seen;
        std::vector<bool> reported(plan_.factors.size());
        for (const Condition& condition : plan_.conditions) {
            const auto [twin, fresh] = seen.try_emplace(fingerprint(condition), &condition);
            if (fresh) continue;
            const Condition& first = *twin->second;
            const auto differ = std::mismatch(first.levels.begin(), first.levels.end(), condition.levels.begin()).first;
            const auto factor = static_cast<std::size_t>(differ - first.levels.begin());
            if (reported[factor]) continue;
            reported[factor] = true;
            errors_.push_back(
                errorAt(root_.items("factor")[factor].place, "factor." + plan_.factors[factor].name, "",
                        fmt::format("conditions \"{}\" and \"{}\" are the same in everything but their labels",
                                    first.name, condition.name)));
        }
    }

    void readBlockTables() {
        if (root_.has("block") && root_.items("block").empty()) root_.fail("block", "needs at least one block");
        plan_.blocks = readBlocks(root_.items("block"), plan_.factors, errors_);
    }

    void checkDuration() {
        const double seconds = longestSession(plan_);
        if (!(plan_.max_session > 0.0 && seconds > plan_.max_session)) return;
        const TableReader read(*root_.node("study"), {"study"}, "study", errors_);
        read.fail("max_session_minutes",
                  fmt::format("the trials of a session, each to its time-out, and the rests take {:.1f} min",
                              seconds / 60.0));
    }

    void readLoop() {
        const Node* table = root_.node("loop");
        const Node absent = emptyTable(document_.place);
        const TableReader read(table != nullptr ? *table : absent, {"loop"}, "loop", errors_);
        plan_.max_missed_share = read.number("max_missed_share");
    }

    /// Without a list a study stores every measure that it can have.
    void dropUnused() {
        const auto& conditions = plan_.conditions;
        if (std::any_of(conditions.begin(), conditions.end(), [](const auto& c) { return c.secondary.any(); })) return;
        std::erase_if(plan_.measures, [&](const std::string& name) {
            return name.starts_with("secondary_") &&
                   std::none_of(plan_.analyses.begin(), plan_.analyses.end(),
                                [&](const Analysis& analysis) { return analysis.outcome == name; });
        });
    }

    const Node& document_;
    std::span<const DeviceDescription> devices_;
    std::span<const std::string> known_measures_;
    Errors errors_;
    TableReader root_;
    StudyPlan plan_;
    bool levels_sound_ = true, tasks_sound_ = true;  // so far
    std::vector<FactorContent> factors_;
    std::vector<StaircaseContent> staircases_;
};

/// Without the files that the study names.
Examined examineText(const std::string& text, const std::string& path, std::span<const DeviceDescription> devices,
                     std::span<const std::string> known_measures) {
    const auto included = includeFiles(text, path);
    if (!included) return {{}, included.errors()};
    auto document = parseDocument(included->text, path);
    if (!document) {
        Error error = document.errors().front();
        Place place{path, error.line, error.column};
        relocate(*included, place);
        error.file = place.file;
        error.line = place.line;
        return {{}, {error}};
    }
    relocate(*included, *document);
    if (const auto other = otherKind(*document, FileKind::Study))
        return {{}, {errorAt(document->place, "", "", *other)}};
    Examined examined = ProtocolReader(*document, devices, known_measures).read();
    examined.plan.source_text = included->text;
    examined.plan.source_path = path;
    return examined;
}

}  // namespace

Examined examineProtocol(const std::string& path, std::span<const DeviceDescription> devices,
                         std::span<const std::string> known_measures) {
    const auto text = readFile(path);
    if (!text) return {{}, text.errors()};
    Examined examined = examineText(*text, path, devices, known_measures);
    const bool sound = examined.errors.empty();
    const auto add = [&](const Errors& errors) {
        examined.errors.insert(examined.errors.end(), errors.begin(), errors.end());
    };
    add(checkPictures(examined.plan, readFile));
    if (!sound) {
        add(checkQuestionnaires(examined.plan, readFile));
    } else if (!examined.plan.questionnaires.empty()) {
        if (const auto done = loadQuestionnaires(examined.plan, readFile); !done) add(done.errors());
    }
    return examined;
}

Result<StudyPlan> readProtocol(const std::string& path, std::span<const DeviceDescription> devices,
                               std::span<const std::string> known_measures) {
    Examined examined = examineProtocol(path, devices, known_measures);
    if (!examined.errors.empty()) return std::move(examined.errors);
    return std::move(examined.plan);
}

Result<StudyPlan> readProtocolText(const std::string& text, const std::string& path,
                                   std::span<const DeviceDescription> devices,
                                   std::span<const std::string> known_measures) {
    Examined examined = examineText(text, path, devices, known_measures);
    if (!examined.errors.empty()) return std::move(examined.errors);
    return std::move(examined.plan);
}

}  // namespace passung::protocol
