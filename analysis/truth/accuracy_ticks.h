#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "analysis/truth/accuracy_sweep.h"
#include "core/scene/scene_spec.h"

namespace passung::truth {

/// One way to render a scene: what its [contact] may say.
struct TickSetting {
    scene::ContactMethod method = scene::ContactMethod::GodObject;
    scene::Geometry geometry = scene::Geometry::Field;  // never Auto
    AccuracySetting field = {};                         // of Geometry::Field only
    bool two_way = false;                               // likewise
};

/// The edge of a field cell with this setting, in a scene whose contact is `own` [m]; 0: chosen from the tolerance. A
/// cell that the scene names belongs to its own tolerance.
double cellOf(const scene::ContactSpec& own, const TickSetting& setting);

/// What is combined. An empty list: all methods, all geometries, the scene's own mode, ways and budget; the scene's own
/// tolerance and spacing, and twice each (a scene that names a cell: its own tolerance alone).
struct TickSpace {
    std::vector<scene::ContactMethod> methods = {};
    std::vector<scene::Geometry> geometries = {};
    std::vector<field::FieldMode> modes = {};
    std::vector<double> tolerances = {}, spacings = {};  // [m]
    std::vector<int> budgets = {};
    std::vector<int> ways = {};  // 1, 2 (two_way)
};

/// The combinations that the scene can have, and in words why the others are left out.
struct TickSettings {
    std::vector<TickSetting> settings;
    std::vector<std::string> left_out;
};
TickSettings tickSettings(const scene::SceneSpec& scene, const TickSpace& space);

/// Of a number of ticks; NaN if there was none. Percentiles by nearest rank.
struct TickSpread {
    double median = Spread::kNone, p999 = Spread::kNone, max = Spread::kNone;
};
TickSpread tickSpreadOf(std::vector<double> values);

/// What one setting costs along a path and how true it is. SI units.
struct PathCost {
    TickSetting setting;
    std::size_t points = 0;                // of the held part's shell; none where there is no shell
    double bytes = 0.0;                    // of fields and shells; of triangles' clusters; of faces and edges
    TickSpread time = {};                  // of a tick on its core, the least of all runs [s]
    TickSpread wall = {};                  // the same by the wall clock [s]
    std::size_t ticks = 0, suspended = 0;  // of the path; whose work went on in the next one
    std::size_t suspended_in_a_row = 0;    // most
    double recorded = 0.0;                 // largest overlap that the ticks themselves record [m]
    std::size_t judged = 0;                // ticks whose overlap was measured
    double overlap = Spread::kNone;        // largest true overlap of what was shown: found [m], and
    double overlap_bound = Spread::kNone;  // what no judged tick exceeds [m]
    std::size_t referenced = 0;            // of the judged ticks: with a force to compare with
    double force_error = Spread::kNone;    // largest | |F| - |F_ref| | [N]
    Spread force = {};                     // | |F| - |F_ref| | / |F_ref|, where |F_ref| ≥ kLeastForce of the largest
    Spread direction = {};                 // angle between F and F_ref there [rad]
    TickSpread grain = {};                 // of the spring's force from tick to tick, beyond the hand's own [N]
    bool on_overlap_front = false, on_force_front = false;  // no other row is both faster (p99.9) and nearer the truth
};

struct TickEffort {
    int repetitions = 5;  // timed runs of the same path: a tick's time is its least
    int every = 20;       // of so many ticks one is judged, besides those of largest recorded overlap and force
};

struct TickAccuracy {
    std::vector<PathCost> rows;
    std::vector<std::string> notes;  // why forces were not compared
};

/// Runs the scene along `path` (the held part in the world, one pose a millisecond; nan: a broken sensor) with every
/// setting, and judges what it shows and how it feels.
///   overlap   exact_overlap.h: at every `every`-th tick, and at the 20 of largest recorded overlap and of largest
///             force. Of a direct penalty the shown part is where the hand is.
///   force     of the spring alone: no damper of a direct penalty, no effects, limits or delay, which are the scene's
///             business. Against force_reference.h: never against a setting of ours.
///   grain     |ΔF| - K |ΔX_H|, at least 0, |ΔX_H| in the coupling's metric: where the free space is convex around the
///             pose no spring to its nearest pose changes faster, since that projection does not expand.
///   time      of the scene as it is, effects and limits included.
/// All but times are the same for the same input. `report` may throw to give up. Registration and start gate are left
/// out, as in `simulate`. Errors: buildScene's. @pre a path, settings of tickSettings.
Result<TickAccuracy> measureTicks(const scene::SceneSpec& scene, std::span<const Pose> path,
                                  const std::vector<TickSetting>& settings, const TickEffort& effort,
                                  const StepReport& report, scene::BuildStore* store = nullptr);

/// Marks the rows that no other beats in both time (p99.9) and error: of the overlap's bound, and of the force.
void markTickFronts(std::vector<PathCost>& rows);

}  // namespace passung::truth
