#include "core/tick/followed_part.h"

#include <limits>

#include "core/tick/contact_energy.h"

namespace passung::tick {

void followOther(const HandModel&, const FollowedPart& shared, Proxy& proxy, Pushes& pushes, ContactRecord& record,
                 HandDepth& depth) noexcept {
    proxy.X_WG = shared.X_WShared;
    clearPushes(pushes);
    for (const std::uint32_t i : shared.shared_pressures.held()) pushes.pushes[i].pressure = shared.shared_pressures[i];
    record = shared.shared_record;
    depth.hand_depth = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace passung::tick
