#include "tests/bench/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/bench/contact_rows.h"
#include "tests/bench/convergence_rows.h"
#include "tests/bench/force_rows.h"
#include "tests/bench/million_rows.h"
#include "tests/bench/part_rows.h"
#include "tests/bench/sampling_rows.h"

namespace passung::bench {

namespace {

constexpr double kMostDistanceError_um = 20.0, kMostForceError_percent = 1.0, kMostForceTurn_deg = 0.5;
constexpr double kMostBoreMemory_MB = 30.0;

using Test = bool (*)(const Row&);
using Figure = double (*)(const Row&);

double meanTime(const Row& row) { return row.time_us.mean; }
double p99Time(const Row& row) { return row.time_us.p99; }
double perPoint(const Row& row) { return row.ns_per_point; }
double medianTime(const Row& row) { return row.time_us.median; }
double brokenBounds(const Row& row) { return row.bound_broken; }
double wrongSigns(const Row& row) { return row.wrong_signs_percent; }
double buildTime(const Row& row) { return row.build_s; }
double worstError(const Row& row) { return row.distance_error_um.max; }
double otherBits(const Row& row) { return row.other_bits; }
double falseContacts(const Row& row) { return row.contacts_mean; }
double memory(const Row& row) { return row.memory_MB; }
double order(const Row& row) { return row.order; }
double p999Time(const Row& row) { return row.time_us.p999; }

bool always(const Row&) { return true; }
bool isMotion(const Row& row) { return row.method == kQpMethod; }
bool isForce(const Row& row) { return row.method == kForceMethod; }
bool isTick(const Row& row) { return row.method == kTickMethod; }
bool isAccurateOnAverage(const Row& row) {
    return row.distance_error_um.mean <= kMostDistanceError_um &&
           row.force_error_percent.mean <= kMostForceError_percent && row.force_turn_deg.mean <= kMostForceTurn_deg &&
           row.torque_error_percent.mean <= kMostForceError_percent;
}
bool isOnePercent(const Row& row) { return row.method == kOnePercent; }
bool hasVariants(const Row& row) { return row.other_bits >= 0.0; }
bool isUnderBudget(const Row& row) { return row.bound_broken >= 0.0; }
/// Counts among 6 000 points; more than 30 MB count for nothing.
bool isSmall(const Row& row) { return row.memory_MB <= kMostBoreMemory_MB; }
bool isBounded(const Row& row) {
    return row.bound_max_um <= kMostDistanceError_um && row.distance_error_um.max <= kMostDistanceError_um;
}

/// The row of `group` with the smallest figure among ours that pass `test`.
const Row* best(const std::vector<Row>& rows, const std::string& group, Test test, Figure figure) {
    const Row* found = nullptr;
    for (const Row& row : rows)
        if (row.ours && row.group == group && test(row) && (!found || figure(row) < figure(*found))) found = &row;
    return found;
}

const Row* worst(const std::vector<Row>& rows, const std::string& group, Test test, Figure figure) {
    const Row* found = nullptr;
    for (const Row& row : rows)
        if (row.ours && row.group == group && test(row) && (!found || figure(row) > figure(*found))) found = &row;
    return found;
}

/// The worst errors of a row, as far as it has any: a speed means nothing without them.
std::string errorsOf(const Row& row) {
    std::string text;
    const auto add = [&](const char* name, double value, const char* unit) {
        if (!std::isnan(value)) text += fmt::format("{}{} {:.3g}{}", text.empty() ? "" : ", ", name, value, unit);
    };
    add("distance", row.distance_error_um.max, " um");
    add("stated bound", row.bound_max_um, " um");
    add("force", row.force_error_percent.max, " %");
    add("direction", row.force_turn_deg.max, " deg");
    add("torque", row.torque_error_percent.max, " %");
    return text.empty() ? "" : "; worst errors: " + text;
}

std::string settingOf(const Row& row) { return row.method + ", " + row.settings + errorsOf(row); }

Mark figureOf(const Row* row, Figure figure, const char* name, double limit, const char* unit) {
    Mark mark{.name = name, .limit = limit, .unit = unit};
    if (row) mark.value = figure(*row);
    mark.note = row ? settingOf(*row) : "no row counts";
    return mark;
}

/// The order of convergence that `method` shows.
Mark orderOf(const std::vector<Row>& rows, const char* method, const char* name, double limit) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& candidate) {
        return candidate.group == kConvergenceGroup && candidate.method == method;
    });
    Mark mark = figureOf(row != rows.end() ? &*row : nullptr, order, name, limit, "");
    mark.at_least = true;
    return mark;
}

/// The fastest row of a peer.
const Row* peer(const std::vector<Row>& rows, const std::string& group, const std::string& method, Figure figure) {
    const Row* found = nullptr;
    for (const Row& row : rows)
        if (row.group == group && row.method == method && (!found || figure(row) < figure(*found))) found = &row;
    return found;
}

/// What a speed must come with, and what is said instead if no setting has it.
struct Requirement {
    Test met;
    Test nearly;
    const char* nearly_text;
};

constexpr Requirement kAny{always, always, "the fastest of all"};
constexpr Requirement kAccurate{isAccurate, isAccurateOnAverage, "if mean errors counted"};
constexpr Requirement kBounded{isBounded, always, "the fastest of all"};

/// Ours over the peer's.
Mark ratio(const std::vector<Row>& rows, const char* name, double limit, const char* group, const char* other,
           const Requirement& requirement, Figure figure) {
    Mark mark{.name = name, .limit = limit};
    const Row* ours = best(rows, group, requirement.met, figure);
    const Row* theirs = peer(rows, group, other, figure);
    if (!theirs) {
        mark.note = fmt::format("{} was not measured", other);
    } else if (ours) {
        mark.value = figure(*ours) / figure(*theirs);
        mark.note = fmt::format("{:.4g} : {:.4g}, {}", figure(*ours), figure(*theirs), settingOf(*ours));
    } else {
        mark.note = "no measured setting of ours is accurate enough at every pose";
        if (const Row* row = best(rows, group, requirement.nearly, figure))
            mark.note += fmt::format("; {}: {:.4g}, {}", requirement.nearly_text, figure(*row) / figure(*theirs),
                                     settingOf(*row));
    }
    return mark;
}

}  // namespace

bool isAccurate(const Row& row) {
    return row.distance_error_um.max <= kMostDistanceError_um &&
           row.force_error_percent.max <= kMostForceError_percent && row.force_turn_deg.max <= kMostForceTurn_deg &&
           row.torque_error_percent.max <= kMostForceError_percent;
}

std::vector<Mark> judge(const std::vector<Row>& rows) {
    std::vector<Mark> marks;
    marks.push_back(ratio(rows, "pressed 1 mm, mean time over FCL's all contacts", 1.0 / 50, kPressedGroup,
                          "FCL all contacts", kAccurate, meanTime));
    marks.push_back(ratio(rows, "pressed 1 mm, p99 over FCL's all contacts", 1.0 / 50, kPressedGroup,
                          "FCL all contacts", kAccurate, p99Time));
    marks.push_back(ratio(rows, "1 mm apart, bound <= 20 um, mean time over FCL's distance", 1.0 / 15, kApartGroup,
                          "FCL distance", kBounded, meanTime));
    marks.push_back(ratio(rows, "1 mm apart, bound <= 20 um, p99 over FCL's distance", 1.0 / 15, kApartGroup,
                          "FCL distance", kBounded, p99Time));
    marks.push_back(figureOf(best(rows, kMillionGroup, isOnePercent, medianTime), medianTime,
                             "a million points, 1 % in contact, median", 300.0, " us"));
    marks.push_back(figureOf(worst(rows, kMillionGroup, isUnderBudget, brokenBounds), brokenBounds,
                             "a million points, bounds broken under node budgets", 0.0, ""));
    marks.push_back(figureOf(best(rows, kSamplingGroup, always, perPoint), perPoint,
                             "field sampling, trilinear, surface points", 4.5, " ns a point"));
    marks.push_back(ratio(rows, "field sampling over a flat array", 1.5, kSamplingGroup, kFlatArray, kAny, perPoint));
    marks.push_back(figureOf(worst(rows, kSamplingGroup, hasVariants, otherBits), otherBits,
                             "field sampling, values whose bits differ between variants", 0.0, ""));
    marks.push_back(ratio(rows, "field build over OpenVDB's level set", 1.0, kBuildGroup, kVdbBuild, kAny, buildTime));
    marks.push_back(
        ratio(rows, "worst error of that field over OpenVDB's", 1.0, kBuildGroup, kVdbBuild, kAny, worstError));
    // One and the same field has to be exact, small and free of false contacts.
    const Row* bore = best(rows, kBoreGroup, isSmall, worstError);
    marks.push_back(figureOf(bore, worstError, "bore: worst error within 0.2 mm, rims included", 5.0, " um"));
    marks.push_back(figureOf(bore, falseContacts, "the same field: false contacts of 6 000 points", 0.0, ""));
    marks.push_back(figureOf(bore, memory, "the same field: memory", kMostBoreMemory_MB, " MB"));
    marks.push_back(figureOf(worst(rows, kDefectGroup, always, wrongSigns), wrongSigns,
                             "bunny with defects: wrong signs, worst defect", 0.1, " %"));
    // Derived: 2, 1, 2 and 4/3, see convergence_rows.h; placement of cells and points takes some away.
    marks.push_back(orderOf(rows, kCellOnSmooth, "order of the field's error in the cell, smooth surface", 1.75));
    marks.push_back(orderOf(rows, kCellAtEdges, "order of the field's error in the cell, edges", 0.75));
    marks.push_back(orderOf(rows, kSpacingOnSmooth, "order of the depth's error in the spacing, smooth", 1.75));
    marks.push_back(orderOf(rows, kSpacingAtEdges, "order of the depth's error in the spacing, edge", 1.0));
    const auto force = [&](Test test, Figure figure, const char* name, double limit) {
        marks.push_back(figureOf(worst(rows, kForceGroup, test, figure), figure, name, limit, " us"));
    };
    force(isMotion, medianTime, "forces: one warm QP, 200 contacts, median", 5.0);
    force(isMotion, p999Time, "forces: one warm QP, 200 contacts, p99.9", 20.0);
    force(isForce, medianTime, "forces: tick without field samples, median", 15.0);
    force(isForce, p999Time, "forces: tick without field samples, p99.9", 60.0);
    force(isTick, p999Time, "forces: whole tick, p99.9", 150.0);
    for (const Row& row : rows) {
        if (std::isnan(row.figure)) continue;
        marks.push_back({.name = row.group + ": " + row.method,
                         .value = row.figure,
                         .limit = row.figure_mark,
                         .unit = " " + row.figure_unit,
                         .note = row.settings});
    }
    return marks;
}

std::string describe(const std::vector<Mark>& marks) {
    std::string text = "\nmarks\n";
    for (const Mark& mark : marks) {
        const std::string value = std::isnan(mark.value) ? "-" : fmt::format("{:.4g}", mark.value);
        text += fmt::format("{:6} {:62} {:>8} {} {:.4g}{}  ({})\n", mark.met() ? "met" : "MISSED", mark.name, value,
                            mark.at_least ? ">=" : "<=", mark.limit, mark.unit, mark.note);
    }
    return text;
}

bool allMet(const std::vector<Mark>& marks) {
    return std::all_of(marks.begin(), marks.end(), [](const Mark& mark) { return mark.met(); });
}

}  // namespace passung::bench
