#include "analysis/truth/accuracy_tick_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <numbers>
#include <sstream>

#include "core/scene/contact_geometry.h"

namespace passung::truth {

namespace {

using RowCells = std::vector<std::string>;

RowCells cellsOf(const std::string& line) {
    RowCells cells(1);
    for (const char c : line)
        if (c == ',')
            cells.emplace_back();
        else if (c != '\r')
            cells.back() += c;
    return cells;
}

/// In units of which `per` make one of SI: divided by, so that "20" µm are the same bits as 20e-6. "NA": none.
bool take(const std::string& cell, double per, double& value) {
    value = Spread::kNone;
    if (cell == "NA") return true;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    value /= per;
    return error == std::errc() && end == cell.data() + cell.size();
}

/// "NA": 0, as where it has no meaning.
template <class Integer>
bool takeWhole(const std::string& cell, Integer& value) {
    value = 0;
    if (cell == "NA") return true;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    return error == std::errc() && end == cell.data() + cell.size() && value >= 0;
}

bool takeFlag(const std::string& cell, bool& value) {
    value = cell == "1";
    return cell == "1" || cell == "0" || cell == "NA";
}

struct FrontColumn {
    std::string name;
    std::function<bool(const std::string&, PathCost&)> take;
};

bool takeMethod(const std::string& cell, PathCost& row) {
    using enum scene::ContactMethod;
    for (const scene::ContactMethod method : {Penalty, GodObjectHeuristic, GodObject}) {
        row.setting.method = method;
        if (cell == scene::methodName(method)) return true;
    }
    return false;
}

bool takeGeometry(const std::string& cell, PathCost& row) {
    const auto geometry = scene::geometryNamed(cell);
    row.setting.geometry = geometry.value_or(scene::Geometry::Field);
    return geometry.has_value() && *geometry != scene::Geometry::Auto;
}

bool takeMode(const std::string& cell, PathCost& row) {
    const auto mode = field::modeNamed(cell);
    if (mode) row.setting.field.mode = *mode;
    return mode.has_value() || cell == "NA";
}

std::vector<FrontColumn> columns() {
    std::vector<FrontColumn> all{{"method", takeMethod}, {"geometry", takeGeometry}, {"mode", takeMode}};
    const auto number = [&](const std::string& name, double per, auto reach) {
        all.push_back({name, [=](const std::string& cell, PathCost& row) { return take(cell, per, reach(row)); }});
    };
    const auto whole = [&](const std::string& name, auto reach) {
        all.push_back({name, [=](const std::string& cell, PathCost& row) { return takeWhole(cell, reach(row)); }});
    };
    const auto flag = [&](const std::string& name, auto reach) {
        all.push_back({name, [=](const std::string& cell, PathCost& row) { return takeFlag(cell, reach(row)); }});
    };
    number("tolerance_um", 1e6, [](PathCost& r) -> double& { return r.setting.field.tolerance; });
    number("spacing_mm", 1e3, [](PathCost& r) -> double& { return r.setting.field.spacing; });
    flag("two_way", [](PathCost& r) -> bool& { return r.setting.two_way; });
    whole("budget_nodes", [](PathCost& r) -> int& { return r.setting.field.budget_nodes; });
    whole("points", [](PathCost& r) -> std::size_t& { return r.points; });
    number("memory_MB", 1e-6, [](PathCost& r) -> double& { return r.bytes; });
    const auto times = [&](const std::string& name, TickSpread PathCost::*of) {
        number(name + "_median_us", 1e6, [of](PathCost& r) -> double& { return (r.*of).median; });
        number(name + "_p999_us", 1e6, [of](PathCost& r) -> double& { return (r.*of).p999; });
        number(name + "_max_us", 1e6, [of](PathCost& r) -> double& { return (r.*of).max; });
    };
    times("time", &PathCost::time);
    times("wall", &PathCost::wall);
    whole("ticks", [](PathCost& r) -> std::size_t& { return r.ticks; });
    whole("suspended", [](PathCost& r) -> std::size_t& { return r.suspended; });
    whole("suspended_in_a_row", [](PathCost& r) -> std::size_t& { return r.suspended_in_a_row; });
    number("recorded_overlap_max_um", 1e6, [](PathCost& r) -> double& { return r.recorded; });
    whole("judged_ticks", [](PathCost& r) -> std::size_t& { return r.judged; });
    number("overlap_max_um", 1e6, [](PathCost& r) -> double& { return r.overlap; });
    number("overlap_bound_um", 1e6, [](PathCost& r) -> double& { return r.overlap_bound; });
    whole("referenced_ticks", [](PathCost& r) -> std::size_t& { return r.referenced; });
    number("force_error_max_N", 1.0, [](PathCost& r) -> double& { return r.force_error; });
    const auto spreads = [&](const std::string& name, const std::string& unit, double per, Spread PathCost::*of) {
        number(name + "_median_" + unit, per, [of](PathCost& r) -> double& { return (r.*of).median; });
        number(name + "_p99_" + unit, per, [of](PathCost& r) -> double& { return (r.*of).p99; });
        number(name + "_max_" + unit, per, [of](PathCost& r) -> double& { return (r.*of).max; });
    };
    spreads("force_error", "percent", 100.0, &PathCost::force);
    spreads("direction_error", "deg", 180.0 / std::numbers::pi, &PathCost::direction);
    number("grain_p999_N", 1.0, [](PathCost& r) -> double& { return r.grain.p999; });
    number("grain_max_N", 1.0, [](PathCost& r) -> double& { return r.grain.max; });
    flag("on_overlap_front", [](PathCost& r) -> bool& { return r.on_overlap_front; });
    flag("on_force_front", [](PathCost& r) -> bool& { return r.on_force_front; });
    return all;
}

}  // namespace

Result<std::vector<PathCost>> readTickCsv(const std::string& text, const std::string& file, int first_line) {
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    const RowCells header = cellsOf(line);
    const std::vector<FrontColumn> known = columns();
    std::vector<const FrontColumn*> order;
    for (const std::string& name : header) {
        const auto column =
            std::find_if(known.begin(), known.end(), [&](const FrontColumn& c) { return c.name == name; });
        if (column == known.end())
            return Error{.message = "no column of a measured front", .file = file, .line = first_line, .value = name};
        order.push_back(&*column);
    }
    for (const FrontColumn& column : known)
        if (std::find(order.begin(), order.end(), &column) == order.end())
            return Error{.message = "a column is missing", .file = file, .line = first_line, .value = column.name};
    std::vector<PathCost> rows;
    for (int at = first_line + 1; std::getline(lines, line); ++at) {
        const RowCells cells = cellsOf(line);
        if (cells.size() != order.size())
            return Error{
                .message = fmt::format("has {} cells of {}", cells.size(), order.size()), .file = file, .line = at};
        PathCost row;
        for (std::size_t i = 0; i < cells.size(); ++i)
            if (!order[i]->take(cells[i], row))
                return Error{.message = "is no " + order[i]->name, .file = file, .line = at, .value = cells[i]};
        rows.push_back(row);
    }
    return rows;
}

}  // namespace passung::truth
