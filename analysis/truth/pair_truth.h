#pragma once

#include <memory>

#include "analysis/truth/mesh_oracle.h"
#include "analysis/truth/surface_tree.h"
#include "core/base/result.h"
#include "core/scene/part.h"

namespace passung::truth {

/// κ of all wrenches of the penalty that are compared [N/m³].
inline constexpr double kAreaStiffness = 1e9;

/// What is true at one pose of SHELL in FIELD.
struct PoseTruth {
    Relation relation = Relation::Apart;  // by FCL; A: FIELD, B: SHELL
    double separation = 0.0;              // of the surfaces, by FCL [m]; 0 if they intersect
    double distance = 0.0;                // smallest signed distance of SHELL's surface from FIELD [m]; < 0: depth;
                                          // NaN where it was not asked for
    double uncertainty = 0.0;             // of both [m]
    Wrench wrench;                        // on SHELL about its origin, in FIELD's axes; zero without contact
    double wrench_uncertainty = 0.0;      // share of |force|, and of |force| · lever for the torque, estimated
    bool inContact() const { return distance < 0.0; }
};

/// Truth about two parts, by nothing that the contact core uses: FCL on finely tessellated surfaces for intersection
/// and separation; depth by branch and bound over SHELL's whole surface; the penalty wrench by a dense sum over it. The
/// distances from FIELD in both are a shape's closed form, or the exact distances to a mesh's triangles.
/// Built once, then const and thread-safe.
class PairTruth {
public:
    /// Errors: a part cannot be built; FIELD is not watertight, for there is no depth without an inside.
    static Result<PairTruth> build(const scene::PartSpec& field, const scene::PartSpec& shell,
                                   scene::BuildStore* store = nullptr);

    /// @pre `X_FS` finite.
    PoseTruth at(const Pose& X_FS) const;

    /// The same pair with shapes tessellated twenty times as coarsely (by 5 µm off their surfaces): many times as fast,
    /// to search for poses. Of two meshes this one itself.
    const PairTruth& rough() const { return rough_ ? *rough_ : *this; }

    /// What FCL and ray parity say; the distance only where it is the separation, and that does not contradict them.
    PoseTruth relationAt(const Pose& X_FS) const;

    /// PoseTruth without the wrench, its depth to `resolution` [m] unless `max_pieces` ended the search.
    PoseTruth distanceAt(const Pose& X_FS, double resolution, std::size_t max_pieces = kNoLimit) const;

    /// What is true, in a fraction of a second wherever SHELL is: where faces lie along each other the depth is as near
    /// to the truth as ever, but the proof of it is left out and the uncertainty large; the sum is half as dense.
    PoseTruth quicklyAt(const Pose& X_FS) const;

    const geometry::Bounds& fieldBounds() const { return oracle_->a().bounds(); }
    const geometry::Bounds& shellBounds() const { return oracle_->b().bounds(); }
    /// Longest side of SHELL [m].
    double length() const { return shellBounds().size().maxCoeff(); }
    /// Distance of SHELL's farthest point from its origin [m]: the lever of its torques.
    double lever() const { return lever_; }

private:
    static Result<PairTruth> build(const scene::PartSpec& field, const scene::PartSpec& shell, double tolerance,
                                   scene::BuildStore* store);
    PairTruth(scene::Part field, scene::Part shell);
    void addWrench(const Pose& X_FS, double edge, PoseTruth& truth) const;
    Solid solid() const { return {oracle_->a(), field_.shape ? &*field_.shape : nullptr, field_.chord_error}; }

    scene::Part field_, shell_;
    std::unique_ptr<MeshOracle> oracle_;
    std::unique_ptr<SurfaceTree> surface_;
    std::unique_ptr<PairTruth> rough_;
    double lever_ = 0.0;
};

/// Two-way contact at `X_FS`: the depth of the surface that is deeper in the other, and the mean of both wrenches.
/// `back`: what is true of FIELD in SHELL, at the inverse pose.
PoseTruth bothWays(const PoseTruth& there, const PoseTruth& back, const Pose& X_FS);

}  // namespace passung::truth
