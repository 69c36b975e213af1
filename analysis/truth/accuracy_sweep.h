#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "analysis/truth/contact_path.h"
#include "core/base/result.h"
#include "core/scene/part.h"
#include "core/scene/scene_spec.h"

namespace passung::truth {

/// One way to ask for a contact: what a scene may choose.
struct AccuracySetting {
    field::FieldMode mode = field::FieldMode::Trilinear;
    double tolerance = 20e-6;  // of FIELD's distance field [m]
    double spacing = 1e-3;     // of SHELL's points [m]
    int budget_nodes = 0;      // 0 = none
};

/// Every combination of the four lists is measured.
struct AccuracySpace {
    std::vector<field::FieldMode> modes{field::kFieldModes.begin(), field::kFieldModes.end()};
    std::vector<double> tolerances{100e-6, 50e-6, 20e-6, 10e-6};  // [m]
    std::vector<double> spacings;                                 // [m]; empty: see defaultSpacings
    std::vector<int> budgets{0, 1000, 300, 100};
    int repetitions = 5;  // a pose's time is its fastest
};

/// Four spacings around a fiftieth of SHELL's longest side (rounded to 1, 2 or 5): 4, 2, 1 and 1/2 times that [m].
std::vector<double> defaultSpacings(double length);

/// Of a number of poses; NaN if there was none. p99: nearest rank.
struct Spread {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double mean = kNone, median = kNone, p99 = kNone, max = kNone;
};
Spread spreadOf(std::vector<double> values);

inline constexpr double kLeastForce = 0.01;

/// What one setting costs and how much it errs. SI units; errors are absolute values against PoseTruth.
struct SettingCost {
    AccuracySetting setting;
    std::size_t points = 0;     // of SHELL
    Spread time = {};           // of a tick's query with its penalty wrench, on its core [s]
    Spread depth = {};          // of the depth, where there is contact or is said to be [m]
    Spread distance = {};       // of the distance, where there is no contact [m]
    Spread distance_time = {};  // of asking for it there, which no tick does [s]
    // At poses whose true force is at least kLeastForce of the largest one: a share of next to nothing says nothing.
    Spread force = {};       // | |F| - |F_true| | / |F_true|
    Spread direction = {};   // angle between F and F_true [rad], where the answer has a force
    Spread torque = {};      // |T - T_true| / (|F_true| · lever)
    double bound_max = 0.0;  // largest error bound that the proven query states [m]
    double field_bytes = 0.0, shell_bytes = 0.0;
    double field_build = 0.0, shell_build = 0.0;          // wall time on all cores, when it was built [s]
    bool on_depth_front = false, on_force_front = false;  // no other row is both faster (p99) and nearer the truth
};

/// shared_ptr: a scene that is asked holds its parts, and more than one has them.
using SharedPart = std::shared_ptr<const scene::Part>;

/// Lets a tick ask at all `poses` and compares the answer with what is known of their truth; times it at `timed`,
/// `repetitions` times each (the fastest counts) after one round that does not count. Fills times, errors, points and
/// memory of a row. Of `contact` count method, variant and two_way: the query is that of the tick's own stages.
/// Wrenches are the area-weighted penalty of the contacts that it finds, whatever the tick makes of them.
/// @pre `field` holds a field, `shell` a shell, for two-way contact both.
SettingCost measureSetting(const AccuracySetting& setting, scene::ContactSpec contact, const SharedPart& field,
                           const SharedPart& shell, const std::vector<JudgedPose>& poses,
                           const std::vector<Pose>& timed, int repetitions, double lever);

/// An answer that contradicts the truth by more than it vouches for.
struct Disagreement {
    AccuracySetting setting;
    Pose X_FS;
    std::string what;
};

struct AccuracyResult {
    std::vector<SettingCost> rows;
    std::vector<Disagreement> disagreements;
    std::size_t compared = 0;   // answers that were compared with FCL and the true depth
    std::size_t undecided = 0;  // of them: the stated bound leaves open whether the surfaces meet
};

using StepReport = std::function<void(const std::string& what, double share)>;

/// Builds FIELD and SHELL at every resolution of `space`, times the query of a tick of the area-weighted penalty at all
/// `poses`, compares it with their truth, and holds the proven query's intervals against the truth there and at
/// `shaken`. `store`, if not null, keeps fields and points from run to run, with the time that building them took.
/// Errors: a part cannot be built.
Result<AccuracyResult> sweepAccuracy(const scene::PartSpec& field, const scene::PartSpec& shell,
                                     const AccuracySpace& space, const std::vector<JudgedPose>& poses,
                                     const std::vector<JudgedPose>& shaken, double lever, const StepReport& report,
                                     scene::BuildStore* store = nullptr);

/// Marks the rows that no other beats in both time (p99) and error (p99): of the depth, and of the force.
void markFronts(std::vector<SettingCost>& rows);

}  // namespace passung::truth
