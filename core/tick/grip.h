#pragma once

#include "core/base/types.h"

namespace passung::tick {

/// How a hand holds its part. Nobody writes it but step(), where hands pick parts up and let them go (pick.h).
struct Grip {
    static constexpr bool kOnlyRead = true;
    Pose X_DG;                 // held part in the handle
    Vec3 p_GC = Vec3::Zero();  // the point of it that the hand holds and the coupling's springs act on, in the part [m]
    bool shared = false;       // another hand holds the part too

    /// From the part's origin to that point, world axes, with the part turned by `R_WG` [m].
    Vec3 leverOf(const Quat& R_WG) const noexcept { return R_WG * p_GC; }
};

}  // namespace passung::tick
