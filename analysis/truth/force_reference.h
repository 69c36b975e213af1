#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/scene/scene_spec.h"

namespace passung::truth {

/// A condition that a motion u = (Δx, ρ Δφ) of the held part has to obey: along · u ≥ -gap, lengths [m].
struct FreedomRow {
    Eigen::Matrix<double, 6, 1> along;
    double gap = 0.0;
};

/// The motion nearest to `pull` that obeys all `rows`; nothing if there is none.
///   min ½|u - w|²  s.t.  A u ≥ -g,  by the dual of Lawson and Hanson (1974), chapter 23: least distance programming as
///   non-negative least squares. Written apart from core/motion, for it is to judge what that finds.
std::optional<Eigen::Matrix<double, 6, 1>> leastMotion(const std::vector<FreedomRow>& rows,
                                                       const Eigen::Matrix<double, 6, 1>& pull);

/// The force of an ideal god object, for pairs whose geometry is known in closed form: that of a spring between the
/// hand and the pose without overlap that has the least energy, ½K(|x_H - x|² + ρ²|φ|²), ρ² = K_φ/K, found anew from
/// the pose that was shown. Neither the contact core nor its fields, points, triangles or solver are asked.
///   ball      a held ball among solids without hollows (ball, box, cylinder, peg, square peg): its centre keeps its
///             radius from each, by the exact signed distance.
///   peg       a round peg in a bore: dense points of the four circles that touch, against the other part's faces;
///   while
///             the peg's tip is below the mouth's chamfer and its far end above the mouth.
/// Limit cases: no overlap at the hand → no force. A ball on a plane: K times its depth.
class ForceReference {
public:
    explicit ForceReference(const scene::SceneSpec& scene);

    /// Why the scene has none, in one clause; empty if it has one.
    const std::string& missing() const { return missing_; }

    /// On the hand [N], world axes. Nothing where the pair's case does not hold, or no pose was found.
    std::optional<Vec3> at(const Pose& X_WG, const Pose& X_WH) const;

    /// By how much a force may err because points lie on chords [N].
    double uncertainty() const { return uncertainty_; }

private:
    struct Peg;

    bool rowsAt(const Pose& X_WG, std::vector<FreedomRow>& rows) const;

    std::string missing_;
    double stiffness_ = 0.0, rho_ = 0.0, uncertainty_ = 0.0;
    double radius_ = 0.0;  // of a held ball [m]
    struct Solid {
        shape::Shape shape;
        Pose X_WS;
    };
    std::vector<Solid> solids_;
    std::shared_ptr<const Peg> peg_;  // shared_ptr: the reference can be copied
};

}  // namespace passung::truth
