#include "study/run/units/unit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "devices/backends/backends.h"

namespace passung::run {
namespace {

std::string addressOf(const backends::Backend& backend, const std::vector<DeviceChoice>& station) {
    const auto chosen = std::find_if(station.begin(), station.end(),
                                     [&](const DeviceChoice& choice) { return choice.backend == backend.name; });
    return chosen == station.end() ? std::string() : chosen->address;
}

std::string unitText(const DeviceUnit& unit) {
    std::string text = unit.model;
    if (unit.serial != unit.model) text += ", serial " + unit.serial;
    return unit.versions.empty() ? text : text + ", " + unit.versions;
}

std::string handOf(std::size_t number) {
    constexpr const char* kHands[] = {kFirstHand, "left"};
    return number < std::size(kHands) ? kHands[number] : fmt::format("hand{}", number + 1);
}

}  // namespace

UnitReport lookForUnits(const std::vector<DeviceChoice>& station) {
    UnitReport report{"real devices\n", {}};
    for (const backends::Backend& backend : backends::all()) {
        const std::string address = addressOf(backend, station);
        const backends::Sighting found = backend.look(address);
        report.text += fmt::format("  {:<12}{} (kind {})\n", backend.name, backend.label, backend.kind);
        if (!found.why_not.empty()) report.text += fmt::format("              not found: {}\n", found.why_not);
        for (const DeviceUnit& unit : found.units) {
            report.text += fmt::format("              found: {}\n", unitText(unit));
            report.found.push_back({.hand = {},
                                    .kind = std::string(backend.kind),
                                    .backend = std::string(backend.name),
                                    .serial = unit.serial,
                                    .address = address,
                                    .axes = {}});
        }
    }
    for (std::size_t i = 0; i < report.found.size(); ++i) report.found[i].hand = handOf(i);
    return report;
}

}  // namespace passung::run
