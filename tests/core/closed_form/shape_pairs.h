#pragma once

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/closed_form/pair_contacts.h"

namespace passung::closed_form {

/// A held part, an obstacle, and where a hand moves it about: in the obstacle's frame.
struct ShapePair {
    std::string name;
    shape::Shape held, obstacle;
    Vec3 start, amplitude;  // [m]
    double tilt;            // [rad]
};

inline std::vector<ShapePair> shapePairs() {
    using namespace shape;
    return {
        {"ball_on_box", Sphere{.02}, Box{.03, .02, .01}, {0, 0, .012}, {.02, .018, .008}, 1.0},
        {"box_on_box", Box{.02, .03, .01}, Box{.03, .02, .01}, {0, 0, .01}, {.02, .018, .006}, .3},
        {"ring_on_box", Torus{.03, .006}, Box{.03, .02, .01}, {0, 0, .008}, {.02, .018, .006}, .5},
        {"bar_across_bar", Cylinder{.01, .03}, Cylinder{.012, .04}, {.008, 0, 0}, {.01, .012, .012}, .8},
        {"ring_on_ring", Torus{.03, .006}, Torus{.03, .008}, {0, 0, .006}, {.01, .01, .006}, .5},
        {"peg_in_bore",
         Peg{.02, .05, .0005},
         BorePlate{.06, .06, .03, .0201, .025, .0005},
         {0, 0, -.01},
         {.003, .003, .008},
         .05},
        {"peg_on_plate",
         Peg{.02, .05, .0005},
         BorePlate{.06, .06, .03, .0201, .025, .0005},
         {.02, 0, .001},
         {.02, .02, .004},
         .5},
        {"square_in_square",
         SquarePeg{.02, .015, .05, .0005},
         SquareBorePlate{.06, .06, .03, .0202, .0152, .025, .0005},
         {0, 0, -.01},
         {.003, .003, .008},
         .05},
        {"key_in_keyway",
         KeyedPeg{.02, .05, .006, .003, .0005},
         KeyedBorePlate{.06, .06, .03, .0202, .0062, .0031, .025, .0005},
         {0, 0, -.01},
         {.003, .003, .008},
         .05},
        {"box_in_bore",
         Box{.005, .006, .03},
         BorePlate{.06, .06, .03, .02, .025, .0005},
         {0, 0, -.005},
         {.009, .009, .006},
         .3},
    };
}

/// Bolts and nuts: see thread_reference.h.
inline std::vector<ShapePair> threadPairs() {
    using namespace shape;
    return {
        {"bolt_in_nut",
         ThreadBolt{.00794, .00125, .02, .0009},
         ThreadNut{.008, .00125, .013, .0065, .0008},
         {0, 0, -.005},
         {.001, .001, .001},
         .05},
        {"bolt_on_nut",
         ThreadBolt{.00794, .00125, .012, .0},
         ThreadNut{.008, .00125, .013, .0065, .0},
         {0, 0, .0005},
         {.004, .004, .002},
         .5},
        {"nut_on_bolt",
         ThreadNut{.0121, .00175, .018, .008, .001},
         ThreadBolt{.012, .00175, .03, .0015},
         {0, 0, .02},
         {.002, .002, .002},
         .2},
    };
}

inline std::vector<ShapePair> allPairs() {
    std::vector<ShapePair> pairs = shapePairs(), threads = threadPairs();
    pairs.insert(pairs.end(), threads.begin(), threads.end());
    return pairs;
}

inline Vec3 randomVector(Random& random, const Vec3& size) {
    return {random.uniform(-size.x(), size.x()), random.uniform(-size.y(), size.y()),
            random.uniform(-size.z(), size.z())};
}

inline Quat randomRotation(Random& random, double most) {
    return rotationFromVector(most / std::sqrt(3.0) * randomVector(random, Vec3::Ones()));
}

inline const auto nameOfPair = [](const auto& info) { return info.param.name; };

inline void PrintTo(const ShapePair& pair, std::ostream* out) { *out << pair.name; }

}  // namespace passung::closed_form
