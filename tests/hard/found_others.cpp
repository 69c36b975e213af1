#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/hard/figures.h"
#include "tests/hard/found.h"
#include "tests/support/mesh_crossing.h"
#include "tests/support/surface_cases.h"

namespace passung::hard {

namespace {

// ---- starts deep in a mesh ------------------------------------------------------------------------------------------

constexpr std::int64_t kLeave = 1000;  // ticks to come out

/// The hand stays where the part begins; `inside`: it is where no triangles meet, and yet within the other. Truth:
/// crossings triangle by triangle (mesh_crossing.h) and closed forms of `inside`.
Result<FoundMeasured> leave(FoundScene scene, scene::ContactMethod method, bool (*inside)(const Vec3&)) {
    scene.spec.contact.method = method;
    const auto run = runScene(scene.spec, driveOf(scene), kLeave);
    if (!run) return run.errors();
    test::MeshPairTruth truth(scene.held, scene.obstacle);
    FoundMeasured result;
    Pose last = scene.hand(0.0);
    double fastest = 0.0, out_after = kLeave, again = 0.0, unsaid = 0.0, said = 0.0;
    bool apart = false;
    for (std::size_t i = 0; i < run->ticks.size(); ++i) {
        const Tick& t = run->ticks[i];
        result.us.push_back(static_cast<double>(t.us));
        fastest = std::max(fastest, (t.proxy.p - last.p).norm() / kTickSeconds);
        last = t.proxy;
        const bool crosses = truth.distance(t.proxy, 1e-9) == 0.0;
        ++result.poses;
        const bool told = (t.status & kLedOut) != 0, in = crosses || inside(t.proxy.p);
        if (apart && in) again += 1.0;
        if (in && !told && i > 0) unsaid += 1.0;
        if (apart && told) said += 1.0;
        if (!apart && !in) {
            apart = true;
            out_after = static_cast<double>(i);
        }
    }
    constexpr const char* kWas = "never";
    result.figures = {{"the part is still in the other after a second", "", apart ? 0.0 : 1.0, 0.0, true, kWas},
                      {"ticks until it is out", "", out_after, static_cast<double>(kLeave), true, kWas},
                      {"fastest proxy", "m/s", fastest, 1.001, true},
                      {"ticks in the other that the record does not tell of", "", unsaid, 0.0, true},
                      {"ticks told of as in the other after it was out", "", said, 0.0, true},
                      {"poses at which triangles cross after they were apart", "", again, 0.0, true}};
    return result;
}

bool nowhere(const Vec3&) { return false; }

Quat turnBy(double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, -1.0).normalized())); }

Result<FoundMeasured> startInSeams(scene::ContactMethod method, bool) {
    const test::SurfaceCase made = test::blockOnSeams();
    return leave(meshScene("start_seams", made.held, made.obstacle,
                           [](double) {
                               return Pose{Quat::Identity(), Vec3(0.001, 0.002, -0.003)};
                           }),
                 method, nowhere);
}

Result<FoundMeasured> startInScan(scene::ContactMethod method, bool) {
    const test::SurfaceCase made = test::scanOnScan(.03, 60);
    return leave(meshScene("start_scan", made.held, made.obstacle,
                           [](double) {
                               return Pose{Quat::Identity(), Vec3(0.002, 0.001, 0.028)};
                           }),
                 method, nowhere);
}

/// A cube of 20 mm around one of 4 mm: it is the obstacle that lies within the held part.
Result<FoundMeasured> startAround(scene::ContactMethod method, bool) {
    return leave(meshScene("start_around", test::boxMesh(Vec3::Constant(-.01), Vec3::Constant(.01)),
                           test::boxMesh(Vec3::Constant(-.002), Vec3::Constant(.002)),
                           [](double) {
                               return Pose{turnBy(0.4), Vec3(0.001, 0.002, 0.003)};
                           }),
                 method, [](const Vec3& p) { return (turnBy(0.4).conjugate() * -p).cwiseAbs().maxCoeff() < 0.01; });
}

/// A turned cube of 4 mm deep in a scan of 30 mm, whose least radius is above 13 mm.
Result<FoundMeasured> startInScanWholly(scene::ContactMethod method, bool) {
    const test::SurfaceCase made = test::scanOnScan(.03, 60);
    return leave(
        meshScene("start_in_scan_wholly", test::boxMesh(Vec3::Constant(-.002), Vec3::Constant(.002)), made.obstacle,
                  [](double) {
                      return Pose{turnBy(0.7), Vec3(0.001, 0.003, 0.002)};
                  }),
        method, [](const Vec3& p) { return p.norm() < 0.013; });
}

/// In the bend of an L of two boxes that share a side, where no face is near.
Result<FoundMeasured> startInBend(scene::ContactMethod method, bool) {
    const test::Profile2 line{{-.01, -.01}, {.03, -.01}, {.03, .01}, {.01, .01}, {.01, .03}, {-.01, .03}};
    return leave(meshScene("start_in_bend", test::boxMesh(Vec3::Constant(-.002), Vec3::Constant(.002)),
                           test::solidMesh(line, {0, 0}, -.02, .02),
                           [](double) {
                               return Pose{turnBy(0.2), Vec3(0.004, 0.004, 0.001)};
                           }),
                 method, [](const Vec3& p) {
                     const bool in_first = p.x() > -.01 && p.x() < .03 && p.y() > -.01 && p.y() < .01;
                     const bool in_second = p.x() > -.01 && p.x() < .01 && p.y() > -.01 && p.y() < .03;
                     return (in_first || in_second) && std::abs(p.z()) < .02;
                 });
}

/// A cube of 4 mm wholly in one of 20 mm, 5 mm below its top.
Result<FoundMeasured> startInside(scene::ContactMethod method, bool) {
    return leave(meshScene("start_inside", test::boxMesh(Vec3::Constant(-.002), Vec3::Constant(.002)),
                           test::boxMesh(Vec3::Constant(-.01), Vec3::Constant(.01)),
                           [](double) {
                               return Pose{Quat::Identity(), Vec3(0.001, 0.0, 0.003)};
                           }),
                 method, [](const Vec3& p) { return p.cwiseAbs().maxCoeff() < 0.01; });
}

// ---- god objects under a node budget --------------------------------------------------------------------------------

constexpr double kMoves = 2.0;    // [s]; then the hand rests for a second and a half
constexpr double kFactor = 1.25;  // of the unlimited force
constexpr double kSlack = 0.05;   // [N]

Result<FoundScene> budgetScene(scene::ContactMethod method, int nodes) {
    auto scene = foundScene("found_budget", [](const Pose& start, double t) {
        Pose above = start;
        above.p.z() -= 0.022 * std::min(t, 1.0);
        if (t < 1.0) return above;
        return test::RandomPath(above, {.001, 0, .004}, {.001, .001, .004}, 0.03, 20)(std::min(t, kMoves) - 1.0);
    });
    if (!scene) return scene;
    scene->spec.contact.method = method;
    scene->spec.contact.budget_nodes = nodes;
    return scene;
}

Vec3 springOf(const Run& run, std::size_t tick) {
    return run.spec.contact.stiffness * (run.ticks[tick].proxy.p - run.ticks[tick].device.p);
}

Result<FoundMeasured> budgets(scene::ContactMethod method, bool) {
    constexpr std::int64_t kTicks = 3500;
    const auto runWith = [&](int nodes) -> Result<Run> {
        const auto scene = budgetScene(method, nodes);
        if (!scene) return scene.errors();
        return runScene(scene->spec, driveOf(*scene), kTicks);
    };
    const auto unlimited = runWith(0);
    if (!unlimited) return unlimited.errors();
    FoundMeasured result;
    double most = 0.0;
    for (std::size_t i = 0; i < unlimited->ticks.size(); ++i) most = std::max(most, springOf(*unlimited, i).norm());
    for (const int nodes : {1000, 100}) {
        const auto run = runWith(nodes);
        if (!run) return run.errors();
        double above = 0.0, largest = 0.0, lag = 0.0;
        for (std::size_t i = 0; i < run->ticks.size(); ++i) {
            const double force = springOf(*run, i).norm();
            largest = std::max(largest, force);
            const double lags = run->spec.contact.stiffness * run->ticks[i].lag;
            above = std::max(above, force - kFactor * springOf(*unlimited, i).norm() - lags - kSlack);
            lag = std::max(lag, run->ticks[i].lag);
            result.us.push_back(static_cast<double>(run->ticks[i].us));
        }
        const std::size_t end = run->ticks.size() - 1;
        const double rest = (springOf(*run, end) - springOf(*unlimited, end)).norm() / springOf(*unlimited, end).norm();
        const char* const was = nodes == 1000 ? "6.6 N of 2.33" : "12 N of 2.33, saturated";
        const std::string of = fmt::format("{} nodes: ", nodes);
        result.figures.push_back({of + "largest force, of " + fmt::format("{:.2f} N without a budget", most), "N",
                                  largest, std::max(kFactor * most + kSlack, 0.0), false, was});
        result.figures.push_back({of + "force above 1.25 times the unlimited one, stiffness times lag and 0.05 N", "N",
                                  std::max(above, 0.0), 0.0, true, was});
        result.figures.push_back({of + "lag", "um", kUm * lag, std::numeric_limits<double>::infinity()});
        result.figures.push_back(
            {of + "force off the unlimited one after the hand rested", "%", 100.0 * rest, 1.0, true});
        result.figures.push_back(
            {of + "deepest overlap", "um", kUm * deepestOverlap(*run), kUm * run->spec.contact.tolerance, true});
    }
    return result;
}

}  // namespace

std::vector<Found> foundOthers() {
    return {{.name = "start_in_seams", .make = nullptr, .compute = startInSeams},
            {.name = "start_in_scan", .make = nullptr, .compute = startInScan},
            {.name = "start_inside", .make = nullptr, .compute = startInside},
            {.name = "start_around", .make = nullptr, .compute = startAround},
            {.name = "start_in_scan_wholly", .make = nullptr, .compute = startInScanWholly},
            {.name = "start_in_bend", .make = nullptr, .compute = startInBend},
            {.name = "budgets", .make = nullptr, .methods = 0b110, .compute = budgets}};
}

}  // namespace passung::hard
