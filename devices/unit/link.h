#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>

#include "core/base/device_unit.h"
#include "core/base/result.h"
#include "core/base/types.h"

namespace passung::unit {

/// What a unit has said last. Of a unit that gives speeds, such as a SpaceMouse, the pose means nothing, and of one
/// that gives poses the speed.
struct Said {
    Pose X_BD;
    Twist V_D_B;
    std::uint32_t buttons = 0;
    double grip_rad = std::numeric_limits<double>::quiet_NaN();
};

/// What came of one exchange over a link.
struct Exchange {
    enum class Kind {
        Silence,  // nothing came within the time
        News,     // what the unit says has come
        Stale,    // nothing came where something must have
        Wrong,    // something came that cannot be
        Gone,     // the unit, or what serves it
    };
    Kind kind = Kind::Silence;
    Said said;
    std::string why;  // of Stale, Wrong and Gone; of News what is to be told beside, if anything
};

/// The wire to one unit: what differs between backends. Used by one thread of its own; may wait, allocate and throw.
class Link {
public:
    virtual ~Link() = default;
    /// Finds and opens the unit of the choice that the link was made with. Errors: why not, in words that a lab
    /// engineer can act on.
    virtual Result<DeviceUnit> open() = 0;
    /// Gives the wrench, which is within the unit's limits, where the unit takes one, and what the unit has said since,
    /// or the reply to it. Waits for `longest` at most.
    virtual Exchange exchange(const Wrench& F_D_B, std::chrono::milliseconds longest) = 0;
    /// Before it: when the loop made that wrench [ns on the steady clock], for a link whose other side lets go of one
    /// that is too old. What was late on its way would hold longer than a heartbeat.
    virtual void stamp(std::int64_t /*made_at*/) noexcept {}
    virtual void close() noexcept = 0;
};

}  // namespace passung::unit
