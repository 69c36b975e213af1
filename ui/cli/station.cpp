#include "ui/cli/station.h"

#include <fmt/format.h>

namespace passung::cli {

Result<store::Station> stationOf(const StationArguments& options) {
    if (options.station.empty()) return store::Station{};
    const int index = options.station[0] - 'A';
    if (index >= options.stations)
        return Error{.message = fmt::format("{} stations are A to {}", options.stations,
                                            static_cast<char>('A' + options.stations - 1)),
                     .key = "--station",
                     .value = options.station};
    return store::Station{options.station, index, options.stations};
}

}  // namespace passung::cli
