#include "study/protocol/protocol_reader.h"
#include "study/protocol/assembly_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "core/base/regular_file.h"
#include "study/plan/duration.h"
#include "study/plan/plan_contents.h"
#include "study/plan/plan_warnings.h"
#include "study/protocol/analysis_reader.h"
#include "study/protocol/block_conditions.h"
#include "study/protocol/block_reader.h"
#include "study/protocol/body_way.h"
#include "study/protocol/condition_extras.h"
#include "study/protocol/consent_reader.h"
#include "study/protocol/distinct_conditions.h"
#include "study/protocol/factors.h"
#include "study/protocol/felt_features.h"
#include "study/protocol/human_limits.h"
#include "study/protocol/include.h"
#include "study/protocol/measures_reader.h"
#include "study/protocol/name_limits.h"
#include "study/protocol/plan_json.h"
#include "study/protocol/planned_questionnaires.h"
#include "study/protocol/reach.h"
#include "study/protocol/scene_node.h"
#include "study/protocol/session_rules.h"
#include "study/protocol/staircase_reader.h"
#include "study/protocol/start_pose.h"
#include "study/protocol/task_reader.h"
#include "study/protocol/texts_reader.h"
#include "study/protocol/trial_types.h"
#include "study/protocol/view_reader.h"
#include "study/protocol/weight_check.h"

namespace passung::protocol {
namespace {

constexpr std::size_t kMaxConditions = 1000;

/// What reading gives: see Examined. What keeps a study from being begun is apart, because one that once began goes on.
struct Read {
    plan::StudyPlan plan;
    Errors errors;
    Errors undoable;  // what a person could not do, feel or tell apart, and names
    Errors for_people;
};

/// Both kinds of errors count.
Examined examined(Read read) {
    read.errors.insert(read.errors.end(), read.undoable.begin(), read.undoable.end());
    tidy(read.errors);
    if (!read.errors.empty()) read.plan.warnings.clear();
    return {std::move(read.plan), std::move(read.errors), std::move(read.for_people)};
}

/// Reads one study file, step by step; every step adds to errors_. A step is left out only if what it would say follows
/// from an error that is known already.
class ProtocolReader {
public:
    ProtocolReader(const Node& document, std::span<const DeviceDescription> devices,
                   std::span<const std::string> known_measures, scene::BuildStore* builds, scene::Geometry automatic)
        : document_(document),
          devices_(devices),
          known_measures_(known_measures),
          root_(document, {"protocol"}, "", errors_),
          geometries_(builds),
          scenes_{devices, geometries_, automatic} {}

    /// The plan as far as it can be read; complete if there are no errors.
    Read read() {
        const bool study = isSound([&] { readStudy(); });
        checkNames(document_, undoable_);
        const bool few = readFactorTables();
        const bool blocks = isSound([&] { readBlockTables(); });
        staircases_sound_ = isSound([&] {
            staircases_ = readStaircases(root_.items("staircase"), root_.items("block"), factors_, known_measures_,
                                         plan_.blocks, errors_);
        });
        if (few) readConditions();
        plan_.questionnaires = readQuestionnaires(root_.items("questionnaire"), plan_.blocks, errors_);
        readLoop();
        plan_.resume = readResume(root_, errors_);
        plan_.view = readView(root_, errors_);
        plan_.consent = readConsent(root_, errors_, for_people_);
        readTexts(root_, plan_, errors_);
        const bool chosen = isSound([&] { chooseConditions(root_.items("block"), plan_.factors, plan_, errors_); });
        const bool expands = levels_sound_ && chosen && !plan_.conditions.empty() && !plan_.blocks.empty();
        const bool design = expands && study && blocks && staircases_sound_ &&
                            isSound([&] { checkBlocks(root_.items("block"), plan_, errors_); });
        if (expands) readBlockConditions();
        // A block may have another type of trial than the rest.
        plan_.measures = readMeasures(root_, tasks_sound_ ? &plan_ : nullptr, known_measures_, errors_);
        plan_.analyses = readAnalyses(root_.items("analysis"), plan_, staircaseNames(), errors_);
        plan_.data_rules = readDataRules(root_.items("exclude"), plan_, errors_);
        if (expands && staircases_sound_) readStaircaseConditions();
        if (expands && tasks_sound_ && staircases_sound_ && errors_.empty() && root_.node("task") != nullptr)
            checkComparisons(plan_, *root_.node("task"), undoable_);
        if (design && tasks_sound_) checkDuration();
        if (!root_.has("measures")) dropUnused();
        plan_.meshes = plan::meshesOf(plan_, document_.place.file);
        plan_.stable_stiffness = plan::stableStiffnessOf(plan_, devices_);
        tidy(errors_);
        tidy(undoable_);
        if (errors_.empty()) {
            plan_.warnings = plan::conditionWarnings(std::span(plan_.conditions).first(plan::plannedConditions(plan_)));
            for (std::string& warning : plan::blockWarnings(plan_, root_.has("measures")))
                plan_.warnings.push_back(std::move(warning));
            for (std::string& warning : plan::thresholdWarnings(plan_)) plan_.warnings.push_back(std::move(warning));
            for (std::string& warning : restWarnings(plan_)) plan_.warnings.push_back(std::move(warning));
            for (std::string& warning : warnings_)
                if (std::find(plan_.warnings.begin(), plan_.warnings.end(), warning) == plan_.warnings.end())
                    plan_.warnings.push_back(std::move(warning));
            plan_.expanded_json = expandedJson(plan_);
        }
        return {std::move(plan_), std::move(errors_), std::move(undoable_), std::move(for_people_)};
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

    /// False if there are too many combinations to go on.
    bool readFactorTables() {
        levels_sound_ = isSound([&] { factors_ = readFactors(root_.items("factor"), known_measures_, errors_); });
        std::size_t count = 1;
        for (const auto& factor : factors_) {
            plan_.factors.push_back(factor.factor);
            count = std::min(count * std::max<std::size_t>(1, factor.factor.levels.size()), kMaxConditions + 1);
        }
        if (count <= kMaxConditions) return true;
        root_.fail("factor", fmt::format("more than {} combinations of levels", kMaxConditions));
        return false;
    }

    void readConditions() {
        const Node* scene = findScene();
        std::vector<LevelPattern> exclusions;
        const bool excluded =
            isSound([&] { exclusions = readExclusions(root_.items("exclude"), plan_.factors, errors_); });
        levels_sound_ = levels_sound_ && excluded;
        if (scene == nullptr) return;
        const std::size_t before = errors_.size();
        const auto first = firstOfStaircase();
        for (auto& levels : combinations(factors_))
            if (!isExcluded(exclusions, levels))
                readCondition(*scene, std::move(levels), {nullptr, first ? &*first : nullptr, {}});
        plan_.shared_conditions = plan_.conditions.size();
        if (!levels_sound_ || errors_.size() > before) return;
        if (plan_.conditions.empty()) root_.fail("exclude", "leaves no condition");
        checkDistinct();
    }

    /// Where all that is shared is for staircases, the first level of the first one stands in what a condition is
    /// before any is presented: the study need not write a value that never comes.
    std::optional<Override> firstOfStaircase() const {
        if (!staircases_sound_) return std::nullopt;
        for (std::size_t b = 0; b < plan_.blocks.size() && b < root_.items("block").size(); ++b)
            if (!plan_.blocks[b].adaptive && root_.items("block")[b].find("set") == nullptr) return std::nullopt;
        for (const StaircaseContent& content : staircases_)
            if (root_.items("block")[content.staircase.block].find("set") == nullptr) return content.change(0);
        return std::nullopt;
    }

    /// Likewise in the own conditions of a block with a staircase.
    std::optional<Override> firstOfStaircase(std::size_t block) const {
        if (!staircases_sound_) return std::nullopt;
        for (const StaircaseContent& content : staircases_)
            if (content.staircase.block == block) return content.change(0);
        return std::nullopt;
    }

    /// Of the shared conditions those that the block has.
    std::vector<std::size_t> conditionsOf(const plan::Block& block) const {
        if (!block.conditions.empty()) return block.conditions;
        std::vector<std::size_t> all(plan_.shared_conditions);
        std::iota(all.begin(), all.end(), std::size_t{0});
        return all;
    }

    /// Blocks with a `set` have conditions of their own: those that they have of the shared ones with the keys that the
    /// block changes.
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
            const auto conditions = conditionsOf(plan_.blocks[b]);
            if (plan_.conditions.size() + conditions.size() > kMaxConditions)
                return root_.fail("block",
                                  fmt::format("more than {} conditions with those that blocks change", kMaxConditions));
            plan_.blocks[b].first_condition = plan_.conditions.size();
            const auto first = firstOfStaircase(b);
            const std::size_t before = errors_.size();
            for (const std::size_t c : conditions)
                readCondition(*scene, plan_.conditions[c].levels, {&tables[b], first ? &*first : nullptr, {}});
            nameBlock(before, plan_.blocks[b].name);
        }
    }

    /// Every level of a staircase in place of every condition of its block, so that each is looked at before the first
    /// participant, and a level is the same scene whenever it comes.
    void readStaircaseConditions() {
        const Node* scene = root_.node("scene");
        const std::size_t planned = plan_.conditions.size();
        if (scene == nullptr || staircases_.empty()) return;
        for (StaircaseContent& content : staircases_) {
            plan::Staircase& staircase = content.staircase;
            const plan::Block& block = plan_.blocks[staircase.block];
            const Node* own = block.first_condition > 0 ? &root_.items("block")[staircase.block] : nullptr;
            const std::size_t before = errors_.size();
            for (const std::size_t c : conditionsOf(block)) {
                staircase.first_variant.push_back(plan_.conditions.size());
                presented_ = &content;
                for (std::size_t level = 0; level < staircase.levels.size(); ++level) {
                    const Override step = content.change(level);
                    readCondition(*scene, plan_.conditions[c].levels,
                                  {own, &step, fmt::format("@{}={:.6g}", staircase.name, staircase.levels[level])});
                    plan_.conditions.back().stimulus = {plan_.staircases.size(), step.value->number};
                }
            }
            nameBlock(before, block.name);
            if (tasks_sound_) checkMeasure(content);
            if (references_.size() == 1) staircase.reference = *references_.begin();
            references_.clear();
            presented_ = nullptr;
            plan_.staircases.push_back(std::move(staircase));
        }
        if (plan_.conditions.size() > kMaxConditions)
            root_.fail("staircase", fmt::format("levels make more than {} conditions", kMaxConditions));
        plan_.first_variant = planned;
    }

    /// Says of the errors from `before` on whose trials they are about; what was said of all conditions is not said
    /// again.
    void nameBlock(std::size_t before, const std::string& block) {
        const auto first = errors_.begin() + static_cast<std::ptrdiff_t>(before);
        const Errors known(errors_.begin(), first);
        const auto same = [](const Error& a, const Error& b) {
            return a.file == b.file && a.line == b.line && a.column == b.column && a.key == b.key &&
                   a.value == b.value && a.message == b.message;
        };
        errors_.erase(std::remove_if(first, errors_.end(),
                                     [&](const Error& error) {
                                         return std::any_of(known.begin(), known.end(),
                                                            [&](const Error& other) { return same(error, other); });
                                     }),
                      errors_.end());
        for (std::size_t i = before; i < errors_.size(); ++i)
            errors_[i].message += fmt::format("; in the trials of block {}", block);
    }

    /// A measure that no trial of the type has would never answer.
    void checkMeasure(const StaircaseContent& content) {
        const plan::Block& block = plan_.blocks[content.staircase.block];
        const TrialType* type = &typeOf(plan_.conditions[block.first_condition].task);
        const auto measures = measuresOf(std::span(&type, 1), known_measures_);
        if (std::find(measures.begin(), measures.end(), content.staircase.measure) == measures.end())
            errors_.push_back(errorAt(content.measure_place, "staircase." + content.staircase.name + ".measure",
                                      "\"" + content.staircase.measure + "\"",
                                      fmt::format("a trial of the type {} does not have it", type->name)));
    }

    /// What a condition has beside its levels.
    struct Extra {
        const Node* block;     // with the keys that this block sets, before the levels' own; nullptr: none
        const Override* step;  // the level that a staircase puts into it; nullptr: none
        std::string suffix;    // what its name ends with
    };

    /// Adds the condition of these levels.
    void readCondition(const Node& scene, std::vector<std::size_t> levels, const Extra& extra) {
        const auto& [block, step, suffix] = extra;
        const auto& factors = factors_;
        const auto copyOf = [&](std::string_view name) {
            const Node* table = root_.node(name);
            return table != nullptr ? *table : emptyTable(document_.place);
        };
        StudyTables tables{scene, copyOf("task"), copyOf("feedback"), copyOf("secondary")};
        plan::Condition condition;
        if (block != nullptr)
            for (const Entry& entry : block->find("set")->entries)
                applyOverride({entry.key, entry.place, &entry.value}, tables, errors_);
        for (std::size_t i = 0; i < factors.size(); ++i) {
            for (const Override& change : factors[i].overrides[levels[i]]) applyOverride(change, tables, errors_);
            if (i > 0) condition.name += '/';
            condition.name += factors[i].factor.levels[levels[i]].label;
        }
        if (step != nullptr) applyOverride(*step, tables, errors_);
        if (block != nullptr) dropOtherTypes(*block, tables);
        if (factors.empty()) condition.name = "single";
        if (block != nullptr) condition.name += "@" + block->find("name")->text;
        condition.name += suffix;

        const std::size_t before = errors_.size();
        auto content = readSceneNode(tables.scene, {"scene"}, "scene", scenes_, errors_);
        const Node* device = tables.scene.find("device");
        const bool names_device =
            device != nullptr &&
            (device->kind != Node::Kind::Table || device->find("preset") != nullptr || device->find("kind") != nullptr);
        if (!names_device)
            errors_.push_back(errorAt(device != nullptr ? device->place : tables.scene.place, "device.preset", "",
                                      "required in a study"));
        condition.scene = std::move(content.scene);
        condition.accuracy_budget = content.accuracy_budget;
        condition.accuracy_line = content.accuracy_place.line;
        condition.accuracy_column = content.accuracy_place.column;
        condition.allow_unstable = content.allow_unstable;
        condition.device = std::move(content.device);
        condition.other_devices = std::move(content.other_devices);
        condition.needs = content.needs;
        const bool task = content.parts_sound && isSound([&] {
                              if (root_.has("task")) condition.task = readTask(tables, &condition.scene, errors_);
                          });
        if (!content.parts_sound && root_.has("task")) readTask(tables, nullptr, errors_);
        const Node* type = tables.task.find("type");
        if (condition.scene.effects.picks() && type != nullptr && type->text != "assembly")
            errors_.push_back(
                errorAt(tables.scene.find("effects")->find("pick")->place, "effects.pick", "",
                        "is for task.type = \"assembly\": no other type judges parts that are picked up"));
        tasks_sound_ = tasks_sound_ && task && root_.has("task");
        readConditionExtras(tables, condition, errors_);
        const bool pair = std::holds_alternative<plan::DiscriminationPairTask>(condition.task.form);
        if (task && pair) condition.comparison = readComparison(tables, condition, scenes_, errors_);
        // Of accuracy = "auto" nothing is picked with which something would not be felt.
        if (content.sound && !(content.accuracy_budget > 0.0))
            checkFelt(tables.scene, "scene", condition.scene, geometries_, undoable_, warnings_);
        if (condition.comparison && errors_.size() == before)
            checkFelt(tables.scene, "scene", *condition.comparison, geometries_, undoable_, warnings_);
        if (content.sound) checkWeight(tables.scene, "scene", condition.scene, geometries_, undoable_, warnings_);
        if (condition.comparison && errors_.size() == before)
            checkWeight(tables.scene, "scene", *condition.comparison, geometries_, undoable_, warnings_);
        warnOfTolerance(tables.scene, "scene", warnings_);
        if (content.sound) checkStartPose(tables.scene, "scene", condition.scene, geometries_, undoable_);
        if (errors_.size() == before && pair)
            checkStartPose(tables.scene, "scene", *condition.comparison, geometries_, undoable_);
        if (content.sound && task) checkDoable(tables, condition, step);
        condition.levels_json = levelsJson(plan_.factors, levels);
        condition.levels = std::move(levels);
        if (errors_.size() == before) condition.params_json = paramsJson(condition);
        plan_.conditions.push_back(std::move(condition));
    }

    /// What a person's hand, on this device, and judgement could not do.
    void checkDoable(const StudyTables& tables, const plan::Condition& condition, const Override* step) {
        const auto device = std::find_if(devices_.begin(), devices_.end(),
                                         [&](const auto& known) { return known.name == condition.device; });
        if (device != devices_.end() && root_.has("task")) {
            const std::size_t before = undoable_.size();
            if (std::holds_alternative<plan::AssemblyTask>(condition.task.form))
                checkAssembly(tables, condition, devices_, geometries_, undoable_, warnings_);
            checkReach(tables, condition, *device, geometries_, undoable_, warnings_);
            if (undoable_.size() == before) checkBody(tables, condition, *device, geometries_, undoable_);
            checkHuman(tables, condition, *device, step != nullptr ? step->path : "", undoable_, warnings_);
        }
        if (step != nullptr && presented_ != nullptr) compareWithReference(tables.scene, condition, *step);
    }

    /// What a key of the scene is in the interval that is not the comparison; nothing if it is not known here.
    static std::optional<double> referenceOf(const Node& scene, const scene::ContactSpec& contact,
                                             const std::string& key) {
        if (const Node* written = numberAt(scene, key)) return written->number;
        if (key == "contact.stiffness_N_per_m") return contact.stiffness;
        if (key == "contact.tolerance_um") return 1e6 * contact.tolerance;
        if (key == "contact.spacing_mm") return 1e3 * contact.spacing;
        return std::nullopt;
    }

    /// "Correct" is the more frequent the farther the comparison is from its reference: so levels have to begin there.
    void compareWithReference(const Node& scene, const plan::Condition& condition, const Override& step) {
        constexpr std::string_view kComparison = "task.comparison.";
        const plan::Staircase& staircase = presented_->staircase;
        if (staircase.measure != "correct" || !step.path.starts_with(kComparison)) return;
        const std::string key = step.path.substr(kComparison.size());
        const auto known = referenceOf(scene, condition.scene.contact, key);
        references_.insert(known);
        const double level = step.value->number, reference = known.value_or(level);
        if (staircase.above ? level >= reference : level <= reference) return;
        undoable_.push_back(errorAt(
            step.value->place, "staircase." + staircase.name, valueText(*step.value),
            fmt::format("is on the wrong side of the reference, {:.6g}: the higher the level, the {} often the answer "
                        "has to be correct, so that none is {} it",
                        reference, staircase.above ? "more" : "less", staircase.above ? "below" : "above")));
    }

    /// Where a block has trials of another type, the keys of [task] and of levels that only the study's own type has
    /// are not for them.
    void dropOtherTypes(const Node& block, StudyTables& tables) {
        const auto& set = block.find("set")->entries;
        const Node* task = root_.node("task");
        const Node* type = task != nullptr ? task->find("type") : nullptr;
        if (type == nullptr ||
            std::none_of(set.begin(), set.end(), [](const Entry& entry) { return entry.key == "task.type"; }))
            return;
        const Node* own = tables.task.find("type");
        std::erase_if(tables.task.entries, [&](const Entry& entry) {
            const bool of_block = std::any_of(set.begin(), set.end(), [&](const Entry& change) {
                return change.key == "task." + entry.key || change.key.starts_with("task." + entry.key + ".");
            });
            return !of_block && isTaskKey(type->text, entry.key) && !isTaskKey(own->text, entry.key);
        });
    }

    /// Two conditions that nobody can tell apart are one: a level that changes nothing.
    void checkDistinct() {
        std::map<std::string, const plan::Condition*> seen;
        std::vector<bool> reported(plan_.factors.size());
        for (const plan::Condition& condition : plan_.conditions) {
            const auto [twin, fresh] = seen.try_emplace(whatReaches(condition), &condition);
            if (fresh) continue;
            const plan::Condition& first = *twin->second;
            const auto differ = std::mismatch(first.levels.begin(), first.levels.end(), condition.levels.begin()).first;
            const auto factor = static_cast<std::size_t>(differ - first.levels.begin());
            if (reported[factor]) continue;
            reported[factor] = true;
            const std::string dead = deadFeedback(first, condition);
            const std::string alike =
                dead.empty() ? "are the same in everything but their labels" : "give a person the same: " + dead;
            undoable_.push_back(
                errorAt(root_.items("factor")[factor].place, "factor." + plan_.factors[factor].name, "",
                        fmt::format("conditions \"{}\" and \"{}\" {}", first.name, condition.name, alike)));
        }
    }

    void readBlockTables() {
        if (root_.has("block") && root_.items("block").empty()) root_.fail("block", "needs at least one block");
        plan_.blocks = readBlocks(root_.items("block"), plan_.factors, errors_);
    }

    std::vector<std::string> staircaseNames() const {
        std::vector<std::string> names;
        for (const StaircaseContent& content : staircases_) names.push_back(content.staircase.name);
        return names;
    }

    void checkDuration() {
        const double seconds = plan::longestSession(plan_);
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
                                [&](const plan::Analysis& analysis) { return analysis.outcome == name; });
        });
    }

    const Node& document_;
    std::span<const DeviceDescription> devices_;
    std::span<const std::string> known_measures_;
    Errors errors_;
    TableReader root_;
    plan::StudyPlan plan_;
    bool levels_sound_ = true, tasks_sound_ = true, staircases_sound_ = true;  // so far
    PartGeometries geometries_;
    SceneReading scenes_;
    std::vector<std::string> warnings_;           // about parts and ways
    StaircaseContent* presented_ = nullptr;       // whose levels are being read
    std::set<std::optional<double>> references_;  // of its conditions so far
    Errors undoable_;                             // see Read
    Errors for_people_;                           // likewise
    std::vector<FactorContent> factors_;
    std::vector<StaircaseContent> staircases_;
};

/// Without the files that the study names.
Read readText(const std::string& text, const std::string& path, std::span<const DeviceDescription> devices,
              std::span<const std::string> known_measures, scene::BuildStore* builds,
              scene::Geometry automatic = scene::Geometry::Auto) {
    const auto included = includeFiles(text, path);
    if (!included) return {{}, included.errors(), {}, {}};
    auto document = parseDocument(included->text, path);
    if (!document) {
        Error error = document.errors().front();
        TextPosition place{path, error.line, error.column};
        relocate(*included, place);
        error.file = place.file;
        error.line = place.line;
        return {{}, {error}, {}, {}};
    }
    relocate(*included, *document);
    if (const auto other = otherKind(*document, FileKind::Study))
        return {{}, {errorAt(document->place, "", "", *other)}, {}, {}};
    Read read = ProtocolReader(*document, devices, known_measures, builds, automatic).read();
    read.plan.source_text = included->text;
    read.plan.source_path = path;
    return read;
}

/// See checkNames(); a file that cannot be read is told of elsewhere.
Errors namesOfQuestionnaires(const plan::StudyPlan& plan) {
    Errors errors;
    const auto folder = std::filesystem::path(plan.source_path).parent_path();
    for (const plan::PlannedQuestionnaire& planned : plan.questionnaires)
        for (const std::string& file : {planned.file, planned.texts}) {
            const auto text = file.empty() ? Result<std::string>(std::string()) : readFile((folder / file).string());
            const auto document = text ? parseDocument(*text, (folder / file).string()) : Result<Node>(text.errors());
            if (document) checkNames(*document, errors);
        }
    tidy(errors);
    return errors;
}

}  // namespace

Examined examineProtocol(const std::string& path, std::span<const DeviceDescription> devices,
                         std::span<const std::string> known_measures, scene::BuildStore* builds) {
    const auto text = readFile(path);
    if (!text) return {{}, text.errors(), {}};
    Examined all = examined(readText(*text, path, devices, known_measures, builds));
    const bool sound = all.errors.empty();
    const auto add = [&](const Errors& errors) { all.errors.insert(all.errors.end(), errors.begin(), errors.end()); };
    add(checkPictures(all.plan, readFile));
    add(namesOfQuestionnaires(all.plan));
    if (!sound) {
        add(checkQuestionnaires(all.plan, readFile));
    } else if (all.plan.questionnaires.empty()) {
        add(checkScales(all.plan, {}));
    } else {
        if (const auto done = loadQuestionnaires(all.plan, readFile); !done) add(done.errors());
    }
    return all;
}

Result<plan::StudyPlan> readProtocol(const std::string& path, std::span<const DeviceDescription> devices,
                                     std::span<const std::string> known_measures, scene::BuildStore* builds) {
    Examined all = examineProtocol(path, devices, known_measures, builds);
    if (!all.errors.empty()) return std::move(all.errors);
    return std::move(all.plan);
}

Result<plan::StudyPlan> readProtocolText(const std::string& text, const std::string& path,
                                         std::span<const DeviceDescription> devices,
                                         std::span<const std::string> known_measures, scene::BuildStore* builds) {
    Examined all = examined(readText(text, path, devices, known_measures, builds));
    if (!all.errors.empty()) return std::move(all.errors);
    return std::move(all.plan);
}

Result<plan::StudyPlan> readBegunProtocol(const std::string& text, const std::string& path,
                                          std::span<const DeviceDescription> devices,
                                          std::span<const std::string> known_measures, scene::BuildStore* builds,
                                          scene::Geometry automatic) {
    Read read = readText(text, path, devices, known_measures, builds, automatic);
    if (!read.errors.empty()) return std::move(read.errors);
    return std::move(read.plan);
}

}  // namespace passung::protocol
