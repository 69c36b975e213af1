#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "analysis/truth/least_energy.h"
#include "core/base/random.h"
#include "tests/core/tick/wander.h"
#include "tests/hard/dense_overlap.h"
#include "tests/support/scenes.h"

// Random smooth paths of a hand over pairs of parametric shapes, and how the spring's force along them differs from
// that of the pose of least energy, found at each tick from the program's last proxy on.

namespace passung::grain {

inline constexpr double kStiffness = 2000.0;         // [N/m]
inline constexpr double kRotationalStiffness = 1.0;  // [N m/rad]
inline constexpr double kForce = 0.01;               // that a tick may differ by [N]
inline constexpr double kSnap = 1e-4;                // way of the reference in a tick that is no grain [m]
inline constexpr double kEnergy = 1e-12;             // that a tick may lie above the reference: 1e-6 K mm² [m²]
inline constexpr double kStill = 1e-7;               // way of a proxy that is caught [m]
inline constexpr double kMoves = 2e-6;               // way of hand and reference that is none of rest [m]
inline constexpr int kEvery = 40;                    // ticks of which one's overlap is measured
inline constexpr double kStart = 0.4;                // seconds until a path has come to where it wanders

/// Where a hand wanders.
struct Kind {
    std::string name;
    Vec3 middle, amplitude;  // of the held part's origin [m]
    Vec3 tilt;               // about x, y, z [rad]
};

/// A held part, what stands in its way, where it begins free of it and where hands lead it.
struct Pair {
    std::string name;
    shape::Shape held;
    std::vector<truth::PlacedShape> obstacles;
    Vec3 start;
    std::vector<Kind> kinds;
    double bore = 0.0;  // depth of the tip from which on it is in a bore [m]; 0: there is none
};

inline void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

/// A path of one kind: from the start, without a turn, then about.
class Hand {
public:
    Hand(const Pair& pair, const Kind& kind, std::uint64_t seed) : start_(pair.start), kind_(kind) {
        Random random(seed);
        for (int i = 0; i < 6; ++i) wander_.emplace_back(random, i == 2 ? 0.8 : 1.5, 0.5);
    }
    Pose at(double t) const {
        const double s = std::clamp(t / kStart, 0.0, 1.0), in = s * s * (3.0 - 2.0 * s);
        Vec3 p = start_ + in * (kind_.middle - start_), turn;
        for (int i = 0; i < 3; ++i) {
            p[i] += kind_.amplitude[i] * wander_[static_cast<std::size_t>(i)].at(t - kStart);
            turn[i] = kind_.tilt[i] * wander_[static_cast<std::size_t>(i) + 3].at(t - kStart);
        }
        return {rotationFromVector(turn), p};
    }

private:
    Vec3 start_;
    Kind kind_;
    std::vector<test::Wander> wander_;
};

/// 0 in the bore, 1 mouth and floor too, 2 pressed on the floor, 3 the tip's edge about the mouth, 4 on the top face
/// and the mouth's edges.
inline std::vector<Kind> kindsOfPeg() {
    const Vec3 tilt(0.05, 0.05, 1.0);
    return {{"in the bore", {0, 0, -.0125}, {.003, .003, .0095}, tilt},
            {"mouth and floor", {0, 0, -.013}, {.003, .003, .0145}, tilt},
            {"on the floor", {0, 0, -.027}, {.003, .003, .0003}, tilt},
            {"edge about the mouth", {0, 0, -.0015}, {.003, .003, .003}, tilt},
            {"top and mouth", {0, 0, -.0008}, {.006, .006, .0015}, tilt}};
}

inline std::vector<Pair> pairs() {
    using namespace shape;
    std::vector<Pair> all;
    for (const double play : {100e-6, 50e-6, 10e-6})
        all.push_back({"peg in " + std::to_string(static_cast<int>(std::lround(1e6 * play))) + " um",
                       Peg{.02, .05, .0005},
                       {{BorePlate{.06, .06, .03, .02 + 2.0 * play, .025, .0005}, Pose{}}},
                       {0, 0, .001},
                       kindsOfPeg(),
                       .0015});
    all.push_back({"square peg in 100 um",
                   SquarePeg{.02, .015, .05, .0005},
                   {{SquareBorePlate{.06, .06, .03, .0202, .0152, .025, .0005}, Pose{}}},
                   {0, 0, .001},
                   kindsOfPeg(),
                   .0015});
    const auto beside = [](double x, double z) { return Pose{Quat::Identity(), Vec3(x, 0, z)}; };
    all.push_back({"ball on two boxes",
                   Sphere{.02},
                   {{Box{.04, .04, .02}, beside(-.023, -.01)}, {Box{.04, .04, .02}, beside(.025, -.012)}},
                   {0, 0, .0105},
                   {{"groove", {0, 0, .0075}, {.009, .006, .002}, {1, 1, 1}},
                    {"edges and corners", {.002, .018, .0075}, {.014, .008, .003}, {1, 1, 1}}}});
    const Quat on_edge(Eigen::AngleAxisd(0.25 * std::numbers::pi, Vec3::UnitX()));
    all.push_back({"box along an edge",
                   Box{.03, .02, .01},
                   {{Box{.04, .02, .02}, Pose{on_edge, Vec3(0, 0, -.01 * std::sqrt(2.0))}}},
                   {0, 0, .0055},
                   {{"face on edge", {0, 0, .0035}, {.012, .005, .001}, {.15, .15, .6}},
                    {"edge over edge", {.004, .008, .0035}, {.02, .008, .003}, {.5, .5, 1.0}}}});
    return all;
}

/// What was seen along paths.
struct Seen {
    long ticks = 0, judged = 0, in_bore = 0;
    long unknown = 0, snaps = 0;         // ticks: the reference found no end; snapped
    long lagging = 0;                    // ticks: the program's looks ended, and not for a snap alone
    long lower = 0, off = 0;             // judged ticks that differ: energy below; not
    double bore = 0.0, elsewhere = 0.0;  // largest difference of the force [N]; elsewhere: where energy is not below
    double energy = -1.0;                // largest energy above the reference's [m²]
    double step = 0.0, step_bore = 0.0;  // largest step beyond the reference's [N]
    long steps = 0;                      // of more than 0.1 N
    int catches = 0, longest = 0;        // of more than 2 ms; the longest [ticks]
    double overlap = 0.0;                // [m]
    double most_looks_bore = 0.0;
    std::string worst;

    void add(const Seen& other);
};

inline void Seen::add(const Seen& o) {
    ticks += o.ticks, judged += o.judged, in_bore += o.in_bore, unknown += o.unknown, snaps += o.snaps;
    lagging += o.lagging, lower += o.lower, off += o.off, steps += o.steps, catches += o.catches;
    if (o.elsewhere > elsewhere || o.bore > bore) worst = o.worst;
    bore = std::max(bore, o.bore), elsewhere = std::max(elsewhere, o.elsewhere), energy = std::max(energy, o.energy);
    step = std::max(step, o.step), step_bore = std::max(step_bore, o.step_bore), longest = std::max(longest, o.longest);
    overlap = std::max(overlap, o.overlap), most_looks_bore = std::max(most_looks_bore, o.most_looks_bore);
}

inline scene::SceneSpec sceneOf(const Pair& pair, const Pose& start, scene::ContactMethod method) {
    auto spec = test::scene(pair.held, start, pair.obstacles[0].first, pair.obstacles[0].second, method);
    for (std::size_t i = 1; i < pair.obstacles.size(); ++i)
        spec.parts.push_back({.name = "other" + std::to_string(i),
                              .geometry = pair.obstacles[i].first,
                              .X_WP = pair.obstacles[i].second});
    spec.contact.geometry = scene::Geometry::ClosedForm;
    spec.contact.stiffness = kStiffness;
    spec.contact.rotational_stiffness = kRotationalStiffness;
    return spec;
}

/// What a path is judged by.
struct Judged {
    std::unique_ptr<truth::Separation> separation;
    std::function<scene::SceneSpec(const Pose& start, scene::ContactMethod method)> scene;
    std::function<double(const Pose&)> overlap;                // [m]
    double bore = 0.0;                                         // as in Pair
    double force = kForce;                                     // that a tick may differ by [N]
    double share = 0.0;                                        // of the reference's force, beside it
    std::function<void(double gap)> keep_gap = [](double) {};  // of the reference, told before each tick's [m]
};

inline Judged judgedOf(const Pair& pair) {
    std::vector<std::pair<hard::DenseBody, Pose>> fixed;
    for (const auto& [shape, X] : pair.obstacles) fixed.emplace_back(hard::denseBody(shape, 1e-3), X);
    const auto dense = std::make_shared<hard::DenseDistance>(hard::denseBody(pair.held, 1e-3), std::move(fixed));
    return {truth::separationOf(pair.held, pair.obstacles),
            [pair](const Pose& start, scene::ContactMethod method) { return sceneOf(pair, start, method); },
            [dense](const Pose& X) { return -dense->least(X, 0.0); }, pair.bore};
}

/// Follows one path.
class Judge {
public:
    explicit Judge(Judged judged) : judged_(std::move(judged)) {}

    template <class Path>
    Seen follow(const Path& path, int ticks, const std::string& name, scene::ContactMethod method) {
        test::Bench bench(judged_.scene(path(0), method));
        Seen seen;
        Pose last = path(0);
        bool compares = false;  // the tick before is one to step from
        std::optional<Pose> truth_last;
        int lagging = 3, still = 0;
        for (int i = 0; i < ticks; ++i) {
            const Pose X_WH = path(i), X_last = last;
            const tick::TickOutput out = bench.step(X_WH);
            ++seen.ticks;
            if (i % kEvery == 0) seen.overlap = std::max(seen.overlap, judged_.overlap(out.X_WG));
            const bool lagged = lagging == 0;
            lagging = (out.frame.status & kIterationLimit) != 0 ? 0 : std::min(lagging + 1, 3);
            judged_.keep_gap(out.frame.proxy_gap);
            const auto truth = truth::leastEnergyFrom(*judged_.separation, rho_, X_last, X_WH);
            last = out.X_WG;
            const bool snaps = truth && truth->way > kSnap;
            // A snap may take two ticks: its looks are short, so that its way is free.
            if (lagging == 0 && (lagged || !snaps)) ++seen.lagging;
            if (!truth) ++seen.unknown;
            if (snaps) ++seen.snaps;
            if (!truth || snaps || lagging < 3) {
                compares = false;
                truth_last.reset();
                still = 0;
                continue;
            }
            judge(path, i, X_last, out, *truth, compares, name, seen);
            compares = true;
            const double moved = truth::pullTo(X_last, out.X_WG, rho_).norm();
            const bool asked = truth_last && truth::pullTo(path(i - 1), X_WH, rho_).norm() > kMoves &&
                               truth::pullTo(*truth_last, truth->X, rho_).norm() > kMoves;
            truth_last = truth->X;
            still = asked && moved < kStill ? still + 1 : 0;
            if (still == 3) ++seen.catches;
            seen.longest = std::max(seen.longest, still);
        }
        return seen;
    }

private:
    template <class Path>
    void judge(const Path& path, int i, const Pose& X_last, const tick::TickOutput& out,
               const truth::LeastEnergy& truth, bool compares, const std::string& name, Seen& seen) const {
        const Pose X_WH = path(i);
        const Vec3 force = kStiffness * (out.X_WG.p - X_WH.p), meant = kStiffness * (truth.X.p - X_WH.p);
        const double error = (force - meant).norm();
        const bool differs = error > judged_.force + judged_.share * meant.norm();
        const double above = 0.5 * truth::pullTo(out.X_WG, X_WH, rho_).squaredNorm() - truth.energy;
        const bool in_bore = judged_.bore > 0.0 && out.X_WG.p.z() < -judged_.bore && X_WH.p.z() < -judged_.bore;
        ++seen.judged;
        seen.energy = std::max(seen.energy, above);
        if (in_bore) {
            ++seen.in_bore;
            seen.bore = std::max(seen.bore, error);
            seen.most_looks_bore = std::max(seen.most_looks_bore, static_cast<double>(out.frame.iterations));
        }
        if (differs) ++(above <= 0.0 ? seen.lower : seen.off);
        if (above > 0.0 && error > seen.elsewhere) {
            seen.elsewhere = error;
            seen.worst = name + ", tick " + std::to_string(i);
        }
        if (!compares || i == 0) return;
        const Vec3 before = kStiffness * (X_last.p - path(i - 1).p);
        const double beyond = (force - before).norm() - (meant - before).norm();
        if (above <= 0.0 && differs) return;  // another minimum
        seen.step = std::max(seen.step, beyond);
        if (in_bore) seen.step_bore = std::max(seen.step_bore, beyond);
        if (beyond > 0.1) ++seen.steps;
    }

    Judged judged_;
    double rho_ = std::sqrt(kRotationalStiffness / kStiffness);
};

}  // namespace passung::grain
