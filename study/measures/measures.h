#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/tick_record.h"

namespace passung::measures {

/// What a trial ended with.
enum class Outcome { Success, Failure, Timeout, Aborted };
const char* outcomeName(Outcome outcome);  // as stored
std::optional<Outcome> outcomeNamed(std::string_view name);

/// What measures of one type of trial need to know; poses and lengths in the frame of TrialContext::X_WT.
struct PassageFacts {
    double length = 0.0;  // [m] from z = 0 along -z
    double width = 0.0;   // [m]
};
struct ContourFacts {
    std::vector<Vec3> points;  // corners of the line [m]
    double reach = 0.0;        // [m]
    double force = 0.0;        // asked for [N]
};
struct PlacementFacts {
    bool round = false;  // turning about z is no error; X_WT is the goal
};
struct PairFacts {
    int comparison_interval = 1;  // 1 or 2
};

/// What became of a step of an assembly. Times in haptic periods after the trial's start.
struct StepResult {
    std::optional<std::int64_t> picked = {};  // its part was taken for the first time
    std::optional<std::int64_t> done = {};    // and has stayed so; none: it was not done at the end
    std::int64_t place = 0;                   // among the steps done at the end, from 1 in time; 0: it was not
    std::int64_t picks = 0;                   // the part was taken: into a hand from none
    std::int64_t drops = 0;                   // it was let go elsewhere than at its goal
    std::int64_t order_errors = 0;            // it was let go at its goal before steps that come before
    std::int64_t undos = 0;                   // it was done, and was not any more
    std::int64_t hints = 0;                   // a hint came up that leads to it
    std::uint32_t hands = 0;                  // that held the part: bit 0 the first hand
    std::int64_t held_periods = 0;            // that it was in a hand
    double path = 0.0;                        // of the part's origin in the hands [m]
    double peak_force = 0.0;                  // on a hand that held it [N]
    // Of the part at the end, from its goal
    double position_error = 0.0;           // [m]
    double angle_error = 0.0;              // [rad], turns that make no difference left out
    std::optional<double> free_path = {};  // length of a collision-free path, of the protocol [m], > 0

    /// Way in the hands over the free path of a step that is done at the end; none: it is not, or no path is known.
    std::optional<double> pathRatio() const {
        if (!done || !free_path) return std::nullopt;
        return path / *free_path;
    }
    friend bool operator==(const StepResult&, const StepResult&) = default;
};
struct AssemblyFacts {
    std::vector<StepResult> steps;
};

/// What became of a stimulus of a secondary task, or of a press without one.
enum class DetectionResult { Hit, Miss, FalseAlarm, NotScored };
const char* detectionResultName(DetectionResult result);  // as stored
std::optional<DetectionResult> detectionResultNamed(std::string_view name);

/// A stimulus with its response, or a press that answers none. Haptic periods after the attempt's tick 0.
struct Detection {
    DetectionResult result = DetectionResult::NotScored;
    std::optional<std::int64_t> stimulus = {}, off = {};  // its command goes to 1, and back to 0
    std::optional<std::int64_t> response = {};            // the press
    friend bool operator==(const Detection&, const Detection&) = default;
};

/// How deep the held parts and the obstacles truly reached into each other at a tick, as shown (X_WG of its records),
/// and why this tick was judged. The depth lies in [depth, bound] [m].
struct TickOverlap {
    std::int64_t tick = 0;
    bool every_20th = false;     // every 20th tick in contact
    bool largest_depth = false;  // one of the 20 of largest recorded proxy_depth_m
    bool largest_force = false;  // one of the 20 of largest |force|
    double depth = 0.0, bound = 0.0;
    friend bool operator==(const TickOverlap&, const TickOverlap&) = default;
};

/// What the measures need to know of a trial beside its records.
struct TrialContext {
    std::int64_t start_tick = 0;  // the hand held the start pose: contact on, "go" shown
    std::int64_t end_tick = 0;    // success, time-out or abort; before start_tick: the trial never started
    Outcome outcome = Outcome::Success;
    Pose X_WT;                        // target: origin at the bore's mouth, bore along -z
    double leave_radius = 0.020;      // [m]
    double engagement_depth = 0.001;  // [m]
    double clearance = 0.0;           // [m] radial, of the held peg in the target's bore
    double motion_bandwidth = 10.0;   // [Hz] of what counts as the hand's motion (smooth_motion.h), > 0
    std::variant<std::monostate, PassageFacts, ContourFacts, PlacementFacts, PairFacts, AssemblyFacts>
        form;             // first: peg in hole
    bool watched = true;  // false: real parts, which no device feels; only times and outcome are known
    std::optional<std::vector<Detection>> detections = {};  // of the secondary task, where there is one
    std::vector<TickOverlap> overlaps = {};                 // of the ticks that were judged; none: not measured
};

/// A measure's definition: name (the column; its unit is the suffix), label, unit, formula.
struct MeasureDefinition {
    std::string name;
    std::string label;
    std::string unit;     // "s", "m", "N", "1" …
    std::string formula;  // exact words: what is summed over which ticks
    int version = 1;
    std::string of_hands = {};  // what it is in scenes of several hands; empty: as the formula says
};

/// The formula as it holds in a study whose scenes have so many hands at most, and its number: what is said of several
/// hands counts as a change of the formula.
std::string formulaOf(const MeasureDefinition& definition, std::size_t hands);
int versionOf(const MeasureDefinition& definition, std::size_t hands);

/// All measures, in column order.
const std::vector<MeasureDefinition>& definitions();

struct Value {
    std::string name;
    std::optional<double> value;  // empty: not defined for this trial (e.g. insertion time without insertion)
};

/// Tells whether the measure is known of a trial that no device feels: those of the secondary task are, where there is
/// one.
bool isKnownUnwatched(std::string_view measure);

/// Tells whether the measure counts ticks with a status bit: how the loop did, not what the person did.
bool countsTicks(std::string_view measure);

/// Every measure of one trial from its recorded ticks, in the order of definitions().
///   What hands do is measured of all of them: paths, impulse and work are summed, peaks are the largest of any hand,
/// means are over the contact ticks of each (MeasureDefinition::of_hands). What a type of trial judges is the first
/// hand's part.
/// `records` are in order of their ticks; those outside [start_tick, end_tick] are ignored. The formulas take them as
/// consecutive: where records are missing, a step spans the gap; times count a missing tick as one period, sums over
/// ticks leave it out. Of a trial that is not watched all but success, finished, its times and the secondary task's are
/// empty: isKnownUnwatched().
/// `hands`: of a scene with several, what was recorded of each, the first included, in the world; `records` are then
/// the first hand's as the trial is judged (session::HandsView). Empty: one hand, whose records they are. Only stored
/// values enter, so every measure can be computed again from an export of the samples.
std::vector<Value> computeMeasures(std::span<const TickRecord> records, const TrialContext& context,
                                   std::span<const std::span<const TickRecord>> hands = {});

}  // namespace passung::measures
