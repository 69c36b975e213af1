#include "devices/backends/backends.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "devices/haply/inverse3_unit.h"
#include "devices/host/hosted_unit.h"
#include "devices/simulated/presets.h"
#include "devices/spacenavd/space_mouse_unit.h"
#include "devices/vrpn/tracker_unit.h"

namespace passung::backends {
namespace {

Sighting lookForSpaceMouse(const std::string& address) {
    spacenavd::SpaceMouseLink link({.address = address}, {});
    const auto unit = link.open();
    if (!unit) return {{}, unit.errors().front().message};
    return {{*unit}, {}};
}

Sighting lookForInverse3(const std::string& address) {
    const auto devices = haply::inventory(address);
    if (!devices) return {{}, devices.errors().front().message};
    Sighting found;
    for (const haply::SaidOfDevice& device : *devices)
        found.units.push_back({.serial = device.id, .model = "inverse3", .versions = "firmware " + device.firmware});
    if (found.units.empty())
        found.why_not = "the Inverse Service runs and has no Inverse3: switch it on and plug it in";
    return found;
}

Sighting lookInHost(const char* backend, const std::string& library) {
    const auto units = host::lookHosted(backend, library);
    if (!units) return {{}, units.errors().front().message};
    return {*units, {}};
}

Sighting lookForSigma7(const std::string& library) { return lookInHost("dhd", library); }
Sighting lookForTouch(const std::string& library) { return lookInHost("hd", library); }

Sighting lookForTracker(const std::string& address) {
    const auto at = vrpn::trackerAddress(address);
    if (!at) return {{}, "the address of the station file " + at.errors().front().message};
    const auto units = vrpn::TrackerLink::look(*at);
    if (!units) return {{}, units.errors().front().message};
    return {*units, {}};
}

/// Those that push come first.
constexpr std::array kBackends{
    Backend{"dhd", "Force Dimension sigma.7 through the vendor's library", "sigma7", lookForSigma7, host::openHosted},
    Backend{"hd", "3D Systems Touch through OpenHaptics", "touch", lookForTouch, host::openHosted},
    Backend{"haply", "Haply Inverse3 through the Inverse Service", "inverse3", lookForInverse3, haply::openInverse3},
    Backend{"spacenavd", "3Dconnexion SpaceMouse through spacenavd", "spacemouse", lookForSpaceMouse,
            spacenavd::openSpaceMouse},
    Backend{"vrpn", "Tracker that a VRPN server serves", "tracker", lookForTracker, vrpn::openTracker},
};

/// Limits of its units: those of the simulated one.
DeviceDescription describe(const Backend& backend) {
    DeviceDescription description = simulated::describe(*simulated::findPreset(backend.kind));
    description.label = backend.label;
    description.simulated = false;
    description.mechanism.reset();
    return description;
}

}  // namespace

std::span<const Backend> all() { return kBackends; }

const Backend* find(std::string_view name) {
    const auto found = std::ranges::find(kBackends, name, &Backend::name);
    return found == kBackends.end() ? nullptr : &*found;
}

Result<std::unique_ptr<unit::Unit>> open(const DeviceChoice& choice) {
    if (const Backend* backend = find(choice.backend)) return backend->open(choice, describe(*backend));
    std::string names = kSimulatedBackend;
    for (const Backend& backend : kBackends) names.append(", ").append(backend.name);
    return Error{.message = "unknown backend; known backends: " + names, .key = "backend", .value = choice.backend};
}

std::vector<std::string> whyWeaker(const DeviceDescription& unit, const DeviceDescription& kind) {
    std::vector<std::string> why;
    const auto atLeast = [&why](const char* what, double has, double needs, const char* dimension) {
        if (has < needs) why.push_back(fmt::format("{} {:.4g}{} of {:.4g}{}", what, has, dimension, needs, dimension));
    };
    atLeast("measures", unit.sensed_degrees, kind.sensed_degrees, " degrees");
    atLeast("drives", unit.actuated_degrees, kind.actuated_degrees, " degrees");
    atLeast("pushes with", unit.max_force_N, kind.max_force_N, " N");
    atLeast("turns with", unit.max_torque_Nm, kind.max_torque_Nm, " Nm");
    atLeast("reaches", 1e3 * unit.workspace_radius_m, 1e3 * kind.workspace_radius_m, " mm");
    return why;
}

}  // namespace passung::backends
