#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "core/base/result.h"
#include "devices/simulated/presets.h"
#include "study/plan/study_plan.h"
#include "study/protocol/calibration.h"

namespace passung::run {

/// Path of a device's calibration: in $XDG_DATA_HOME/passung, or ~/.local/share/passung; empty if neither
/// variable names a folder.
std::string calibrationPath(const std::string& device);

/// Tries on the simulated device, in virtual time, how stiff a wall it bears (loop::StiffnessSearch), translation and,
/// if it is actuated, rotation. A study may use simulated::kStableShare of it, the maker's limit at most. Errors: the
/// softest wall is not calm already.
Result<protocol::Calibration> findStiffness(const simulated::DeviceParams& device);

/// Keeps it for all later runs of this user. Errors: it cannot be written.
Result<Done> keepCalibration(const protocol::Calibration& calibration);

/// Time of the device's last calibration on this machine [Unix time, ms]; nothing: never.
std::optional<std::int64_t> calibratedAt(const std::string& device);

/// What an experimenter is to know who puts the device in place for a session that began at `began_ms` [Unix time]:
/// that it has not been calibrated on this machine since, or bears less than the study keeps for it. Empty: nothing.
std::string calibrationAdvice(const std::string& device, std::span<const plan::StableStiffness> kept,
                              std::int64_t began_ms);

/// The devices with what was found on them. Errors: a file that is there and not sound.
Result<std::vector<DeviceDescription>> withCalibrations(std::vector<DeviceDescription> devices);

/// The presets with the stable maxima that a study's database keeps. One from before they were kept has none.
std::vector<DeviceDescription> devicesAsKept(std::span<const plan::StableStiffness> kept);

/// Tells whether both stand for the same maxima, whatever their origin.
bool sameStiffness(std::span<const plan::StableStiffness> a, std::span<const plan::StableStiffness> b);

/// What differs between the maxima in force now and those that the study keeps, a sentence each.
std::vector<std::string> stiffnessDifferences(std::span<const plan::StableStiffness> now,
                                              std::span<const plan::StableStiffness> kept);

}  // namespace passung::run
