#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene_spec.h"
#include "study/design/design.h"
#include "study/plan/analysis.h"
#include "study/plan/block.h"
#include "study/plan/secondary_task.h"
#include "study/plan/staircase.h"
#include "study/plan/study_texts.h"
#include "study/plan/task.h"
#include "study/plan/view.h"
#include "study/questionnaire/definition.h"

namespace passung::plan {

using design::FactorKind;
const char* factorKindName(FactorKind kind);  // "within", "between", "nuisance": as stored

/// One value of a factor, as the protocol wrote it.
struct Level {
    std::string label;         // as it appears in tables and exports
    bool catch_trial = false;  // conditions with it are catch trials
};

struct Factor {
    std::string name;  // a column in every export
    FactorKind kind = FactorKind::Within;
    std::string unit;  // of the labels, if they are numbers; may be empty
    std::vector<Level> levels;
};

enum class ShownPose { Proxy, Device };  // what the display draws for the held part

/// What a participant is told of a trial that is over: nothing, how it ended, and how long it took.
enum class ShownResult { None, Outcome, Time };
const char* shownResultName(ShownResult result);  // "none", "outcome", "time"

/// What a participant is given to feel and see beside the force; each command is a number from 0 to 1, computed from
/// the recorded ticks by measures::CueSignals.
struct Cues {
    bool visual = false, vibrotactile = false, audio = false;
    bool masking_noise = false;  // over the headphones, so that nothing else is heard: 1 all the time
    double full_depth = 0.002;   // [m] of the hand's pose at which visual and vibration are 1
    double full_speed = 0.1;     // [m/s] of the hand at an impact at which the sound is 1
    double sound_decay = 0.05;   // [s] in which the sound falls to 37 %
    bool any() const { return visual || vibrotactile || audio || masking_noise; }
};

/// What a staircase presents in a condition.
struct StaircaseLevel {
    std::size_t staircase = 0;  // index into the plan's
    double level = 0.0;
};

/// What a device of kind "any" must do at least.
struct DeviceNeeds {
    double force = 0.0;   // [N]; 0: it need not push
    double torque = 0.0;  // [N·m]; 0: it need not turn
    int degrees = 6;      // that it measures
};

/// One combination of factor levels with everything it means.
struct Condition {
    std::string name;                 // levels joined by "/", unique
    std::vector<std::size_t> levels;  // index per factor
    std::string levels_json;          // {"factor": "label", ...}
    scene::SceneSpec scene;           // complete: stiffness resolved to numbers
    bool allow_unstable = false;   // the protocol takes responsibility for a stiffness that is not known to be stable
    double accuracy_budget = 0.0;  // of a query [s]; > 0: accuracy = "auto" picks what the scene's contact has of
                                   // tolerance, cell, spacing, mode and nodes
    int accuracy_line = 0, accuracy_column = 0;  // where the protocol writes that budget, from 1
    bool accuracy_picked = false;                // it has
    Task task;
    std::optional<scene::SceneSpec> comparison;  // of a discrimination_pair: the other interval's scene
    std::optional<StaircaseLevel> stimulus;      // none: no staircase chose anything in it
    ShownPose shown = ShownPose::Proxy;
    bool shows_scene = true;  // false: nothing of it is drawn from the trial's start on
    ShownResult result = ShownResult::None;
    Cues cues;
    TimedBy timed_by = TimedBy::Program;
    SecondaryTask secondary;
    std::string device;                           // its kind
    std::optional<DeviceNeeds> needs = {};        // of the kind "any", for all hands
    std::vector<std::string> other_devices = {};  // likewise, of each of the scene's other hands
    std::string params_json;                      // every resolved number, for the attempt's row
};

/// How an interrupted session may go on.
struct ResumePolicy {
    double max_age = 24.0 * 3600.0;  // [s] since the interruption
    bool redo_practice = false;      // of the blocks before the one that was interrupted
    bool restart_block = false;
};

enum class Moment { SessionStart, BeforeBlock, AfterBlock, AfterTrial, AfterCondition, SessionEnd };
const char* momentName(Moment moment);  // "session_start", …: as stored

/// A questionnaire and when it is asked.
struct PlannedQuestionnaire {
    std::string file, texts;  // as the protocol writes them; texts: the lab's, for a template
    std::string language;
    Moment moment = Moment::SessionEnd;
    std::string block;                     // whose moment it is; empty: every main block's
    int line = 0, column = 0;              // of the table in the protocol
    questionnaire::Definition definition;  // without items until loadQuestionnaires()
    std::string source_json;               // {"definition": text of `file`, "texts": text of `texts`}, byte for byte
};

/// What a device displays stably, as the stiffnesses of a protocol were resolved against it.
struct StableStiffness {
    std::string device;
    double linear = 0.0;      // [N/m], 0: not known
    double rotational = 0.0;  // [N·m/rad], 0: not known or not actuated
    std::string origin;       // in words
};

/// Something that people are asked to agree to.
struct ConsentClause {
    std::string clause;  // unique name
    bool required = true;
    std::vector<std::pair<std::string, std::string>> texts;  // language, text; every clause in the same languages
};

/// A mesh file that a study names.
struct NamedMesh {
    std::string name;  // as the protocol writes it
    std::string path;  // as it can be opened from here
};

/// A protocol, validated and complete: what runs is decided here and nowhere else.
struct StudyPlan {
    std::string name;
    std::string version;
    std::string title;
    std::uint64_t seed = 0;
    int participants = 0;       // planned N
    int allocation_blocks = 1;  // a permuted block holds each group so often
    std::vector<Factor> factors;
    std::vector<Condition> conditions;  // the first factor varies slowest; of all groups and assignments
    std::size_t shared_conditions = 0;  // how many of these, from the first, are no block's own; 0: all
    std::size_t first_variant = 0;      // from here on they present levels of staircases; 0: none does
    std::vector<Block> blocks;
    std::vector<Staircase> staircases;
    double max_session = 0.0;  // [s] that a session may take; 0: no limit
    std::vector<Analysis> analyses;
    std::vector<DataRule> data_rules;
    std::vector<PlannedQuestionnaire> questionnaires;
    ResumePolicy resume;
    View view;
    double max_missed_share = 0.01;                 // of a trial's cycles: an attempt that missed more, or had
                                                    // no usable input in more, is not valid
    std::vector<std::string> measures;              // names, all known to study/measures
    std::vector<NamedMesh> meshes;                  // each once; their content is no part of the text
    std::vector<std::string> languages;             // of the texts, in the order of the file
    std::vector<StudyText> texts;                   // every one in all of these languages
    std::vector<Instruction> instructions;          // in the order in which they are shown
    std::vector<PictureSource> pictures;            // each once; their content is no part of the text
    std::vector<ConsentClause> consent;             // in the order in which they are asked
    std::vector<StableStiffness> stable_stiffness;  // of each device that a condition names, by name
    std::string source_text;                        // the file, byte for byte
    std::string source_path;
    std::string expanded_json;          // factors, conditions, blocks after expansion
    std::vector<std::string> warnings;  // sentences: allowed, but the experimenter should know
};

/// What orders, groups and slots follow from.
design::Design designOf(const StudyPlan& plan);

/// Names of the groups of the between factors, their levels joined by "/"; "all" if there is no such factor.
std::vector<std::string> groupNames(const StudyPlan& plan);

/// How many sessions a participant has.
int sessionsOf(const StudyPlan& plan);

/// How many conditions are planned, those apart that present the levels of staircases.
std::size_t plannedConditions(const StudyPlan& plan);

}  // namespace passung::plan
