#include "analysis/export/status_bits.h"

namespace passung::exporter {

// Without a default: the compiler warns of a bit that has no words here.
const char* statusBitMeaning(TickStatus bit) {
    switch (bit) {
        case kStatusOk:
            break;
        case kInputHeld:
            return "bad device input, the last good pose was used";
        case kInputRejected:
            return "no usable device input, no force";
        case kDeviceStale:
            return "no fresh device input";
        case kNonFiniteLatched:
            return "a computed force was not finite, no force until re-armed";
        case kForceLimited:
            return "limited to the device's largest force or torque";
        case kRateLimited:
            return "rising force limited";
        case kBudgetReached:
            return "a contact query stopped at its node budget";
        case kIterationLimit:
            return "the proxy stopped at its largest number of sub-steps and lags";
        case kContactCap:
            return "more contact points than can be held";
        case kStepRejected:
            return "the proxy's step was shortened";
        case kOverrun:
            return "the cycle before ended after its deadline";
        case kInputNotAPose:
            return "device input that is no pose";
        case kInputJump:
            return "device input farther away than the device can have moved";
        case kInputRelocated:
            return "the device is believed to be elsewhere after jumps that agreed";
        case kPassivityActed:
            return "the passivity controller added a damper";
        case kEngaged:
            return "engaged: the hand has reached the start pose and contact is rendered (nothing to worry about)";
        case kWrenchWithheld:
            return "the condition displays no force (nothing to worry about)";
        case kSuspended:
            return "the tick's work was cut short and goes on in the next one: the proxy lags";
        case kLedOut:
            return "the held part was put where it overlaps: it is led out, and no contact counts";
        case kWeighed:
            return "the held part's weight is in the force (nothing to worry about)";
        case kAidedInAir:
            return "viscosity, a guide, snap, inertia or keeping apart is in the force (nothing to worry about)";
    }
    return nullptr;
}

std::string statusBitsText() {
    std::string text = "0 = nothing to report, else the sum of: ";
    bool first = true;
    for (unsigned i = 0; i < 32; ++i) {
        const char* meaning = statusBitMeaning(static_cast<TickStatus>(1u << i));
        if (meaning == nullptr) continue;
        text += (first ? "" : "; ") + std::to_string(1u << i) + " = " + meaning;
        first = false;
    }
    return text;
}

}  // namespace passung::exporter
