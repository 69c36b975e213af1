#pragma once

#include <string>
#include <vector>

#include "tests/bench/method.h"

namespace passung::bench {

constexpr double kUm = 1e6;  // in a metre

struct Times {
    double mean = kNotGiven, median = kNotGiven, p99 = kNotGiven, max = kNotGiven;
    double p999 = kNotGiven;  // p99, p99.9: nearest rank
};

/// @pre not empty
Times summarise(std::vector<double> values);

/// One measured setting of one method. What does not apply is NaN: NA in the CSV, - in the table.
struct Row {
    std::string group, method, settings;
    bool ours = false;
    std::size_t samples = 0;
    Times time_us = {};  // of one query; of the fastest repetition of each pose
    double ns_per_point = kNotGiven;
    Times distance_error_um = {};     // |signed distance - truth|
    double bound_max_um = kNotGiven;  // the largest error bound that the method stated
    double bound_broken = kNotGiven;  // poses whose error is larger than the bound stated for them
    Times force_error_percent = {};   // | |F| - |F_truth| | / |F_truth|
    Times force_turn_deg = {};        // between F and F_truth
    Times torque_error_percent =
        {};  // |T - T_truth| / (|F_truth| · lever), lever = the tool's farthest point from its origin
    double wrong_signs_percent = kNotGiven;
    double other_bits = kNotGiven;  // values that differ in any bit from those of our first variant
    double order = kNotGiven;       // log2 of the ratio of errors when the resolution is halved
    double contacts_mean = kNotGiven;
    Times depth_um = {};  // overlap that a method leaves
    double memory_MB = kNotGiven;
    double build_s = kNotGiven;
    double figure = kNotGiven, figure_mark = kNotGiven;  // a number of its own, met if figure ≤ figure_mark
    std::string figure_unit = {};
};

std::string csvHeader();
std::string csvLine(const Row& row);

/// All rows, grouped, for a terminal.
std::string table(const std::vector<Row>& rows);

}  // namespace passung::bench
