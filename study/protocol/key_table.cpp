#include "study/protocol/key_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "study/protocol/condition_keys.h"
#include "study/protocol/questionnaire_keys.h"
#include "study/protocol/scene_keys.h"
#include "study/protocol/staircase_keys.h"
#include "study/protocol/task_keys.h"
#include "study/protocol/view_keys.h"

namespace passung::protocol {
namespace {

using enum KeyType;
using namespace ranges;

// clang-format off
constexpr std::array kStudyKeys{
    Key{"protocol", "passung", Integer, from(1, 1), "", "!", "Version of this file format."},
    Key{"protocol", "study", Table, kAny, "", "!", "Name of the study, number of participants."},
    Key{"protocol", "scene", Table, kAny, "", "!", "Parts, contact, device and registration."},
    Key{"protocol", "factor", Tables, kAny, "", "(none: one condition)", "Factors: things that vary. Every combination of levels is a condition."},
    Key{"protocol", "exclude", Tables, kAny, "", "(none)", "Combinations of levels that are left out: [{ method = \"penalty\", clearance = \"0.1\" }, ...]; factors not named stand for all of their levels. Tables with `data` are rules on recorded values instead."},
    Key{"protocol", "task", Table, kAny, "", "!", "Task of a trial, and the rule that judges it."},
    Key{"protocol", "feedback", Table, kAny, "", "(its defaults)", "Channels through which the participant feels and sees contact."},
    Key{"protocol", "block", Tables, kAny, "", "!", "Blocks of trials in the order in which they run."},
    Key{"protocol", "questionnaire", Tables, kAny, "", "(none)", "Questionnaires and when they are asked."},
    Key{"protocol", "analysis", Tables, kAny, "", "(none)", "Tests that are planned, fixed with the protocol."},
    Key{"protocol", "resume", Table, kAny, "", "(its defaults)", "Rules by which `passung resume` goes on with an interrupted session."},
    Key{"protocol", "loop", Table, kAny, "", "(its defaults)", "Share of cycles that the haptic loop may miss."},
    Key{"protocol", "consent", Tables, kAny, "", "(none)", "Clauses that people agree to before they take part."},
    Key{"protocol", "measures", Texts, kAny, "", "(all)", "Names of the measures to store for every trial."},

    Key{"study", "name", Name, kAny, "", "!", "Short name; part of every random stream, so renaming a study changes its orders."},
    Key{"study", "version", Text, kAny, "", "!", "Your version of the protocol; stored with every session."},
    Key{"study", "title", Text, kAny, "", "(the name)", "Title for people."},
    Key{"study", "seed", Integer, atLeast(0), "", "!", "Seed from which everything random follows."},
    Key{"study", "participants", Integer, from(1, 100000), "", "!", "Number of participants that is planned; a multiple of the rows of the Williams square keeps orders balanced."},
    Key{"study", "max_session_minutes", Number, aboveUpTo(0, 1440), "", "(no limit)", "Limit for the trials of a session, each to its time-out, and its rests; a longer session is an error. Ways to the start, repeated attempts and questionnaires do not count."},
    Key{"study", "allocation_blocks", Integer, from(1, 10), "", "1", "Participants are allotted to groups in permuted blocks that hold each group so often."},

    Key{"factor", "name", Name, kAny, "", "!", "Name of the factor: a column in every export."},
    Key{"factor", "key", Text, kAny, "", "(every level has its `set`)", "Key of the scene that varies, such as contact.method or part.plate.shape.bore_diameter; also task.* and feedback.*, a step of an assembly by its name, as in task.step.lid.position_tolerance_mm, and a further hand, as in hand.left.registration.scale."},
    Key{"factor", "kind", Choice, kAny, "within|between|nuisance", "within", "within: everyone sees every level. between: a participant's group sees one. nuisance: its levels are assigned to the other conditions, to each another one in every row of a square, so that nobody sees every combination and all together see each equally often."},
    Key{"factor", "unit", Text, kAny, "", "(none)", "Unit of the labels, for tables."},
    Key{"factor", "levels", Levels, kAny, "", "!", "Levels, at least two: plain values, or tables as below."},

    Key{"level", "label", Text, kAny, "", "(the value)", "Name in tables and exports; unique."},
    Key{"level", "value", Any, kAny, "", "(its `set`)", "Value that the factor's key becomes."},
    Key{"level", "catch", Boolean, kAny, "", "false", "Conditions with this level are catch trials: in no pass, only where a block has `catch_trials`."},
    Key{"level", "set", Table, kAny, "", "(its `value`)", "Several keys at once: { \"contact.method\" = \"penalty\", ... }."},

    Key{"feedback", "kinesthetic", Boolean, kAny, "", "true", "True where forces are displayed. false: contact is computed and recorded as ever, but the device commands none."},
    Key{"feedback", "cues", Texts, kAny, "", "(none)", "Cues beside the force: \"visual\", \"vibrotactile\", \"audio\". The command of each, from 0 to 1, follows from the recorded ticks and is a column of the exported samples. Windows draw the visual one (the held part turns from amber to vermilion, #d52e00 at 1) and play the audio one; no device has an actuator for the vibrotactile one yet: check warns, and only simulated participants, who perceive cues through a channel of their own, can run it. feedback_given in trials.csv says what was delivered."},
    Key{"feedback", "cue_full_depth_mm", Number, above(0), "", "2", "Depth at the hand's pose at which the visual and the vibrotactile command are 1."},
    Key{"feedback", "cue_full_speed_mm_per_s", Number, above(0), "", "100", "Speed of the hand at an impact at which the audio command is 1."},
    Key{"feedback", "cue_sound_decay_ms", Number, aboveUpTo(0, 10000), "", "50", "Time in which the audio command falls to 37 % after an impact."},
    Key{"feedback", "scene", Boolean, kAny, "", "true", "False: nothing of the scene is drawn from the trial's start on; the start pose is still shown. Simulated people then hold the part and give way to what they feel."},
    Key{"feedback", "shown_pose", Choice, kAny, "proxy|device", "proxy", "Pose at which the held part is drawn: that of the proxy, which stays outside, or that of the device."},

    Key{"block", "name", Name, kAny, "", "!", "Name of the block, unique."},
    Key{"block", "phase", Choice, kAny, "practice|main", "main", "Phase of the block's trials in the analysis; practice is stored and marked."},
    Key{"block", "repetitions", Integer, from(1, 1000), "", "1", "Number of passes through the order."},
    Key{"block", "order", Choice, kAny, "williams|latin_square|permutations|random|shuffled|listed", "williams", "The participant's row of a Williams square (a Latin square that balances the condition before as well; `latin_square` means the same) or of the list of all orders (at most 5 conditions), a new shuffle for every pass, all passes shuffled together, or as listed."},
    Key{"block", "blocked", Text, kAny, "", "(none)", "Name of a within factor whose levels come one after the other, all repetitions of each: devices that take time to swap. `order` is of the conditions inside a level."},
    Key{"block", "blocked_order", Choice, kAny, "williams|latin_square|permutations|random|listed", "williams", "Order of these levels. With two squares the rows of the inner one change after a whole turn of the outer one, so that both are balanced together."},
    Key{"block", "constraints", Tables, kAny, "", "(none)", "Rules that random and shuffled orders keep to; catch trials do not count."},
    Key{"block", "catch_trials", Integer, from(0, 1000), "", "0", "Number of catch trials in every pass: trials of the conditions whose level has `catch = true`, at random positions; their phase is catch."},
    Key{"block", "catch_from", Integer, atLeast(1), "", "1", "First position in the pass that a catch trial may have."},
    Key{"block", "catch_to", Integer, atLeast(1), "", "(the last)", "Last position in the pass that a catch trial may have."},
    Key{"block", "session", Integer, from(1, 100), "", "1", "Number of the participant's session that has the block; all blocks of one before those of the next."},
    Key{"block", "rest_s", Number, from(0, 86400), "", "0", "Least duration of the rest before the block."},
    Key{"block", "rest_ends", Choice, kAny, "time|participant|experimenter", "time", "End of that rest: its time, or then the participant or the experimenter, where a window or a command can say so."},
    Key{"block", "trials", Integer, atLeast(1), "", "(all)", "Number of conditions of each pass that run, the first ones."},
    Key{"block", "on_failure", Choice, kAny, "never|repeat_now|repeat_at_block_end", "never", "Consequence of an attempt that ended by the trial's own rules without success."},
    Key{"block", "on_timeout", Choice, kAny, "never|repeat_now|repeat_at_block_end", "(as `on_failure`)", "Consequence of a time-out. An attempt that is repeated does not count: `time_s` is then of what succeeded in the end, and biased; `never` keeps the time-out as a censored time."},
    Key{"block", "on_invalid", Choice, kAny, "never|repeat_now|repeat_at_block_end", "repeat_at_block_end", "Consequence of an attempt that does not count: aborted by itself, ticks lost, invalidated by the experimenter. With `never`, or `max_attempts = 1`, one of them in a main block leaves the session incomplete unless the trial is repeated by hand or on resume."},
    Key{"block", "max_attempts", Integer, from(1, 100), "", "3", "Number of attempts at a trial after which these rules repeat no more."},

    Key{"consent", "clause", Name, kAny, "", "!", "Name of the clause, unique; decisions are stored by this name."},
    Key{"consent", "required", Boolean, kAny, "", "true", "True where only people who agree can take part. Simulated participants are not asked."},
    Key{"consent", "text", Table, kAny, "", "!", "Text of the clause, one per language: `{ en = \"...\", de = \"...\" }`; every clause in the same languages. Until when data can be withdrawn belongs here."},

    Key{"block", "conditions", Levels, kAny, "", "(all)", "Conditions of the block, also the order of `listed`: names (\"penalty/max\"), or tables of some levels ({ method = \"penalty\" }) for all conditions with these. A line of its own `conditions = \"FILE.csv\"`: a table beside the study, factors in its first row, levels in every other; it becomes part of the stored text."},
    Key{"block", "set", Table, kAny, "", "(none)", "Keys that are different in this block, as a level's `set`: { \"task.timeout_s\" = 60 }. Its conditions are its own then: \"penalty/max@NAME\". A level of a factor that sets the same key is an error."},

    Key{"analysis", "outcome", Text, kAny, "", "(of `staircase`)", "A measure that the study stores, or a scale of a questionnaire that it asks, as `nasa_tlx_raw.workload`. Times that may end in a time-out: `time_s`, whose cells hold the restricted mean, so that nobody drops out."},
    Key{"analysis", "staircase", Text, kAny, "", "(none)", "Staircase whose thresholds, the mean over its tracks, are the outcome in place of `outcome`."},
    Key{"analysis", "block", Text, kAny, "", "(each)", "Block whose trials count; left out: those of every main block that has the outcome, each by itself."},
    Key{"analysis", "factors", Texts, kAny, "", "(none)", "Names of factors; `block`: which main block, where `block` names none."},
    Key{"analysis", "test", Choice, kAny, "paired_t|wilcoxon|rm_anova|friedman|welch_t|mann_whitney|mixed_anova|lmm|survival|ordinal|equivalence|mean", "!", "Test, refused where it is not for these factors: paired_t, wilcoxon: one within factor of two levels; friedman: one of three or more; rm_anova: within factors; welch_t, mann_whitney: one between factor of two levels; mixed_anova: both kinds; lmm: any; survival, of time_s, proportional hazards of every trial: any; ordinal, a cumulative link mixed model: within factors; equivalence, two one-sided t-tests: one factor of two levels; mean, with its confidence interval: none."},
    Key{"analysis", "role", Choice, kAny, "primary|secondary|exploratory", "(none)", "What hangs on it; `exploratory` stands in the report's last part."},
    Key{"analysis", "transform", Choice, kAny, "log", "(none)", "`log`: the natural logarithm of each participant's value is analysed; a value that is not above 0 counts as none."},
    Key{"analysis", "covariates", Texts, kAny, "", "(none)", "Of lmm and survival: what else the model has, `order_position` or `session`, of cells by their mean."},
    Key{"analysis", "contrasts", Texts, kAny, "", "(all pairs)", "Differences that are planned, `\"FACTOR: LEVEL - LEVEL\"`; the others are not shown."},
    Key{"analysis", "equivalence_bounds", Any, kAny, "", "(not equivalence)", "`[low, high]` in the outcome's unit (with `transform` of its logarithm): a difference between them, of the first level less the second, does not matter."},
    Key{"analysis", "family", Name, kAny, "", "(none)", "Analyses of one name have their p values adjusted together, by Holm."},
    Key{"exclude", "data", Choice, kAny, "trials|participants", "!", "What the rule leaves out: trials by their own value, or participants by their mean over the trials that count."},
    Key{"exclude", "value", Text, kAny, "", "!", "A measure that the study stores; of participants also a scale, as `ssq.total`, by the mean of their forms."},
    Key{"exclude", "below", Number, kAny, "", "(none)", "Left out below this."},
    Key{"exclude", "above", Number, kAny, "", "(none)", "Left out above this; one of both is required."},
    Key{"exclude", "reason", Text, kAny, "", "(none)", "Why, in words."},
    Key{"resume", "max_age_h", Number, above(0), "", "24", "Longest time after the interruption at which a session may go on. Sessions in virtual time have no limit."},
    Key{"resume", "practice", Choice, kAny, "keep|redo", "keep", "`redo`: practice of the blocks before is done once more."},
    Key{"resume", "block", Choice, kAny, "continue|restart", "continue", "`restart`: the interrupted block begins anew; what it had no longer counts."},

    Key{"constraint", "rule", Choice, kAny, "max_run|min_distance|no_repeat|first_not|position_window", "!", "max_run: at most `count` trials in a row have the same level of `factor`. min_distance: two such trials are at least `count` trials apart. no_repeat: no condition twice in a row. first_not: the block does not begin with `level`. position_window: trials with `level` stand at the block's positions `from` to `to`."},
    Key{"constraint", "factor", Text, kAny, "", "(not for no_repeat)", "Name of the factor."},
    Key{"constraint", "level", Text, kAny, "", "(only first_not and position_window)", "Label of the level."},
    Key{"constraint", "count", Integer, from(1, 1000), "", "(only max_run and min_distance)", "Number of trials."},
    Key{"constraint", "from", Integer, atLeast(1), "", "1", "First position in the block, from 1; only position_window."},
    Key{"constraint", "to", Integer, atLeast(1), "", "(only position_window)", "Last position."},

    Key{"loop", "max_missed_share", Number, from(0, 1), "", "0.01", "Largest part of the cycles between start and end of a trial that a valid attempt may miss, or have no usable device input in. In virtual time no cycle is missed."},
};

template <std::size_t n, std::size_t m>
constexpr std::array<Key, n + m> joined(const std::array<Key, n>& first, const std::array<Key, m>& second) {
    return [&]<std::size_t... i, std::size_t... j>(std::index_sequence<i...>, std::index_sequence<j...>) {
        return std::array<Key, n + m>{first[i]..., second[j]...};
    }(std::make_index_sequence<n>{}, std::make_index_sequence<m>{});
}
constexpr auto kKeys =
    joined(joined(joined(joined(joined(joined(kStudyKeys, kTaskKeys), scene_rows::kSceneKeys), kConditionKeys),
                         staircase_rows::kStaircaseKeys),
                  kQuestionnaireKeys),
           view_rows::kViewKeys);

/// Tables in the order of the documentation: id, heading, sentence.
struct TableInfo {
    std::string_view id, heading, doc;
};
constexpr std::array kTables{
    TableInfo{"protocol", "Top level of a study", "A study file starts with `passung = 1`. A line `include = \"FILE\"`, anywhere, stands for the lines of FILE, a file\nin the same folder: the stored protocol has them in its place."},
    TableInfo{"study", "`[study]`", ""},
    TableInfo{"scene", "Top level of a scene", "In a study below `[scene]`: `[scene.contact]`, `[[scene.part]]` and so on. A study holds its scene itself, so that\nthe stored text is all of it."},
    TableInfo{"hand", "`[[hand]]`", "Each hand pushes the others' parts and feels them. The coupling of `[contact]` is one for all hands."},
    TableInfo{"part_file", "Top level of a part file", ""},
    TableInfo{"station_file", "Station file", "Which device serves each hand at this computer: `station.toml` in the folder of the user's data, or the file that\n`--station-file` names. `passung doctor --write-station FILE` writes one of what it finds. Without it all devices are simulated."},
    TableInfo{"station", "`[station]`", ""},
    TableInfo{"station_device", "`[station.device.NAME]`", "Simulated participants hold simulated devices, whatever stands here."},
    TableInfo{"calibration", "Calibration of a device", "The program writes it: `passung doctor --device NAME --find-stiffness`. `passung doctor` says where it is."},
    TableInfo{"part", "`[[part]]`", "A part has either a `mesh` or a `shape`."},
    TableInfo{"pose", "`pose` of a part", ""},
    TableInfo{"shape", "`shape` of a part", ""},
    TableInfo{"shape.sphere", "`shape` of kind `sphere`", ""},
    TableInfo{"shape.box", "`shape` of kind `box`", ""},
    TableInfo{"shape.cylinder", "`shape` of kind `cylinder`", ""},
    TableInfo{"shape.torus", "`shape` of kind `torus`", ""},
    TableInfo{"shape.sheet", "`shape` of kind `sheet`", ""},
    TableInfo{"shape.peg", "`shape` of kind `peg`", ""},
    TableInfo{"shape.square_peg", "`shape` of kind `square_peg`", ""},
    TableInfo{"shape.keyed_peg", "`shape` of kind `keyed_peg`", ""},
    TableInfo{"shape.bore_plate", "`shape` of kind `bore_plate`", ""},
    TableInfo{"shape.square_bore_plate", "`shape` of kind `square_bore_plate`", ""},
    TableInfo{"shape.keyed_bore_plate", "`shape` of kind `keyed_bore_plate`", ""},
    TableInfo{"shape.thread_bolt", "`shape` of kind `thread_bolt`", "A right-handed thread with one start, all along; by default with the profile of ISO 68-1. A bolt has in a nut of the same nominal\ndiameter and pitch the sum c of both clearances as play at crests and roots, and c/2 between flanks. Threads need a\ngod object: they have no distance field."},
    TableInfo{"shape.thread_nut", "`shape` of kind `thread_nut`", "Its counterpart: a ring with the thread right through. A bolt at the nut's own pose fits in it; one that is\nz higher fits when it is turned by z / pitch turns."},
    TableInfo{"shape.fit", "Fit of a `peg`, `keyed_peg`, `bore_plate` or `keyed_bore_plate`", "In the same table, in place of the `diameter` or `bore_diameter`."},
    TableInfo{"contact", "`[contact]`", ""},
    TableInfo{"device", "`[device]`", ""},
    TableInfo{"registration", "`[registration]`", ""},
    TableInfo{"start_gate", "`[start_gate]`", ""},
    TableInfo{"effects", "`[effects]`", "A table for each effect; what is absent is not built."},
    TableInfo{"effects.passivity_controller", "`[effects.passivity_controller]`", ""},
    TableInfo{"effects.transients", "`[effects.transients]`", ""},
    TableInfo{"effects.weight", "`[effects.weight]`", ""},
    TableInfo{"effects.viscosity", "`[effects.viscosity]`", ""},
    TableInfo{"effects.guidance", "`[effects.guidance]`", ""},
    TableInfo{"effects.snap", "`[effects.snap]`", ""},
    TableInfo{"effects.inertia", "`[effects.inertia]`", ""},
    TableInfo{"effects.keep_apart", "`[effects.keep_apart]`", ""},
    TableInfo{"effects.pick", "`[effects.pick]`", ""},
    TableInfo{"effects.clutch", "`[effects.clutch]`", ""},
    TableInfo{"effects.position_scale", "`[effects.position_scale]`", ""},
    TableInfo{"effects.drift", "`[effects.drift]`", ""},
    TableInfo{"hand_effects", "`[hand.effects]`", ""},
    TableInfo{"factor", "`[[factor]]`", ""},
    TableInfo{"level", "Levels written as tables", "A level has either a `value` or a `set`."},
    TableInfo{"task", "`[task]`", ""},
    TableInfo{"task.peg_in_hole", "`[task]` of type `peg_in_hole`", ""},
    TableInfo{"task.narrow_passage", "`[task]` of type `narrow_passage`", ""},
    TableInfo{"task.contour_following", "`[task]` of type `contour_following`", ""},
    TableInfo{"task.free_placement", "`[task]` of type `free_placement`", ""},
    TableInfo{"task.discrimination_pair", "`[task]` of type `discrimination_pair`", ""},
    TableInfo{"task.assembly", "`[task]` of type `assembly`", "Hands pick parts up, by effects.pick, and put each where it belongs."},
    TableInfo{"task.step", "`[[task.step]]` of an assembly", ""},
    TableInfo{"feedback", "`[feedback]`", ""},
    TableInfo{"view", "`[view]`", "What the participant's window looks like, in all conditions: only this says so. It is stored with the protocol and\nlogged with each session that a window shows; what the experimenter chooses for the console changes nothing of it."},
    TableInfo{"secondary", "`[secondary]`", "In the manner of ISO 17488: onsets 3 to 5 s apart, responses from 100 to 2500 ms. Ours: intervals are uniform\nbetween the bounds and go on from an attempt's first tick; other presses are false alarms."},
    TableInfo{"text", "`[text.LANGUAGE]`", "A text for each name; a text that one language has, every one must have, and the clauses of consent too."},
    TableInfo{"instruction", "`[[instruction]]`", ""},
    TableInfo{"block", "`[[block]]`", ""},
    TableInfo{"staircase", "`[[staircase]]`", "Its block's trials are of the phase `adaptive`: they enter no mean of a condition, but staircase.csv."},
    TableInfo{"staircase_track", "`tracks` of a staircase", ""},
    TableInfo{"consent", "`[[consent]]`", "Each decision is stored with the SHA-256 of the text that it answers: a changed text has to be asked anew."},
    TableInfo{"resume", "`[resume]`", ""},
    TableInfo{"constraint", "`constraints` of a block", "An order that no shuffle and no search finds is an error that says why."},
    TableInfo{"analysis", "`[[analysis]]`", ""},
    TableInfo{"exclude", "`[[exclude]]` with `data`", "A rule on recorded values, fixed with the protocol: exports and report leave out what it says, and say so."},
    TableInfo{"loop", "`[loop]`", ""},
    TableInfo{"questionnaire", "`[[questionnaire]]`", "In a study: what is asked, and when. Where several are due at one moment they come as listed."},
    TableInfo{"questionnaire_file", "Top level of a questionnaire file", "See `protocols/questionnaires/`. A text for each language is a table `{ en = \"...\", de = \"...\" }`; with one language a\nstring will do."},
    TableInfo{"questionnaire_response", "`[[response]]` of a questionnaire", ""},
    TableInfo{"questionnaire_option", "`options` of a response", ""},
    TableInfo{"questionnaire_item", "`[[item]]` of a questionnaire", ""},
    TableInfo{"questionnaire_scale", "`[[scale]]` of a questionnaire", "`factor` times the mean or sum of answer + `shift`; a reversed item's answer is aligned first. `pair_weighted`: the sum\nof weight times answer by the number of pairs; an item's weight is how many of the pairs it won."},
    TableInfo{"questionnaire_class", "`classes` of a scale", ""},
    TableInfo{"questionnaire_golden", "`[[golden]]` of a questionnaire", "Computed whenever the file is read; a score that differs is an error."},
    TableInfo{"questionnaire_texts", "Top level of a file with a lab's texts", ""},
    TableInfo{"questionnaire_text", "`[[item]]` of a file with a lab's texts", ""},
};
// clang-format on

std::string typeText(const Key& key) {
    switch (key.type) {
        case Boolean:
            return "boolean";
        case Integer:
            return "integer";
        case Number:
            return "number";
        case Text:
            return "string";
        case Name:
            return "name (a-z, 0-9, _)";
        case Length:
            return "length";
        case LengthVector:
            return "[x, y, z], lengths";
        case Depth:
            return "length or \"through\"";
        case Vector:
            return "[x, y, z]";
        case Stiffness:
            return "number, \"max\" or \"0.7 max\"";
        case Table:
            return "table";
        case Tables:
            return "tables";
        case Texts:
            return "list of strings";
        case Levels:
            return "list";
        case Any:
            return "any";
        case Choice:
            break;
    }
    std::string text;
    for (const auto choice : key.choiceList()) text += fmt::format("{}`{}`", text.empty() ? "" : ", ", choice);
    return text;
}

std::string fallbackText(const Key& key) {
    if (key.required()) return "**required**";
    if (key.fallback.starts_with('(')) return std::string(key.fallback.substr(1, key.fallback.size() - 2));
    return fmt::format("`{}`", key.fallback);
}

/// Levenshtein's distance.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
        }
    }
    return row[b.size()];
}

}  // namespace

std::optional<double> Key::fallbackNumber() const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(fallback.data(), fallback.data() + fallback.size(), value);
    if (error != std::errc{} || end != fallback.data() + fallback.size()) return std::nullopt;
    return value;
}

std::vector<std::string_view> Key::choiceList() const {
    std::vector<std::string_view> list;
    for (std::string_view rest = choices; !rest.empty();) {
        const auto bar = rest.find('|');
        list.push_back(rest.substr(0, bar));
        rest = bar == std::string_view::npos ? std::string_view{} : rest.substr(bar + 1);
    }
    return list;
}

std::span<const Key> keys() { return kKeys; }

const Key* findKey(std::span<const std::string_view> tables, std::string_view name) {
    for (const auto& key : kKeys)
        if (key.name == name && std::find(tables.begin(), tables.end(), key.table) != tables.end()) return &key;
    return nullptr;
}

double unitsPerSi(std::string_view name) {
    if (name.ends_with("_um") || name.ends_with("_us")) return 1e6;
    if (name.ends_with("_mm") || name.ends_with("_mm_per_s") || name.ends_with("_ms")) return 1e3;
    if (name.ends_with("_percent")) return 1e2;
    if (name.ends_with("_h")) return 1.0 / 3600.0;
    if (name.ends_with("_deg")) return 180.0 / 3.14159265358979323846;
    return 1.0;
}

std::string requirement(const Range& range) {
    const bool has_low = std::isfinite(range.low), has_high = std::isfinite(range.high);
    if (has_low && range.low == range.high) return fmt::format("must be {}", range.low);
    if (has_low && has_high && range.low_excluded)
        return fmt::format("must be > {} and at most {}", range.low, range.high);
    if (has_low && has_high) return fmt::format("must be from {} to {}", range.low, range.high);
    if (has_low) return fmt::format("must be {} {}", range.low_excluded ? ">" : "≥", range.low);
    return "";
}

std::optional<std::string_view> closestWord(std::string_view word, std::span<const std::string_view> candidates) {
    std::optional<std::string_view> best;
    // A third of the letters wrong is the most that still looks like a slip.
    std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const auto candidate : candidates) {
        // The same word without its unit is meant as well.
        const bool begins_alike = word.size() >= 3 && candidate.starts_with(word);
        const std::size_t distance = begins_alike ? 1 : editDistance(word, candidate);
        if (distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

std::string keyTable(std::span<const DeviceDescription> devices, std::span<const KnownWord> measures) {
    std::string text =
        "# Keys of study, scene, part and questionnaire files\n\n"
        "Printed by the program from the table that its reader uses. Files are TOML; a key that is not listed is an\n"
        "error. Lengths are in the file's `unit`; keys with a unit in their name are in that unit.\n";
    for (const auto& table : kTables) {
        text += fmt::format("\n## {}\n", table.heading);
        if (!table.doc.empty()) text += fmt::format("\n{}\n", table.doc);
        bool first = true;
        for (const auto& key : kKeys) {
            if (key.table != table.id) continue;
            if (std::exchange(first, false))
                text += "\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
            const auto range = requirement(key.range);
            text += fmt::format("| `{}` | {}{}{} | {} | {} |\n", key.name, typeText(key), range.empty() ? "" : ", ",
                                range.starts_with("must be ") ? range.substr(8) : range, fallbackText(key), key.doc);
        }
    }
    text += "\n## Kinds of device\n\nWhat `kind` in `[device]` may name. \"max\" of a stiffness is the stable one.\n";
    text +=
        "\n| preset | device | stable N/m | stable Nm/rad | force N | torque Nm |\n| --- | --- | --- | --- | --- | --- "
        "|\n";
    for (const auto& device : devices)
        text += fmt::format("| {} | {} | {:.6g} | {:.6g} | {:.6g} | {:.6g} |\n", device.name, device.label,
                            device.stable_stiffness_N_per_m, device.stable_rotational_stiffness_Nm_per_rad,
                            device.max_force_N, device.max_torque_Nm);
    text += "\n## Measures\n\nWhat `measures` may name; the codebook of an export has the formulas.\n";
    text += "\n| measure | meaning |\n| --- | --- |\n";
    for (const auto& measure : measures) text += fmt::format("| {} | {} |\n", measure.name, measure.meaning);
    return text;
}

}  // namespace passung::protocol
