#include "core/scene/field_estimate.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "core/field/distance_field.h"
#include "core/scene/number_text.h"

namespace passung::scene {

namespace {

constexpr double kMostBytes = 2.0 * 1024.0 * 1024.0 * 1024.0;
constexpr double kBytesOfBrick = 2.0 * field::DistanceField::kBrickNodes * field::DistanceField::kBrickNodes *
                                 field::DistanceField::kBrickNodes;  // samples of 16 bits
// Bricks that a plane along the axes meets, with a band of a quarter of a brick on both sides, and the coarser ones
// that they refine: 1.5 (1 + 1/4 + 1/16 ...).
constexpr double kBricksPerFace = 1.5 * 4.0 / 3.0;

}  // namespace

std::optional<std::string> fieldTooLarge(const Vec3& size, double area, double cell) {
    const double edge = field::DistanceField::kBrickCells * cell;
    const double bytes = kBricksPerFace * kBytesOfBrick * area / (edge * edge);
    if (!(bytes > kMostBytes)) return std::nullopt;
    const double enough = 1.005 * cell * std::sqrt(bytes / kMostBytes);  // rounded to three digits, still enough
    const auto length = [&](int axis) { return number("%.4g", 1e3 * size[axis]); };
    return "cells of " + number("%.3g", 1e3 * cell) + " mm on a part of " + length(0) + " x " + length(1) + " x " +
           length(2) + " mm need about " + number("%.2g", bytes / (kMostBytes / 2.0)) +
           " GiB, more than 2: choose cells of at least " + number("%.3g", 1e3 * enough) + " mm";
}

}  // namespace passung::scene
