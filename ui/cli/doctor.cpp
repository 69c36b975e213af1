#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "study/run/files/known_names.h"
#include "study/run/machine/calibration.h"
#include "study/run/machine/loop_check.h"
#include "study/run/machine/stability_report.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

void printBounds(const char* unit, double stable, const app::WallBounds& bounds) {
    const auto cell = [](double bound) { return bound > 0.0 ? fmt::format("{:.4g}", bound) : std::string("none"); };
    fmt::print("              {:<7}{:>10}{:>10}{:>10}{:>10}{:>12}\n", unit, cell(stable), cell(bounds.border),
               cell(bounds.linear), cell(bounds.passive), cell(bounds.passive_undamped));
}

void printDevice(const DeviceDescription& d) {
    fmt::print("  {:<12}{}\n", d.name, d.label);
    if (d.mechanism) {
        printBounds("N/m", d.stable_stiffness_N_per_m,
                    app::translationBounds(*d.mechanism, d.recommended_damping_Ns_per_m, d.delay_ticks));
        if (d.actuated_degrees >= 6)
            printBounds("Nm/rad", d.stable_rotational_stiffness_Nm_per_rad,
                        app::rotationBounds(*d.mechanism, d.recommended_rotational_damping_Nms_per_rad, d.delay_ticks));
    }
    fmt::print("              {}\n", d.stability_source);
}

/// `device` empty: all.
void printDevices(const std::string& device) {
    fmt::print(
        "devices: stiffness that a study may use (\"max\"), and by the model of the mechanism at the recommended "
        "damping: exact border, linear rule, passive bound with encoder steps and dry friction, the same undamped\n");
    fmt::print("  {:<19}{:>10}{:>10}{:>10}{:>10}{:>12}\n", "simulated", "max", "border", "linear", "passive",
               "(undamped)");
    for (const DeviceDescription& d : app::knownDevices())
        if (device.empty() || d.name == device) printDevice(d);
    fmt::print(
        "  none: no stiffness has it at that damping; a \"max\" above the border was found on the device, where dry "
        "friction and the hand damp what the model leaves free\n");
    fmt::print("  real        none: this version has drivers for simulated devices only\n");
}

int findStiffness(const simulated::DeviceParams& device) {
    const auto found = app::findStiffness(device);
    if (!found) return fail(found.errors());
    if (const auto kept = app::keepCalibration(*found); !kept) return fail(kept.errors());
    fmt::print("{}: calm up to {:.6g} N/m", device.name, found->calm_stiffness);
    if (found->calm_rotational_stiffness > 0.0) fmt::print(" and {:.6g} Nm/rad", found->calm_rotational_stiffness);
    fmt::print(", kept for this user in {}\n", app::calibrationPath(found->device));
    printDevices(found->device);
    return 0;
}

std::string limitText(int resource) {
    rlimit limit{};
    if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) return "unknown";
    return limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur);
}

/// The program and the libraries that it was built with.
void printVersions() {
    fmt::print("versions\n");
    const auto line = [](std::string_view name, std::string_view version) {
        fmt::print("  {:<12}{}\n", name, version);
    };
    line("passung", PASSUNG_VERSION);
    for (std::string_view rest = PASSUNG_LIBRARIES; !rest.empty();) {
        const std::string_view library = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(rest.size(), library.size() + 1));
        const std::size_t space = library.find(' ');
        line(library.substr(0, space), library.substr(space + 1));
    }
    line("compiler", __VERSION__);
}

void printLoop(const app::LoopCheck& check) {
    fmt::print("loop\n");
    fmt::print("  real-time scheduling  {} (limit of ordinary users: rtprio {})\n",
               check.scheduling.fifo ? "granted" : "refused", limitText(RLIMIT_RTPRIO));
    fmt::print("  locked memory         {} (memlock {})\n", check.scheduling.memory_locked ? "granted" : "refused",
               limitText(RLIMIT_MEMLOCK));
    if (!check.scheduling.fifo) {
        fmt::print(
            "  to grant both: a file in /etc/security/limits.d with rtprio 80 and memlock unlimited for your group\n");
    }
    fmt::print("  cycles began late by  p50 {:.1f}  p99 {:.1f}  p99.9 {:.1f}  max {:.1f} µs\n", check.p50_us,
               check.p99_us, check.p999_us, check.max_us);
    fmt::print("  a tick computed in    p99 {:.1f} µs\n", check.compute_p99_us);
    fmt::print("  verdict               {}\n", check.verdict);
}

}  // namespace

int doctor(const DoctorOptions& options) {
    if (!options.device.empty()) {
        const simulated::DeviceParams* device = simulated::findPreset(options.device);
        if (device == nullptr) {
            std::string names;
            for (const auto& preset : simulated::presets()) names.append(names.empty() ? "" : ", ").append(preset.name);
            return fail(
                {{.message = "unknown device; known devices: " + names, .key = "--device", .value = options.device}});
        }
        if (options.find_stiffness) return findStiffness(*device);
        printDevices(options.device);
        return 0;
    }
    printVersions();
    printDevices("");
    const char* display = std::getenv("DISPLAY");
    fmt::print("display\n  {}\n", display != nullptr ? display : "none (DISPLAY is not set)");
    fmt::print("loop check: {:.0f} s\n", options.seconds);
    std::fflush(stdout);
    printLoop(app::checkLoop(options.seconds));
    return 0;
}

}  // namespace passung::cli
