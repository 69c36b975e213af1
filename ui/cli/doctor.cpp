#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "study/protocol/station/station_file.h"
#include "study/run/files/data_folder.h"
#include "study/run/files/known_names.h"
#include "study/run/log/discreet.h"
#include "study/run/log/study_log.h"
#include "study/run/machine/calibration.h"
#include "study/run/machine/host.h"
#include "study/run/machine/loop_check.h"
#include "study/run/machine/stability_report.h"
#include "study/run/units/station_devices.h"
#include "study/run/units/unit_report.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

void print(const std::string& text) {
    fmt::print("{}", text);
    std::fflush(stdout);
}

std::string boundsText(const char* unit, double stable, const run::WallBounds& bounds) {
    const auto cell = [](double bound) { return bound > 0.0 ? fmt::format("{:.4g}", bound) : std::string("none"); };
    return fmt::format("              {:<7}{:>10}{:>10}{:>10}{:>10}{:>12}\n", unit, cell(stable), cell(bounds.border),
                       cell(bounds.linear), cell(bounds.passive), cell(bounds.passive_undamped));
}

std::string deviceText(const DeviceDescription& d) {
    std::string text = fmt::format("  {:<12}{}\n", d.name, d.label);
    if (d.mechanism) {
        text += boundsText("N/m", d.stable_stiffness_N_per_m,
                           run::translationBounds(*d.mechanism, d.recommended_damping_Ns_per_m, d.delay_ticks));
        if (d.actuated_degrees >= 6)
            text += boundsText(
                "Nm/rad", d.stable_rotational_stiffness_Nm_per_rad,
                run::rotationBounds(*d.mechanism, d.recommended_rotational_damping_Nms_per_rad, d.delay_ticks));
    }
    return text + fmt::format("              {}\n", d.stability_source);
}

/// `device` empty: all.
std::string devicesText(const std::string& device) {
    std::string text =
        "devices: stiffness that a study may use (\"max\"), and by the model of the mechanism at the recommended "
        "damping: exact border, linear rule, passive bound with encoder steps and dry friction, the same undamped\n";
    text += fmt::format("  {:<19}{:>10}{:>10}{:>10}{:>10}{:>12}\n", "simulated", "max", "border", "linear", "passive",
                        "(undamped)");
    for (const DeviceDescription& d : run::knownDevices())
        if (device.empty() || d.name == device) text += deviceText(d);
    return text +
           "  none: no stiffness has it at that damping; a \"max\" above the border was found on the device, where dry "
           "friction and the hand damp what the model leaves free\n";
}

/// The station file with all real devices that were found.
int writeStation(const std::string& path, const std::vector<DeviceChoice>& found) {
    std::error_code none;
    if (std::filesystem::exists(path, none))
        return fail({{.message = "is there already and is left as it is: name another file", .file = path}});
    if (found.empty()) return fail({{.message = "no real device was found: nothing to write", .file = path}});
    OutputFile file(path);
    file.write(protocol::stationFileText(found));
    if (const auto done = file.commit(); !done) return fail(done.errors());
    fmt::print("station file: {}: {} device{}; `passung run --station-file` takes it, or keep it as {}\n", path,
               found.size(), found.size() == 1 ? "" : "s", (run::dataFolder() / "station.toml").string());
    return 0;
}

int findStiffness(const simulated::DeviceParams& device) {
    const auto found = run::findStiffness(device);
    if (!found) return fail(found.errors());
    if (const auto kept = run::keepCalibration(*found); !kept) return fail(kept.errors());
    fmt::print("{}: calm up to {:.6g} N/m", device.name, found->calm_stiffness);
    if (found->calm_rotational_stiffness > 0.0) fmt::print(" and {:.6g} Nm/rad", found->calm_rotational_stiffness);
    fmt::print(", kept for this user in {}\n", run::calibrationPath(found->device));
    print(devicesText(found->device));
    return 0;
}

std::string limitText(int resource) {
    rlimit limit{};
    if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) return "unknown";
    return limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur);
}

/// The program and the libraries that it was built with.
std::string versionsText() {
    std::string text = "versions\n";
    const auto line = [&text](std::string_view name, std::string_view version) {
        text += fmt::format("  {:<12}{}\n", name, version);
    };
    line("passung", PASSUNG_VERSION);
    for (std::string_view rest = PASSUNG_LIBRARIES; !rest.empty();) {
        const std::string_view library = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(rest.size(), library.size() + 1));
        const std::size_t space = library.find(' ');
        line(library.substr(0, space), library.substr(space + 1));
    }
    line("compiler", __VERSION__);
    line("machine", run::machineText());
    return text;
}

std::string displayText() {
    const char* display = std::getenv("DISPLAY");
    return fmt::format("display\n  {}\n", display != nullptr ? display : "none (DISPLAY is not set)");
}

std::string loopText(const run::LoopCheck& check) {
    std::string text = fmt::format("loop\n  real-time scheduling  {} (limit of ordinary users: rtprio {})\n",
                                   check.scheduling.fifo ? "granted" : "refused", limitText(RLIMIT_RTPRIO));
    text += fmt::format("  locked memory         {} (memlock {})\n",
                        check.scheduling.memory_locked ? "granted" : "refused", limitText(RLIMIT_MEMLOCK));
    if (!check.scheduling.fifo)
        text +=
            "  to grant both: a file in /etc/security/limits.d with rtprio 80 and memlock unlimited for your group\n";
    text += fmt::format("  cycles began late by  p50 {:.1f}  p99 {:.1f}  p99.9 {:.1f}  max {:.1f} µs\n", check.p50_us,
                        check.p99_us, check.p999_us, check.max_us);
    text += fmt::format("  a tick computed in    p99 {:.1f} µs\n", check.compute_p99_us);
    return text + fmt::format("  verdict               {}\n", check.verdict);
}

/// Everything that a bug report needs: what doctor has said and the logs, in one file of text.
int writeReport(const DoctorArguments& options, const std::string& said) {
    const auto databases = options.databases.empty() ? run::loggedDatabases() : options.databases;
    OutputFile report(options.report);
    report.write(said);
    for (const std::string& database : databases) {
        const std::string log = run::logText(database);
        report.write(fmt::format("\nlog of {}\n{}", run::discreet(database), log.empty() ? "none\n" : log));
    }
    if (const auto done = report.commit(); !done) return fail(done.errors());
    fmt::print("report: {}: this and {} log{}\n", options.report, databases.size(), databases.size() == 1 ? "" : "s");
    return 0;
}

}  // namespace

int doctor(const DoctorArguments& options) {
    if (!options.device.empty()) {
        const simulated::DeviceParams* device = simulated::findPreset(options.device);
        if (device == nullptr) {
            std::string names;
            for (const auto& preset : simulated::presets()) names.append(names.empty() ? "" : ", ").append(preset.name);
            return fail(
                {{.message = "unknown device; known devices: " + names, .key = "--device", .value = options.device}});
        }
        if (options.find_stiffness) return findStiffness(*device);
        print(devicesText(options.device));
        return 0;
    }
    const auto station = run::stationDevices(options.station_file);
    if (!station) return fail(station.errors());
    const run::UnitReport real = run::lookForUnits(station->devices);
    if (!options.write_station.empty()) {
        print(real.text);
        return writeStation(options.write_station, real.found);
    }
    std::string said = versionsText() + devicesText("") + real.text + displayText();
    said += fmt::format("loop check: {:.0f} s\n", options.seconds);
    print(said);
    const std::string loop = loopText(run::checkLoop(options.seconds));
    print(loop);
    return options.report.empty() ? 0 : writeReport(options, said + loop);
}

}  // namespace passung::cli
