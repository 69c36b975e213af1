#include "study/run/machine/calibration.h"
#include "study/run/files/known_names.h"
#include "study/run/files/protocol_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "core/loop/stiffness_search.h"
#include "devices/simulated/device_dynamics.h"
#include "study/run/files/data_folder.h"
#include "study/run/files/disk_store.h"

namespace passung::run {

namespace {

std::string fileName(const std::string& device) { return device + ".calibration.toml"; }

/// The largest calm stiffness; 0: none.
double searchOn(const simulated::DeviceParams& device, const loop::StiffnessSearchParams& params) {
    simulated::DeviceDynamics dynamics(device, {});
    loop::StiffnessSearch search(params);
    while (!search.finished()) {
        dynamics.command(search.step(DeviceReading{dynamics.readPose()}));
        dynamics.advance({});
    }
    return search.calm();
}

/// What a study may use of `calm`; `vendor` 0: not known.
double usable(double calm, const simulated::Sourced& vendor) {
    const double share = simulated::kStableShare * calm;
    return vendor.value > 0.0 ? std::min(share, vendor.value) : share;
}

bool same(const plan::StableStiffness& a, const plan::StableStiffness& b) {
    return a.device == b.device && a.linear == b.linear && a.rotational == b.rotational;
}

}  // namespace

std::string calibrationPath(const std::string& device) {
    const auto folder = dataFolder();
    return folder.empty() ? "" : (folder / fileName(device)).string();
}

Result<protocol::Calibration> findStiffness(const simulated::DeviceParams& device) {
    const DeviceDescription rated = simulated::describe(device);
    protocol::Calibration found;
    found.device = rated.name;
    found.damping = rated.recommended_damping_Ns_per_m;
    found.rotational_damping = rated.recommended_rotational_damping_Nms_per_rad;
    constexpr double kFirst = 0.1, kHighest = 100.0;  // of the rated stiffness
    constexpr double kMostTurn = 1.0;                 // [rad]
    found.calm_stiffness = searchOn(device, {.damping = found.damping,
                                             .first = kFirst * rated.stable_stiffness_N_per_m,
                                             .highest = kHighest * rated.stable_stiffness_N_per_m,
                                             .max_force = rated.max_force_N,
                                             .max_travel = rated.workspace_radius_m});
    found.stable_stiffness = usable(found.calm_stiffness, device.vendor_stiffness);
    bool calm = found.calm_stiffness > 0.0;
    if (rated.actuated_degrees >= 6) {
        const double stiffness = rated.stable_rotational_stiffness_Nm_per_rad;
        found.calm_rotational_stiffness = searchOn(device, {.rotation = true,
                                                            .damping = found.rotational_damping,
                                                            .first = kFirst * stiffness,
                                                            .highest = kHighest * stiffness,
                                                            .max_force = rated.max_torque_Nm,
                                                            .max_travel = kMostTurn});
        found.rotational_stiffness = usable(found.calm_rotational_stiffness, device.vendor_rotational_stiffness);
        calm = calm && found.calm_rotational_stiffness > 0.0;
    }
    if (!calm)
        return Error{.message = "does not come to rest even at a tenth of its rated stiffness: nothing is kept",
                     .key = "device",
                     .value = rated.name};
    return found;
}

Result<Done> keepCalibration(const protocol::Calibration& calibration) {
    const auto folder = dataFolder();
    const Error failed{.message = "the calibration cannot be written", .file = calibrationPath(calibration.device)};
    if (folder.empty()) return failed;
    const std::string text = protocol::calibrationText(calibration);
    DiskStore store(folder);
    store.keep(fileName(calibration.device), text);
    if (store.load(fileName(calibration.device)) != text) return failed;
    return Done{};
}

std::optional<std::int64_t> calibratedAt(const std::string& device) {
    struct stat file {};
    const std::string path = calibrationPath(device);
    if (path.empty() || stat(path.c_str(), &file) != 0) return std::nullopt;
    return std::int64_t{file.st_mtim.tv_sec} * 1000 + file.st_mtim.tv_nsec / 1'000'000;
}

std::string calibrationAdvice(const std::string& device, std::span<const plan::StableStiffness> kept,
                              std::int64_t began_ms) {
    const std::string remedy = fmt::format("`passung doctor --device {} --find-stiffness` does it", device);
    const auto calibrated = calibratedAt(device);
    if (!calibrated) return fmt::format("{} has never been calibrated on this machine: {}", device, remedy);
    const auto found = protocol::readCalibration(calibrationPath(device));
    if (!found) return toString(found.errors().front());
    for (const plan::StableStiffness& stable : kept) {
        if (stable.device != device) continue;
        if (found->stable_stiffness < stable.linear || found->rotational_stiffness < stable.rotational)
            return fmt::format(
                "{} bears {:.6g} N/m and {:.6g} Nm/rad by its calibration, less than the {:.6g} N/m and {:.6g} Nm/rad "
                "that this study keeps for it: it may not stay calm",
                device, found->stable_stiffness, found->rotational_stiffness, stable.linear, stable.rotational);
    }
    if (*calibrated < began_ms)
        return fmt::format("{} has not been calibrated since this session began: {}", device, remedy);
    return "";
}

Result<std::vector<DeviceDescription>> withCalibrations(std::vector<DeviceDescription> devices) {
    Errors errors;
    for (DeviceDescription& device : devices) {
        const std::string path = calibrationPath(device.name);
        if (path.empty() || !std::filesystem::exists(path)) continue;
        const auto found = protocol::readCalibration(path);
        auto with = found ? protocol::calibrated(device, *found, path) : found.errors();
        if (with)
            device = std::move(*with);
        else
            errors.insert(errors.end(), with.errors().begin(), with.errors().end());
    }
    if (!errors.empty()) return errors;
    return devices;
}

std::vector<DeviceDescription> devicesAsKept(std::span<const plan::StableStiffness> kept) {
    std::vector<DeviceDescription> devices = presetDevices();
    for (DeviceDescription& device : devices)
        for (const plan::StableStiffness& stable : kept) {
            if (stable.device != device.name) continue;
            device.stable_stiffness_N_per_m = stable.linear;
            device.stable_rotational_stiffness_Nm_per_rad = stable.rotational;
            device.stability_source = stable.origin;
        }
    return devices;
}

bool sameStiffness(std::span<const plan::StableStiffness> a, std::span<const plan::StableStiffness> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

std::vector<std::string> stiffnessDifferences(std::span<const plan::StableStiffness> now,
                                              std::span<const plan::StableStiffness> kept) {
    std::vector<std::string> sentences;
    for (std::size_t i = 0; i < std::min(now.size(), kept.size()); ++i) {
        const auto &a = now[i], &b = kept[i];
        if (same(a, b)) continue;
        sentences.push_back(fmt::format(
            "the study keeps the stable maximum of {} with which it began, {:.6g} N/m and {:.6g} Nm/rad ({}); on this "
            "machine it is now {:.6g} N/m and {:.6g} Nm/rad ({})",
            b.device, b.linear, b.rotational, b.origin, a.linear, a.rotational, a.origin));
    }
    return sentences;
}

}  // namespace passung::run
