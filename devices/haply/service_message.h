#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/types.h"

namespace passung::haply {

/// Filters of a device that stand between a command and the motors.
struct Filters {
    std::optional<double> gate_gain;  // force_gate: the force is multiplied by it while the service sees an oscillation
    std::optional<double> damping;
};

/// What a message of the service says of one Inverse3. What is not a finite number is not there.
struct SaidOfDevice {
    std::string id;
    std::optional<Vec3> position, velocity;  // of the cursor [m], [m/s]
    std::optional<Quat> body, grip;          // orientation of the body, and of the grip of the same place in its list
    std::uint32_t buttons = 0;               // of the grip: a, b, c
    std::optional<bool> calibrated;
    // Of the first message only.
    std::string firmware, basis;
    Filters filters;
};

/// One message of the simulation channel; nothing if it is none. Keys may come in any order, and others beside them.
std::optional<std::vector<SaidOfDevice>> readMessage(std::string_view text);

/// A message that commands this force [N] to that device, for this message alone, and with `open_gate` sets its filters
/// so that nothing changes the force.
std::string forceMessage(const std::string& id, const Vec3& force, bool open_gate);

/// What an event of the event channel means for the device of this id; empty: nothing against it.
std::string harmOf(std::string_view event, const std::string& id);

/// B's origin in the service's frame, x right, y forward, z up: the cursor's in the documented example, proposed as the
/// middle of the workspace.
inline const Vec3 kMiddle(0.0, -0.12, 0.15);
Vec3 toBase(const Vec3& cursor);
Vec3 toCursor(const Vec3& base);

}  // namespace passung::haply
