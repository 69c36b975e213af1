#include "study/protocol/calibration.h"

#include <fmt/format.h>

#include "core/base/json.h"
#include "core/base/regular_file.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

Result<Calibration> readCalibration(const std::string& path) {
    const auto text = readFile(path);
    if (!text) return text.errors();
    const auto document = parseDocument(*text, path);
    if (!document) return document.errors();
    Errors errors;
    const TableReader read(*document, {"calibration"}, "", errors);
    Calibration found;
    found.device = read.text("device");
    found.stable_stiffness = read.number("stable_stiffness_N_per_m");
    found.rotational_stiffness = read.number("stable_rotational_stiffness_Nm_per_rad");
    found.calm_stiffness = read.number("calm_stiffness_N_per_m");
    found.calm_rotational_stiffness = read.number("calm_rotational_stiffness_Nm_per_rad");
    found.damping = read.number("damping_Ns_per_m");
    found.rotational_damping = read.number("rotational_damping_Nms_per_rad");
    const auto within = [&](const char* key, double stable, double calm) {
        if (stable > calm) read.fail(key, fmt::format("must not exceed what the device was calm at: {}", calm));
    };
    within("stable_stiffness_N_per_m", found.stable_stiffness, found.calm_stiffness);
    within("stable_rotational_stiffness_Nm_per_rad", found.rotational_stiffness, found.calm_rotational_stiffness);
    tidy(errors);
    if (!errors.empty()) return errors;
    return found;
}

std::string calibrationText(const Calibration& found) {
    return fmt::format(
        "# Found by: passung doctor --device {} --find-stiffness. Remove this file to go back to the preset's values.\n"
        "device = {}\n"
        "stable_stiffness_N_per_m = {}\nstable_rotational_stiffness_Nm_per_rad = {}\n"
        "calm_stiffness_N_per_m = {}\ncalm_rotational_stiffness_Nm_per_rad = {}\n"
        "damping_Ns_per_m = {}\nrotational_damping_Nms_per_rad = {}\n",
        found.device, jsonText(found.device), jsonNumber(found.stable_stiffness),
        jsonNumber(found.rotational_stiffness), jsonNumber(found.calm_stiffness),
        jsonNumber(found.calm_rotational_stiffness), jsonNumber(found.damping), jsonNumber(found.rotational_damping));
}

Result<DeviceDescription> calibrated(DeviceDescription device, const Calibration& found, const std::string& path) {
    const auto sameDamping = [&](const char* key, double with, double recommended) -> Errors {
        if (with == recommended) return {};
        return {
            {.message = fmt::format("must be what {} recommends now, {}: find its stiffness anew, or remove the file",
                                    device.name, recommended),
             .file = path,
             .key = key,
             .value = fmt::format("{}", with)}};
    };
    if (found.device != device.name)
        return Error{.message = fmt::format("must be {}, whose calibration the file is by its name", device.name),
                     .file = path,
                     .key = "device",
                     .value = jsonText(found.device)};
    auto errors = sameDamping("damping_Ns_per_m", found.damping, device.recommended_damping_Ns_per_m);
    if (found.rotational_stiffness > 0.0)
        for (auto& error : sameDamping("rotational_damping_Nms_per_rad", found.rotational_damping,
                                       device.recommended_rotational_damping_Nms_per_rad))
            errors.push_back(std::move(error));
    if (!errors.empty()) return errors;
    device.stability_source =
        fmt::format("calibration on this machine: translation: {:.4g} N/m, found calm up to {:.4g}",
                    found.stable_stiffness, found.calm_stiffness);
    device.stable_stiffness_N_per_m = found.stable_stiffness;
    if (device.actuated_degrees >= 6) {
        device.stable_rotational_stiffness_Nm_per_rad = found.rotational_stiffness;
        device.stability_source += fmt::format("; rotation: {:.4g} N·m/rad, found calm up to {:.4g}",
                                               found.rotational_stiffness, found.calm_rotational_stiffness);
    }
    return device;
}

}  // namespace passung::protocol
