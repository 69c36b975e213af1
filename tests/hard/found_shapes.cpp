#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "devices/scripted/trajectory.h"
#include "tests/hard/found.h"
#include "tests/support/surface_cases.h"

namespace passung::hard {

namespace {

using Hand = std::function<Pose(const Pose& start, double t)>;

/// The path of a case of meshes, of which the scene file's shapes are the like.
Hand wander(const Vec3& drift, const Vec3& amplitude, double tilt, std::uint64_t seed) {
    return [=](const Pose& start, double t) { return test::RandomPath(start, drift, amplitude, tilt, seed)(t); };
}

Result<FoundScene> pin(std::uint64_t seed) {
    return foundScene("found_pin", wander({0, 0, -.003}, {.004, .004, .002}, 0.1, pathSeed(1, seed)));
}
Result<FoundScene> pinCell(std::uint64_t seed) {
    return foundScene("found_pin_cell", wander({0, 0, -.003}, {.004, .004, .002}, 0.1, pathSeed(21, seed)));
}
Result<FoundScene> finCell(std::uint64_t seed) {
    return foundScene("found_fin_cell", wander({0, 0, -.003}, {.006, .004, .002}, 0.2, pathSeed(2, seed)));
}
Result<FoundScene> corner(std::uint64_t seed) {
    return foundScene("found_corner", wander({0, 0, -.003}, {.006, .006, .002}, 0.2, pathSeed(3, seed)));
}
Result<FoundScene> slot(std::uint64_t seed) {
    return foundScene("found_slot", wander({0, 0, -.006}, {.002, .004, .003}, 0.15, pathSeed(4, seed)));
}
Result<FoundScene> rings(std::uint64_t seed) {
    return foundScene("found_rings", wander({0, 0, 0}, {.002, .002, .003}, 0.15, pathSeed(5, seed)));
}
Result<FoundScene> ball(std::uint64_t seed) {
    return foundScene("found_ball", wander({0, 0, -.002}, {.004, .006, .001}, 0.2, pathSeed(15, seed)));
}
Result<FoundScene> edge(std::uint64_t seed) {
    return foundScene("found_edge", wander({0, 0, -.002}, {.002, .008, .001}, 0.15, pathSeed(16, seed)));
}
Result<FoundScene> bar(std::uint64_t) {
    return foundScene("found_bar", [](const Pose& start, double t) {
        return Pose{start.q * Quat(Eigen::AngleAxisd(100.0 * t, Vec3::UnitZ())), start.p};
    });
}

constexpr double kInsertion = 0.022;  // [m/s]

/// Down the bore for a second, then about its middle.
Hand insert(const Vec3& amplitude, double tilt, std::uint64_t seed) {
    return [=](const Pose& start, double t) {
        Pose above = start;
        above.p.z() -= kInsertion * std::min(t, 1.0);
        return t < 1.0 ? above : test::RandomPath(above, {0, 0, .006}, amplitude, tilt, seed)(t - 1.0);
    };
}

/// Down the bore, then drawn aside with 6 N and tilted by 2.9 degrees, both turning, while it goes up and down, at up
/// to 31 mm/s.
Hand tilt(std::uint64_t seed) {
    Random random(seed);
    const double aside = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double lean = random.uniform(0.0, 2.0 * std::numbers::pi);
    return [=](const Pose& start, double t) {
        const double after = std::max(0.0, t - 1.0), s = std::min(1.0, after / 0.3), ramp = s * s * (3.0 - 2.0 * s);
        const double a = aside + 1.5 * std::numbers::pi * after, b = lean - 2.0 * std::numbers::pi * after;
        Pose X = start;
        X.p.z() -= kInsertion * std::min(t, 1.0) - 0.004 * (1.0 - std::cos(2.0 * std::numbers::pi * after));
        X.p += 0.003 * ramp * Vec3(std::cos(a), std::sin(a), 0.0);
        X.q = rotationFromVector(0.05 * ramp * Vec3(std::cos(b), std::sin(b), 0.0)) * start.q;
        return X;
    };
}

/// Seed 0: the path on which pegs caught.
Result<FoundScene> tilted(const char* file, std::uint64_t seed) {
    if (seed > 0) return foundScene(file, tilt(seed));
    auto path = scripted::Trajectory::read(hardScenesFile("found_tilted_peg.csv"));
    if (!path) return path.errors();
    return foundScene(file, [path = *path](const Pose&, double t) {
        return path.at(std::min<std::int64_t>(std::llround(t / kTickSeconds), path.lastTick()));
    });
}

Result<FoundScene> tilted100(std::uint64_t seed) { return tilted("found_tilted_100um", seed); }
Result<FoundScene> tilted50(std::uint64_t seed) { return tilted("found_tilted_50um", seed); }
Result<FoundScene> tilted10(std::uint64_t seed) { return tilted("found_tilted_10um", seed); }
Result<FoundScene> square(std::uint64_t seed) {
    return foundScene("found_square", insert({.002, .002, .004}, 0.04, pathSeed(17, seed)));
}
/// Over the mouth's edges and corners, tilted by up to 30 degrees.
Result<FoundScene> squareMouth(std::uint64_t seed) {
    return foundScene("found_square", wander({0, 0, -.0024}, {.0048, .0048, .0048}, 0.5, pathSeed(3, seed)));
}
Result<FoundScene> h7g6(std::uint64_t seed) {
    return foundScene("found_h7g6", insert({.001, .001, .004}, 0.03, pathSeed(18, seed)));
}
Result<FoundScene> keyed(std::uint64_t seed) {
    return foundScene("found_keyed", insert({.001, .001, .004}, 0.03, pathSeed(19, seed)));
}

/// A peg in a bore, drawn aside and tilted.
Found tiltedPeg(const char* name, Result<FoundScene> (*make)(std::uint64_t), double most_axial, double most_us) {
    return {.name = name,
            .make = make,
            .was = {.step = "1.26 N"},
            .methods = kGods,
            .seconds = 3.0,
            .most_step = 0.05,
            .most_us = most_us,
            .most_axial = most_axial,
            .most_off = 0.01};
}

}  // namespace

std::vector<Found> foundShapes() {
    constexpr const char *kPin = "4900 um, recorded 0.25", *kCell = "4900 um, 0 N, 0 contacts";
    return {
        {.name = "pin", .make = pin, .was = {kPin}, .methods = kGods},
        {.name = "pin_cell", .make = pinCell, .was = {kCell}, .methods = kGods},
        {.name = "fin_cell", .make = finCell, .was = {kCell}, .methods = kGods},
        {.name = "corner", .make = corner, .was = {"648 um, recorded 1.3"}, .methods = kGods},
        {.name = "slot", .make = slot, .was = {"450 um, recorded 1.25"}, .methods = kGods},
        {.name = "rings", .make = rings, .was = {"125 um, recorded 4.0"}, .methods = kGods},
        tiltedPeg("tilted_100um", tilted100, 0.07, 800.0),
        tiltedPeg("tilted_50um", tilted50, 0.05, 800.0),
        tiltedPeg("tilted_10um", tilted10, 0.015, 60.0),
        {.name = "square", .make = square, .methods = kGods, .seconds = 2.0, .way_every = 2},
        {.name = "square_mouth", .make = squareMouth, .methods = kGods, .seconds = 1.5, .snaps = true},
        {.name = "ball", .make = ball, .methods = kGods, .most_off = 0.01},
        {.name = "edge", .make = edge, .methods = kGods},
        {.name = "bar",
         .make = bar,
         .was = {.time = "both ways 80 % of ticks > 1 ms"},
         .methods = kGods,
         .seconds = 1.0,
         .full_seconds = 10.0,
         .full_seeds = 1,
         .outruns = true},
        {.name = "h7g6", .make = h7g6, .methods = kGods, .seconds = 2.0},
        {.name = "keyed", .make = keyed, .methods = kGods, .seconds = 1.6, .way_every = 10},
    };
}

}  // namespace passung::hard
