#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/truth/separation.h"
#include "core/base/types.h"
#include "core/scene/scene_spec.h"

namespace passung::truth {

/// The force of an ideal god object, for pairs whose geometry is known in closed form: that of a spring between the
/// hand and the pose without overlap that has the least energy, ½K(|x_H - x|² + ρ²|φ|²), ρ² = K_φ/K, found anew from
/// a pose that was shown (least_energy.h, separation.h). Neither the contact core nor its closed forms, fields, points,
/// triangles or solver are asked. Pairs: a ball among solids without hollows, a round peg and its bore, boxes and
/// square pegs with each other and in square pockets; with their edges, on edges. Limit cases: no overlap at the hand →
/// no force. A ball on a plane: K times its depth. Of a part that weighs (core/tick/weight.h) the energy is from where
/// the spring and its weight balance; the force is that of the spring to the hand.
class ForceReference {
public:
    explicit ForceReference(const scene::SceneSpec& scene);

    /// Why the scene has none, in one clause; empty if it has one.
    const std::string& missing() const { return missing_; }

    /// On the hand [N], world axes, from the proxy of the tick before on, or the nearest free pose. Nothing where the
    /// pair's case does not hold, or where the way from that proxy is longer than kSnap: past an edge the pose of least
    /// energy depends on how far one went.
    std::optional<Vec3> at(const Pose& X_WG_last, const Pose& X_WH) const;

    /// Of the pose in one tick [m], |(Δx, ρ Δφ)|.
    static constexpr double kSnap = 1e-4;

private:
    std::string missing_;
    double stiffness_ = 0.0, rho_ = 0.0;
    Vec3 weight_ = Vec3::Zero(), centre_ = Vec3::Zero();  // of the held part: world axes [N]; in the part [m]
    std::shared_ptr<const Separation> separation_;        // shared_ptr: the reference can be copied
};

}  // namespace passung::truth
