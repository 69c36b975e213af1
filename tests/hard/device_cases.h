#pragma once

#include <vector>

#include "devices/simulated/presets.h"
#include "tests/hard/case.h"

namespace passung::hard {

/// Cases with a simulated device in the loop: what is rendered moves the handle, whose encoders say where it is.
std::vector<Case> deviceCases();

/// The readings of a device that a hand holds (the impedance of simulated::HandParams, without tremor), which means the
/// held part to follow `path`. It begins at rest at `start`.
Drive inHand(const simulated::DeviceParams& device, const Pose& start, Drive path);

}  // namespace passung::hard
