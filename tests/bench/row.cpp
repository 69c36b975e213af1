#include "tests/bench/row.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>

namespace passung::bench {

namespace {

std::string number(double value, const char* missing) {
    return std::isnan(value) ? missing : fmt::format("{:.5g}", value);
}

/// Between quotes, for it may hold commas.
std::string quoted(const std::string& text) {
    std::string field = "\"";
    for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
    return field + "\"";
}

std::string cell(double value) {
    if (std::isnan(value)) return "-";
    const double size = std::abs(value);
    return size >= 100.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

}  // namespace

Times summarise(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    const auto ranked = [&](double share) {
        const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(n)));
        return values[std::max<std::size_t>(rank, 1) - 1];
    };
    return {.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n),
            .median = 0.5 * (values[(n - 1) / 2] + values[n / 2]),
            .p99 = ranked(0.99),
            .max = values.back(),
            .p999 = ranked(0.999)};
}

std::string csvHeader() {
    return "group,method,settings,samples,time_mean_us,time_median_us,time_p99_us,time_p999_us,time_max_us,time_per_"
           "point_ns,"
           "distance_error_mean_um,distance_error_p99_um,distance_error_max_um,error_bound_max_um,bounds_broken,"
           "force_error_mean_percent,force_error_p99_percent,force_error_max_percent,force_turn_mean_deg,force_turn_"
           "p99_deg,force_turn_max_deg,"
           "torque_error_mean_percent,torque_error_p99_percent,torque_error_max_percent,wrong_signs_percent,other_bits,"
           "order,"
           "contacts_mean,depth_mean_um,depth_p99_um,depth_max_um,memory_MB,build_s,figure,figure_mark\n";
}

std::string csvLine(const Row& row) {
    std::string line =
        fmt::format("{},{},{},{}", quoted(row.group), quoted(row.method), quoted(row.settings), row.samples);
    for (const double value : {row.time_us.mean,
                               row.time_us.median,
                               row.time_us.p99,
                               row.time_us.p999,
                               row.time_us.max,
                               row.ns_per_point,
                               row.distance_error_um.mean,
                               row.distance_error_um.p99,
                               row.distance_error_um.max,
                               row.bound_max_um,
                               row.bound_broken,
                               row.force_error_percent.mean,
                               row.force_error_percent.p99,
                               row.force_error_percent.max,
                               row.force_turn_deg.mean,
                               row.force_turn_deg.p99,
                               row.force_turn_deg.max,
                               row.torque_error_percent.mean,
                               row.torque_error_percent.p99,
                               row.torque_error_percent.max,
                               row.wrong_signs_percent,
                               row.other_bits,
                               row.order,
                               row.contacts_mean,
                               row.depth_um.mean,
                               row.depth_um.p99,
                               row.depth_um.max,
                               row.memory_MB,
                               row.build_s,
                               row.figure,
                               row.figure_mark})
        line += "," + number(value, "NA");
    return line + "\n";
}

std::string table(const std::vector<Row>& rows) {
    std::string text, group;
    for (const Row& row : rows) {
        if (row.group != group) {
            group = row.group;
            text += "\n" + group + "\n";
        }
        text += "  " + row.method + ": " + row.settings + "\n   ";
        const auto add = [&](const char* label, std::initializer_list<double> values, const char* unit) {
            if (std::isnan(*values.begin())) return;
            text += fmt::format("  {} ", label);
            const char* between = "";
            for (const double value : values) {
                text += between + cell(value);
                between = " / ";
            }
            text += unit;
        };
        add("time mean/median/p99/p99.9/max",
            {row.time_us.mean, row.time_us.median, row.time_us.p99, row.time_us.p999, row.time_us.max}, " us");
        add("each", {row.ns_per_point}, " ns");
        add("| distance error mean/p99/max",
            {row.distance_error_um.mean, row.distance_error_um.p99, row.distance_error_um.max}, " um");
        add("bound", {row.bound_max_um}, " um");
        add("broken", {row.bound_broken}, "");
        add("| force error mean/p99/max",
            {row.force_error_percent.mean, row.force_error_percent.p99, row.force_error_percent.max}, " %");
        add("", {row.force_turn_deg.mean, row.force_turn_deg.p99, row.force_turn_deg.max}, " deg");
        add("torque", {row.torque_error_percent.mean, row.torque_error_percent.p99, row.torque_error_percent.max},
            " %");
        add("| wrong signs", {row.wrong_signs_percent}, " %");
        add("| other bits", {row.other_bits}, "");
        add("| order", {row.order}, "");
        add("| contacts", {row.contacts_mean}, "");
        add("| overlap mean/p99/max", {row.depth_um.mean, row.depth_um.p99, row.depth_um.max}, " um");
        add("| memory", {row.memory_MB}, " MB");
        add("build", {row.build_s}, " s");
        add("| figure", {row.figure}, (" " + row.figure_unit).c_str());
        add("mark", {row.figure_mark}, row.figure <= row.figure_mark ? ", met" : ", MISSED");
        text += "\n";
    }
    return text;
}

}  // namespace passung::bench
