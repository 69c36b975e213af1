#pragma once

#include <string>

namespace passung {

/// What a station file says of the device in one hand.
struct DeviceChoice {
    std::string hand = {};     // name in the station file: kFirstHand, or that of a further hand
    std::string kind = {};     // as a protocol names it: "sigma7"
    std::string backend = {};  // kSimulatedBackend, or one of devices/backends
    std::string serial = {};   // empty: the only unit of that kind
    std::string address = {};  // of the program that serves it, as the backend writes it; empty: where it is by default
    std::string axes = {};     // of the device, as the backend writes them; empty: the backend's
    int heartbeat_ms = 5;      // that a wrench holds without the next; in a station file 2 … 50
};

/// Which unit a session was performed on, as it stores it. Empty: not known.
struct DeviceUnit {
    std::string hand = {}, kind = {}, backend = {}, serial = {};
    std::string model = {};        // as the unit says it
    std::string versions = {};     // of firmware and of the program or library that serves it
    std::string calibration = {};  // what the unit says of its own, and what was set for the session
};

inline constexpr const char* kSimulatedBackend = "simulated";
inline constexpr const char* kAnyKind = "any";      // whatever device does what is needed
inline constexpr const char* kFirstHand = "right";  // in a station file; scenes have no name for it

}  // namespace passung
