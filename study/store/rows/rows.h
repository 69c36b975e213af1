#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/design/adaptive.h"
#include "study/measures/cues.h"
#include "study/measures/measures.h"
#include "study/plan/analysis.h"
#include "study/session/apparatus.h"
#include "study/session/trial_sink.h"

namespace passung::store {

// What StoreReader hands out: one struct per table or join, names as in the schema. An empty optional is NULL.

struct ProtocolRow {
    std::string sha256;
    std::string name;
    std::string version;
    std::string title;
    std::string source_text;
    std::string expanded_json;
    std::string app_version;
    std::vector<std::string> main_blocks = {};  // whose trials enter means, by the stored plan
};

/// A mesh file that a protocol names, as it was when the protocol was imported.
struct MeshRow {
    std::string protocol_sha256;
    std::string mesh;    // as the protocol writes it
    std::string sha256;  // of the file's bytes
    std::int64_t bytes = 0;
};

/// What the contact of a condition was computed from when the protocol first ran in this database; holds for all its
/// sessions.
struct ContactGeometryRow {
    std::string condition;
    std::string geometry;    // scene::geometryName(), never "auto"
    std::string comparison;  // of a pair: the other interval's
};

/// A setting that was measured for contact.accuracy = "auto" when the protocol first ran in this database. What was
/// picked then holds for all its sessions.
struct AccuracyRow {
    std::string protocol_sha256;
    std::int64_t candidate = 0;  // in the order of measuring, from 0
    std::string mode;
    double tolerance_um = 0.0;
    double spacing_mm = 0.0;
    std::int64_t budget_nodes = 0;  // 0: none
    std::int64_t points = 0;        // of the held part
    double time_median_us = 0.0;    // of a query
    double time_p99_us = 0.0;
    double time_max_us = 0.0;
    double error_mean_um = 0.0;  // of the depth, against independent truth
    double error_p99_um = 0.0;
    double error_max_um = 0.0;
    // Of the contacts' area-weighted penalty: size, direction, and torque as a share of force times lever. Empty where
    // no answer had a force, and in files from before it was measured.
    std::optional<double> force_error_p99_percent = {};
    std::optional<double> direction_error_p99_deg = {};
    std::optional<double> torque_error_p99_percent = {};
    std::vector<double> picked_for_us = {};  // budgets of a query that it was picked for, ascending
};

struct FactorRow {
    std::string protocol_sha256;
    std::string factor;
    std::string kind;
    std::string unit;
    std::vector<std::string> levels;
};

using Levels = std::vector<std::pair<std::string, std::string>>;  // factor, label

struct ConditionRow {
    std::string protocol_sha256;
    std::string condition;
    Levels levels;
    // What it asks for, by the stored plan; nothing in files whose plan does not say.
    std::string task_type = {};            // "peg_in_hole" …
    std::optional<double> timeout_s = {};  // of a trial
    std::string timed_by = "program";      // who says when it begins and ends
    std::string stimulus = "none";         // of its secondary task
};

/// How many trials of the main phase a session plans of a condition in a block.
struct PlannedCellRow {
    std::string session_id;
    std::string participant_id;
    std::int64_t session_ordinal = 1;
    std::string protocol_sha256;
    std::int64_t block_index = 0;
    std::string block;
    std::string condition;
    std::int64_t trials = 0;
};

/// What the protocol means to test.
struct AnalysisRow {
    std::string protocol_sha256;
    std::int64_t number = 1;  // in the protocol, from 1
    std::string outcome;      // a measure; empty: thresholds of a staircase
    std::string staircase;    // empty: none
    std::string block;        // empty: every main block that has the outcome
    std::vector<std::string> factors;
    std::string test;
    std::string role;       // empty: of a plan that knew none
    std::string transform;  // "log"; empty: none
    std::vector<std::string> covariates;
    std::vector<plan::Contrast> contrasts;
    std::optional<std::pair<double, double>> equivalence_bounds;
    std::string family;  // empty: none
};

/// A rule of the protocol on recorded values.
struct DataRuleRow {
    std::string protocol_sha256;
    std::int64_t number = 1;  // in the protocol, from 1
    plan::DataRule rule;
};

/// A file that a protocol names, as far as the database holds it.
struct NamedFileRow {
    std::string protocol_sha256;
    std::string kind;                   // "mesh", "picture", "questionnaire", "questionnaire_texts"
    std::string name;                   // as the protocol writes it
    std::optional<std::string> text;    // all of it; empty: only its hash is stored
    std::optional<std::string> sha256;  // of its bytes, where the text is not stored
};

/// A questionnaire in one language, as it was or is to be asked.
struct QuestionnaireRow {
    std::string questionnaire;  // its key
    std::string version;
    std::string language;
    std::string definition_text;
    std::optional<std::string> texts_text;
};

struct MeasureRow {
    std::string measure;
    std::string label;
    std::string unit;
    std::string formula;
    std::int64_t formula_version = 1;
    bool declared = false;  // named by a protocol of this file
};

struct ParticipantRow {
    std::string participant_id;
    std::string kind;
    std::string status;
    std::optional<std::string> status_reason;
    std::string created_utc;
    std::optional<std::string> group;
    std::optional<std::int64_t> sequence_index;
    std::optional<std::int64_t> replicate;
    std::optional<std::string> place_sha256;  // the protocol that the place is of
    std::int64_t sessions = 0;
    std::optional<std::string> standing_by;  // what last changed the status: "withdraw", "exclude", "readmit"
};

/// A text that people are asked to agree to.
struct ConsentClauseRow {
    std::string protocol_sha256;
    std::string protocol_version;
    std::string clause;
    std::string language;
    std::string text;
    std::string text_sha256;
    bool required = true;
};

/// What somebody last decided on one text.
struct ConsentRow {
    std::string participant_id;
    std::string clause;
    std::string language;
    std::string text_sha256;
    std::string decision;  // "yes", "no", "withdrawn"
    std::string decided_utc;
};

/// What a walk along the audit's chains found.
struct AuditReport {
    std::int64_t rows = 0;
    std::int64_t chains = 0;          // its own, and those of files that were merged into it
    std::int64_t erased = 0;          // rows whose detail an erasure took away
    std::vector<std::string> faults;  // sentences; empty: the chains are whole
};

struct SessionRow {
    std::string session_id;
    std::string participant_id;
    std::string kind;
    std::int64_t ordinal = 1;
    std::string station;
    std::vector<std::string> segment_devices;                  // that each run of the program began with, in order
    bool device_simulated = true;                              // all of them
    std::vector<std::string> device_backends, device_serials;  // of its real devices, each once; none: simulated
    std::optional<std::string> experimenter;
    std::string language;
    std::uint64_t seed = 0;
    std::string rng;
    std::string epoch;
    std::string started_utc;
    std::optional<std::string> ended_utc;
    std::optional<std::string> end_state;  // empty: still running, or killed and not opened for writing since
    std::string protocol_sha256;
    std::string app_version;
    std::int64_t segments = 0;
    std::int64_t planned_trials = 0;
    std::int64_t attempts = 0;
    std::int64_t valid_attempts = 0;
    bool counted = false;  // means are taken over it
};

/// `*_us` are empty where time was not measured.
struct TimingRow {
    std::string loop;
    std::int64_t ticks = 0;
    std::optional<double> mean_us, sd_us, p99_us, p999_us, max_us;
    std::int64_t overruns = 0;
    std::int64_t dropped_samples = 0;
    std::optional<double> processor_mean_us, processor_p99_us, processor_p999_us, processor_max_us;
};

struct AttemptRow {
    std::int64_t attempt_id = 0;
    std::string session_id;
    std::string participant_id;
    std::string kind;
    std::string group;
    std::int64_t session_ordinal = 1;
    std::string station;
    std::string device;  // of this attempt: a factor may vary it
    std::int64_t block_index = 0;
    std::string block;
    std::string phase;
    std::int64_t trial_index = 0;
    std::int64_t trial_in_block = 0;
    std::int64_t repetition = 1;
    std::int64_t attempt_no = 1;
    std::string condition;            // as planned
    std::string presented_condition;  // another one where a staircase chose its level
    Levels levels;
    std::int64_t start_ns = 0;
    std::optional<std::int64_t> end_ns;
    std::string outcome;  // also "running" and "crashed"
    bool valid = false;
    std::optional<std::string> invalid_reason;
    std::optional<std::string> not_counted_because;  // nothing: means count it
    std::string params_json, stages_json;  // of StoreReader::attempt() alone: of all attempts they are most of the file
    std::uint64_t seed = 0;
    std::string state_hash;     // 16 hexadecimal digits; empty if it did not end
    std::int64_t numerics = 0;  // of its recording (core/tick/numerics.h)
    std::string protocol_sha256;
    std::string app_version;
    std::optional<TimingRow> timing;
    measures::CueSettings cues;                          // what the condition has beside the force
    bool kinesthetic = true;                             // the force was displayed
    std::string timed_by = "program";                    // who said when the trial began and ended
    std::string stimulus = "none";                       // of the secondary task
    std::optional<std::int64_t> trial_ns;                // start of the trial
    std::optional<std::int64_t> start_tick;              // the same among the attempt's ticks; filled in by exports
    std::optional<std::int64_t> end_tick;                // the same of its end
    std::map<std::string, double> measures;              // only those that are defined for this attempt
    std::vector<std::string> undefined_measures;         // recorded, without a value
    std::vector<session::StepEnd> steps;                 // of an assembly
    std::vector<session::ContactEnergy> contact_energy;  // none of attempts from before schema revision 6
    std::optional<session::Presentation> presentation;   // none: no window showed it
    std::optional<session::Delivered> delivered;         // of its feedback; none: not known
    std::optional<std::string> feedback_given;           // the same in words

    /// A main-phase attempt that counts in means: it ended by its own rules and nothing spoilt it.
    bool counts() const {
        return valid && phase == "main" && (outcome == "success" || outcome == "failure" || outcome == "timeout");
    }
};

/// Something that is not as it was written, and so is not handed out.
struct DamageRow {
    std::string participant_id;  // empty: of the study
    std::optional<std::int64_t> session_ordinal, trial_index, attempt_no;
    std::string part;  // "trial 4, attempt 1, samples", "form 2, item_response", or a table of the study
    std::string what;
};

/// A stimulus of a secondary task with its response, or a press without one; times after the attempt's start.
struct DetectionRow {
    std::int64_t attempt_id = 0;
    std::int64_t number = 1;  // by time
    measures::Detection detection;
};

/// A track of a protocol's staircase.
struct StaircaseTrackRow {
    std::string protocol_sha256;
    std::string staircase, track;
    design::AdaptiveParams params;
    std::optional<double> reference = {};  // of a pair's key in the interval without the comparison
};

/// A trial of a staircase.
struct StaircaseStepRow {
    std::int64_t attempt_id = 0;
    std::string staircase;
    std::optional<std::string> track;  // empty: a catch trial
    double wanted_level = 0.0;
    double level = 0.0;  // presented
    std::optional<bool> positive;
    bool reversal = false;
    std::optional<double> estimate;
    std::optional<double> estimate_sd;
};

struct EventRow {
    std::string participant_id;
    std::string kind;
    std::int64_t session_ordinal = 1;
    std::int64_t t_ns = 0;
    std::string t_utc;  // by the session's epoch
    std::optional<std::int64_t> trial_index;
    std::optional<std::int64_t> attempt_no;
    std::string source;
    std::string event;
    std::string payload_json;
};

/// A note, or an experimenter's command.
struct NoteRow {
    std::string participant_id;
    std::string kind;
    std::int64_t session_ordinal = 1;
    std::string t_utc;
    std::string author;
    std::string entry;  // "note", or the command's name
    bool accepted = true;
    std::optional<std::string> text, refusal;
    std::optional<std::int64_t> trial_index, attempt_no;
};

struct ItemResponseRow {
    std::string item;
    std::int64_t presented_index = 0;  // from 0
    std::optional<double> value_num;
    std::optional<std::string> value_text;
    bool skipped = false;
    std::optional<std::int64_t> rt_ms;  // empty: not measured
    std::int64_t changes = 0;
};

struct ScoreRow {
    std::string scale;
    std::optional<double> value;
    std::int64_t n_items = 0;
    std::int64_t n_missing = 0;
    std::int64_t scoring_version = 1;
};

/// One filled questionnaire.
struct QuestionnaireRunRow {
    std::string participant_id;
    std::string kind;
    std::int64_t session_ordinal = 1;
    std::string session_id;
    std::string protocol_sha256;
    std::string questionnaire;  // its key
    std::string version;
    std::string language;
    std::string definition_text;            // the questionnaire's file
    std::optional<std::string> texts_text;  // the lab's texts, of a template
    std::string moment;
    std::optional<std::int64_t> block_index;
    std::optional<std::string> block;
    std::optional<std::int64_t> trial_index;
    std::optional<std::string> condition;
    std::optional<std::int64_t> condition_position;  // as the protocol lists conditions
    std::string started_utc;
    std::optional<std::string> completed_utc;
    std::vector<ItemResponseRow> responses;
    std::vector<ScoreRow> scores;
};

}  // namespace passung::store
