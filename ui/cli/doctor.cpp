#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "ui/app/loop_check.h"
#include "ui/app/run_study.h"
#include "ui/cli/commands.h"

namespace passung::cli {

namespace {

void printDevices() {
    fmt::print("devices\n");
    fmt::print("  {:<12}{:<56}{:>12}{:>13}\n", "simulated", "", "stable N/m", "Nm/rad");
    for (const DeviceDescription& d : app::knownDevices()) {
        fmt::print("  {:<12}{:<56}{:>12.0f}{:>13.3g}\n", d.name, d.label, d.stable_stiffness_N_per_m,
                   d.stable_rotational_stiffness_Nm_per_rad);
    }
    fmt::print("  real        none: this version has drivers for simulated devices only\n");
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
    printVersions();
    printDevices();
    const char* display = std::getenv("DISPLAY");
    fmt::print("display\n  {}\n", display != nullptr ? display : "none (DISPLAY is not set)");
    fmt::print("loop check: {:.0f} s\n", options.seconds);
    std::fflush(stdout);
    printLoop(app::checkLoop(options.seconds));
    return 0;
}

}  // namespace passung::cli
