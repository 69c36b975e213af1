#include "devices/simulated/hold_hand.h"

namespace passung::simulated {

void HoldHand::choose(const Percept& percept) noexcept {
    X_WRef_ = reach_.at(t_);
    if (t_ >= reach_.duration) removeOffset(percept);
}

}  // namespace passung::simulated
