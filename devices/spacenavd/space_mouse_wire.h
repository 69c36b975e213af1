#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/types.h"
#include "devices/unit/axes.h"

namespace passung::spacenavd {

/// Deflection of the cap, in the counts of the daemon: translation x, y, z, rotation about them.
struct Deflection {
    std::array<std::int32_t, 6> counts{};
};
struct Button {
    int number = 0;  // from 0
    bool pressed = false;
};
struct Name {
    std::string piece;  // up to 24 letters
    bool ends = false;
    bool known = false;  // a mouse is served
};
struct MouseRemoved {};
struct Nothing {};  // what is of no use here, such as a changed setting
struct Broken {};   // no frame of spacenavd's: the stream is shifted, or another program's
using Frame = std::variant<Deflection, Button, Name, MouseRemoved, Nothing, Broken>;

inline constexpr std::uint32_t kProtocol1 = 0x7faa5501;  // asked for, and answered, by these four bytes alone
inline constexpr std::int32_t kAskName = 0x7faa2000;

/// Cuts a daemon's bytes into frames of 32 bytes, int32[8] of this machine: type, six numbers, one more. The reply of
/// four bytes to kProtocol1 may stand between any two of them, for a frame that was on its way comes before it.
class FrameCutter {
public:
    void add(std::string_view bytes) { bytes_.append(bytes); }
    /// The next whole frame; none: more bytes have to come. After Broken nothing that follows can be trusted.
    std::optional<Frame> next();

private:
    std::string bytes_;
};

inline constexpr double kFullCounts = 350.0;  // what a cap gives at its stop
inline constexpr double kFullSpeed = 0.1;     // [m/s] there, proposed
inline constexpr double kFullSpin = 1.0;      // [rad/s]

/// Right, away from the user, up: libspnav turns objects of a scene with x right, y up, z towards the user by (x, y,
/// -z) of both halves (spnav_posrot_moveobj of 1.0), which is (x, z, y) in ours.
inline constexpr const char* kDefaultAxes = "x z y";

/// Speed of the handle for this deflection; beyond the stop it is that at the stop.
Twist twistOf(const Deflection& deflection, const unit::Axes& axes);
/// The deflection for this speed, to the nearest count.
Deflection deflectionFor(const Twist& V_D_B, const unit::Axes& axes);

}  // namespace passung::spacenavd
