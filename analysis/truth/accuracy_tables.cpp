#include "analysis/truth/accuracy_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/truth/item_columns.h"

namespace passung::truth {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

using RowColumns = std::vector<ItemColumn<SettingCost>>;

/// mean, p99 and max of one error, times `factor`.
void addSpread(RowColumns& columns, const std::string& name, const std::string& unit, const std::string& meaning,
               double factor, Spread SettingCost::*spread) {
    const auto add = [&](const char* what, const char* words, double Spread::*value) {
        columns.push_back({name + "_" + what + "_" + unit, unit, std::string(words) + meaning,
                           [=](const SettingCost& row) { return cell(factor * row.*spread.*value); }});
    };
    add("mean", "mean over poses of ", &Spread::mean);
    add("p99", "99th percentile (nearest rank) over poses of ", &Spread::p99);
    add("max", "largest over poses of ", &Spread::max);
}

RowColumns rowColumns() {
    using Row = SettingCost;
    RowColumns columns{
        {"mode", "", "interpolation of the field",
         [](const Row& r) { return std::string(field::modeName(r.setting.mode)); }},
        {"tolerance_um", "um", "asked accuracy of FIELD's distance field",
         [](const Row& r) { return cell(1e6 * r.setting.tolerance); }},
        {"spacing_mm", "mm", "asked spacing of SHELL's points",
         [](const Row& r) { return cell(1e3 * r.setting.spacing); }},
        {"budget_nodes", "", "most tree nodes that a query visits; 0: no limit",
         [](const Row& r) { return std::to_string(r.setting.budget_nodes); }},
        {"points", "", "of SHELL", [](const Row& r) { return std::to_string(r.points); }},
        {"time_median_us", "us",
         "median over poses of the time of one query with its penalty wrench, as a tick of area-weighted penalty "
         "contact asks it: depth and contacts; the fastest of several repetitions; one thread, its processor time",
         [](const Row& r) { return cell(1e6 * r.time.median); }},
        {"time_p99_us", "us", "99th percentile (nearest rank) of the same",
         [](const Row& r) { return cell(1e6 * r.time.p99); }},
        {"time_max_us", "us", "largest of the same", [](const Row& r) { return cell(1e6 * r.time.max); }}};
    addSpread(columns, "depth_error", "um", "|depth - truth|, where there is contact or is said to be", 1e6,
              &Row::depth);
    addSpread(columns, "force_error", "percent",
              "| |F| - |F_true| | / |F_true|, where |F_true| is at least 1 % of the largest one", 100.0, &Row::force);
    addSpread(columns, "direction_error", "deg",
              "angle between F and F_true at the same poses, where the answer has a force", kDegrees, &Row::direction);
    addSpread(
        columns, "torque_error", "percent",
        "|T - T_true| / (|F_true| lever) about SHELL's origin at the same poses; lever: SHELL's farthest point from it",
        100.0, &Row::torque);
    addSpread(columns, "distance_error", "um", "|distance - truth| without contact", 1e6, &Row::distance);
    const RowColumns more{
        {"distance_time_median_us", "us", "median over poses without contact of the time of asking for the distance",
         [](const Row& r) { return cell(1e6 * r.distance_time.median); }},
        {"distance_time_p99_us", "us", "99th percentile (nearest rank) of the same",
         [](const Row& r) { return cell(1e6 * r.distance_time.p99); }},
        {"distance_time_max_us", "us", "largest of the same",
         [](const Row& r) { return cell(1e6 * r.distance_time.max); }},
        {"stated_bound_max_um", "um", "largest error bound that the proven query states for the signed distance",
         [](const Row& r) { return cell(1e6 * r.bound_max); }},
        {"field_MB", "MB", "memory of FIELD's distance field", [](const Row& r) { return cell(1e-6 * r.field_bytes); }},
        {"shell_MB", "MB", "memory of SHELL's points and tree",
         [](const Row& r) { return cell(1e-6 * r.shell_bytes); }},
        {"field_build_s", "s",
         "building FIELD's distance field, all cores, wall time; of one that an earlier run kept: what it took then",
         [](const Row& r) { return cell(r.field_build); }},
        {"shell_build_s", "s", "the same of sampling SHELL's points", [](const Row& r) { return cell(r.shell_build); }},
        {"on_depth_front", "", "1: no other row has both a smaller time_p99_us and a smaller depth_error_p99_um",
         [](const Row& r) { return std::string(r.on_depth_front ? "1" : "0"); }},
        {"on_force_front", "", "1: the same with force_error_p99_percent",
         [](const Row& r) { return std::string(r.on_force_front ? "1" : "0"); }}};
    columns.insert(columns.end(), more.begin(), more.end());
    return columns;
}

std::vector<ItemColumn<JudgedPose>> poseColumns() {
    std::vector<ItemColumn<JudgedPose>> columns;
    const auto add = [&](const std::string& name, const char* unit, const char* meaning, auto value) {
        columns.push_back({name, unit, meaning, [value](const JudgedPose& pose) {
                               const double v = value(pose);
                               return std::isnan(v) ? std::string("NA") : fmt::format("{}", v);
                           }});
    };
    for (int axis = 0; axis < 3; ++axis)
        add(std::string(1, "xyz"[axis]) + "_m", "m", "position of SHELL's frame in FIELD's",
            [axis](const JudgedPose& p) { return p.X_FS.p[axis]; });
    add("qw", "", "unit quaternion, SHELL to FIELD", [](const JudgedPose& p) { return p.X_FS.q.w(); });
    add("qx", "", "unit quaternion, SHELL to FIELD", [](const JudgedPose& p) { return p.X_FS.q.x(); });
    add("qy", "", "unit quaternion, SHELL to FIELD", [](const JudgedPose& p) { return p.X_FS.q.y(); });
    add("qz", "", "unit quaternion, SHELL to FIELD", [](const JudgedPose& p) { return p.X_FS.q.z(); });
    columns.push_back({"phase", "", "part of the path, or given by the user",
                       [](const JudgedPose& p) { return std::string(p.phase); }});
    columns.push_back({"true_relation", "", "by FCL and ray parity; A: FIELD, B: SHELL",
                       [](const JudgedPose& p) { return std::string(toString(p.truth.relation)); }});
    add("true_separation_m", "m", "of the surfaces, by FCL", [](const JudgedPose& p) { return p.truth.separation; });
    add("true_signed_distance_m", "m", "smallest signed distance of SHELL's surface from FIELD; negative: depth",
        [](const JudgedPose& p) { return p.truth.distance; });
    add("true_distance_uncertainty_m", "m", "of the two before",
        [](const JudgedPose& p) { return p.truth.uncertainty; });
    for (int axis = 0; axis < 3; ++axis)
        add(std::string("true_force_") + "xyz"[axis] + "_N", "N",
            "penalty on SHELL, 1e9 N/m3 times depth integrated over its surface; FIELD's axes",
            [axis](const JudgedPose& p) { return p.truth.wrench.force[axis]; });
    for (int axis = 0; axis < 3; ++axis)
        add(std::string("true_torque_") + "xyz"[axis] + "_Nm", "N m", "the same about SHELL's origin",
            [axis](const JudgedPose& p) { return p.truth.wrench.torque[axis]; });
    add("true_wrench_uncertainty_percent", "%", "of the dense sum, share of the force",
        [](const JudgedPose& p) { return 100.0 * p.truth.wrench_uncertainty; });
    return columns;
}

/// The rows of one front from fast to accurate.
std::vector<const SettingCost*> front(const std::vector<SettingCost>& rows, bool SettingCost::*flag) {
    std::vector<const SettingCost*> on;
    for (const SettingCost& row : rows)
        if (row.*flag) on.push_back(&row);
    std::sort(on.begin(), on.end(),
              [](const SettingCost* a, const SettingCost* b) { return a->time.p99 < b->time.p99; });
    return on;
}

}  // namespace

std::string accuracyCsv(const std::vector<SettingCost>& rows) { return csv(rowColumns(), rows); }

std::string posesCsv(const std::vector<JudgedPose>& poses) { return csv(poseColumns(), poses); }

std::string accuracyCodebook() {
    std::string text = kCodebookHeader;
    const auto add = [&](const char* file, const auto& columns) { text += codebookOf(file, columns); };
    add("accuracy.csv", rowColumns());
    add("poses.csv", poseColumns());
    return text;
}

std::string settingText(const AccuracySetting& setting) {
    const std::string budget =
        setting.budget_nodes > 0 ? fmt::format(", {} nodes", setting.budget_nodes) : std::string();
    return fmt::format("{:g} µm, {:g} mm, {}{}", 1e6 * setting.tolerance, 1e3 * setting.spacing,
                       field::modeName(setting.mode), budget);
}

std::string frontText(const std::vector<SettingCost>& rows) {
    std::string text;
    const auto add = [&](const char* title, bool SettingCost::*flag, auto error, const char* unit) {
        text += fmt::format("{}\n  {:>10} {:>10}  {:>10}      {}\n", title, "median", "p99", "p99 error",
                            "field tolerance, point spacing, mode, node budget");
        for (const SettingCost* row : front(rows, flag))
            text += fmt::format("  {:>7.1f} µs {:>7.1f} µs  {:>10.3g} {:<4} {}\n", 1e6 * row->time.median,
                                1e6 * row->time.p99, error(*row), unit, settingText(row->setting));
    };
    add(
        "Depth: settings that no other beats in both time and error", &SettingCost::on_depth_front,
        [](const SettingCost& row) { return 1e6 * row.depth.p99; }, "µm");
    add(
        "Force: settings that no other beats in both time and error", &SettingCost::on_force_front,
        [](const SettingCost& row) { return 100.0 * row.force.p99; }, "%");
    return text;
}

}  // namespace passung::truth
