#include "core/motion/friction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/friction_balance.h"

namespace passung::motion {

FrictionMotion constrainWithFriction(const Motion& wanted, const Surroundings& around,
                                     std::span<const Friction> friction, const FrictionPatches& before,
                                     std::span<const std::uint32_t> likely) noexcept {
    FrictionMotion result;
    result.motion = constrainMotion(wanted, around, likely);
    const bool smooth =
        std::all_of(friction.begin(), friction.end(), [](const Friction& f) { return f.at_rest == 0.0; });
    if (smooth || result.motion.active == 0) return result;
    return balanceFriction(wanted, around, friction, before, result.motion);
}

FrictionMotion balanceFriction(const Motion& wanted, const Surroundings& around, std::span<const Friction> friction,
                               const FrictionPatches& before, const ConstrainedMotion& likely) noexcept {
    return FrictionBalance(wanted, around, friction, likely, before).find();
}

}  // namespace passung::motion
