#pragma once

#include <cstdint>

#include "core/base/tick_record.h"
#include "core/base/types.h"

namespace passung::loop {

/// How the search goes; the values of rotation are N·m/rad, N·m·s/rad, N·m, rad.
struct StiffnessSearchParams {
    bool rotation = false;    // turns the handle instead of moving it
    double damping = 0.0;     // B of the wall, recommended by the device [N·s/m], ≥ 0
    double first = 0.0;       // stiffness to begin with [N/m], > 0
    double highest = 0.0;     // that is tried [N/m], > first
    double max_force = 0.0;   // never exceeded [N], > 0
    double max_travel = 0.0;  // from the anchor; farther counts as unstable [m], > 0
};

/// Finds how stiff a spring a device bears, by trying: nobody holds the handle, a spring and damper of the candidate
/// stiffness hold it where it is. For each axis
///   press:   a force grows slowly up to 0.8 of the limit and stays,
///   release: it is gone at once, the handle swings,
///   idle:    the swing is watched.
/// The stiffness grows step by step as long as the handle is calm on every axis. At the first sign that it is not the
/// spring is gone in that very tick, the damper alone brings the handle to rest, and the step is halved in the
/// logarithm, below the stiffness that failed; it ends when a step is 1 %. Signs, besides a demand of twice the force
/// limit, more way than allowed and far more energy given out than the press put in:
///   - the swing's largest deviation in a late stretch is not below that in an early one;
///   - peaks A_i of the swing, one per half period: dry friction takes the same from each, everything else a share,
///         A_i+1 = g A_i - c,
///     and g, fitted, is above 1. So friction, which stops every swing that the force limit allows to begin, does not
///     hide that larger ones would grow: what is found is the border that the linear model has without friction.
/// A plain value that a loop drives, one call a tick; rt-safe.
class StiffnessSearch {
public:
    explicit StiffnessSearch(const StiffnessSearchParams& params);

    /// What to command for this reading: about the handle's origin, base frame. Zero when finished.
    Wrench step(const DeviceReading& reading) noexcept;

    bool finished() const noexcept { return phase_ == Phase::Finished; }
    /// The largest stiffness that was calm on all axes; 0: not even the first [N/m].
    double calm() const noexcept { return calm_; }
    /// The smallest that was not; `highest` was calm: 0 [N/m].
    double unstable() const noexcept { return unstable_; }

private:
    enum class Phase { Settle, Press, Idle, Finished };

    void enter(Phase phase) noexcept;
    void begin(double stiffness) noexcept;
    void judge() noexcept;
    void fail() noexcept;
    Vec3 way(const Pose& X_BD) const noexcept;
    Wrench wrench() const noexcept;
    bool watch(const Vec3& x, const Vec3& last) noexcept;
    void countPeaks(double x) noexcept;
    bool rests() const noexcept;

    StiffnessSearchParams params_;
    Phase phase_ = Phase::Settle;
    std::int64_t ticks_ = 0;  // in the phase
    int axis_ = 0;
    double stiffness_ = 0.0;
    double calm_ = 0.0, unstable_ = 0.0;
    double growth_ = 1.25;
    Pose anchor_;
    Vec3 last_ = Vec3::Zero();         // reading before, relative to the anchor
    Vec3 force_ = Vec3::Zero();        // commanded last
    double early_ = 0.0, late_ = 0.0;  // largest deviations
    double peak_ = 0.0;                // of the running half period
    double before_ = 0.0;              // peak of the one before it; 0: none
    bool positive_ = false;            // the side on which it swings
    int pairs_ = 0;                    // of neighbouring peaks, and their sums
    double sum_x_ = 0.0, sum_y_ = 0.0, sum_xx_ = 0.0, sum_xy_ = 0.0;
    double given_ = 0.0;   // to the handle since the release [J]
    double stored_ = 0.0;  // in the spring at the release [J]
    double step_ = 0.0;    // smallest change of a reading that was seen: the encoder's
};

}  // namespace passung::loop
