#include "tests/hard/found.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tests/hard/case.h"
#include "tests/hard/figures.h"
#include "tests/hard/follow.h"
#include "tests/hard/found_onlooker.h"
#include "tests/support/off_file.h"
#include "tests/support/temp_folder.h"

namespace passung::hard {

namespace {

constexpr double kFastestHand = 0.1;    // [m/s]
constexpr double kLeastPressed = 0.05;  // of all ticks: less is no test
constexpr double kMostSuspended = 0.1;  // [%] of ticks
constexpr double kMostInARow = 5.0;     // ticks
constexpr double kMostLag = 50.0;       // [um]
constexpr double kMostOverlap = 0.1;    // of closed forms [um]
constexpr double kMostTick = 1000.0;    // [us]
constexpr double kNoMark = std::numeric_limits<double>::infinity();
constexpr double kMostDampedStep = 0.10;  // of a tilted peg [N]

double ranked(std::vector<double> sorted, double share) {
    if (sorted.empty()) return 0.0;
    std::sort(sorted.begin(), sorted.end());
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::max<std::size_t>(rank, 1) - 1];
}

double percent(std::size_t part, std::size_t whole) {
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

void addTruth(const Found& found, const Seen& seen, bool triangles, std::vector<Figure>& figures) {
    const auto count = [](std::size_t n) { return static_cast<double>(n); };
    const auto asserted = [&](const char* name, const char* unit, double value, double mark, const char* was = "") {
        figures.push_back({name, unit, value, mark, true, was});
    };
    if (triangles) {
        asserted("poses shown at which triangles cross", "", count(seen.crossings), 0.0, found.was.overlap);
        asserted("poses on the way there at which triangles cross", "", count(seen.between), 0.0);
        asserted("gaps told above the exact one", "", count(seen.gaps_too_high), 0.0);
        figures.push_back({"gaps told under a row and too low", "%", percent(seen.gaps_loose, seen.gaps), 0.0});
        figures.push_back(
            {"looks in which the proxy stays away and touches nothing", "", count(seen.hanging), 0.0, !found.outruns});
        const double marked = found.may_be_suspended ? kNoMark : 1.0;
        figures.push_back({"ticks suspended", "%", percent(seen.suspended, seen.ticks), marked * kMostSuspended});
        figures.push_back({"ticks suspended in a row", "", count(seen.suspended_in_a_row), marked * kMostInARow});
        figures.push_back({found.may_be_suspended ? "lag behind the hand" : "lag while suspended", "um", kUm * seen.lag,
                           marked * kMostLag});
    } else {
        asserted("deepest overlap shown", "um", kUm * seen.overlap, kMostOverlap, found.was.overlap);
        figures.push_back(
            {"deepest overlap on the way there", "um", kUm * seen.overlap_between, kMostOverlap, !found.snaps});
    }
    asserted("ticks that are not finite", "", count(seen.not_finite), 0.0);
    asserted("share of ticks in contact short of a twentieth", "%",
             std::max(0.0, 100.0 * kLeastPressed - percent(seen.pressed, seen.ticks)), 0.0);
    asserted("speed of the hand", "m/s", seen.speed, kFastestHand);
}

void addForces(const Found& found, const Seen& seen, std::vector<Figure>& figures) {
    const auto add = [&](const char* name, double value, double mark, const char* was = "") {
        figures.push_back({name, "N", value, mark, false, was});
    };
    if (found.most_axial > 0.0) {
        figures.push_back({"catches", "", static_cast<double>(seen.catches), 0.0, false, "40"});
        add("step of the spring's force", seen.step, found.most_step);
        add("step of the force with the damper", seen.sent, kMostDampedStep, found.was.step);
        add("force along the bore", seen.axial, found.most_axial, "1.03 N");
    } else {
        add("step of the spring's force beyond the hand's", seen.beyond, found.most_step, found.was.step);
    }
    if (found.most_off > 0.0) add("force off the reference", seen.off, found.most_off);
}

}  // namespace

std::span<const Found> foundCases() {
    static const std::vector<Found> kAll = [] {
        std::vector<Found> all;
        for (const auto& some : {foundShapes(), foundMeshes(), foundOthers()})
            all.insert(all.end(), some.begin(), some.end());
        return all;
    }();
    return kAll;
}

Drive driveOf(const FoundScene& scene) {
    return [hand = scene.hand](std::int64_t tick, const tick::TickOutput*) {
        return DeviceReading{hand(kTickSeconds * static_cast<double>(tick))};
    };
}

Result<FoundScene> foundScene(const std::string& file, const std::function<Pose(const Pose& start, double t)>& hand) {
    auto spec = readHardScene(file);
    if (!spec) return spec.errors();
    FoundScene scene{.spec = std::move(*spec), .hand = {}};
    scene.spec.limits.max_force = 1e6;
    scene.spec.limits.max_torque = 1e6;
    scene.spec.limits.max_force_rate = 1e12;
    scene.hand = [hand, start = heldPart(scene.spec).X_WP](double t) { return hand(start, t); };
    return scene;
}

FoundScene meshScene(const std::string& name, const geometry::TriangleMesh& held,
                     const geometry::TriangleMesh& obstacle, const std::function<Pose(double)>& hand) {
    static const test::TempFolder folder;  // parts are built from it as long as the program runs
    static std::map<std::string, bool> written;
    const std::string held_path = folder / (name + "_held.off"), obstacle_path = folder / (name + "_obstacle.off");
    if (!written[name]) {
        test::writeOff(held_path, held);
        test::writeOff(obstacle_path, obstacle);
        written[name] = true;
    }
    FoundScene scene{.spec = {}, .hand = hand, .held = held, .obstacle = obstacle};
    scene.spec.parts = {{.name = "held", .geometry = scene::MeshFile{held_path, 1.0}, .X_WP = hand(0.0), .held = true},
                        {.name = "obstacle", .geometry = scene::MeshFile{obstacle_path, 1.0}, .X_WP = Pose{}}};
    scene::ContactSpec& contact = scene.spec.contact;
    contact.stiffness = 2000.0;
    contact.rotational_stiffness = 1.0;
    contact.damping = 5.0;
    scene.spec.limits = {.max_force = 1e6, .max_torque = 1e6, .max_force_rate = 1e12};
    return scene;
}

Result<FoundMeasured> measureFound(const Found& found, scene::ContactMethod method, bool full, int runs) {
    if (found.compute != nullptr) return found.compute(method, full);
    const std::int64_t ticks = std::llround((full ? found.full_seconds : found.seconds) / kTickSeconds);
    FoundMeasured result;
    Seen all;
    std::string not_followed;
    bool triangles = false;
    for (int seed = 0; seed < (full ? found.full_seeds : 1); ++seed) {
        auto scene = found.make(static_cast<std::uint64_t>(seed));
        if (!scene) return scene.errors();
        scene->spec.contact.method = method;
        triangles = !scene->held.triangles.empty();
        FoundOnlooker looks(found, *scene, full);
        const auto run =
            runScene(scene->spec, driveOf(*scene), ticks, [&](const auto&... of_tick) { looks.look(of_tick...); });
        if (!run) return run.errors();
        if (!triangles && not_followed.empty()) not_followed = followFault(*run);
        std::vector<double> us;
        for (const Tick& t : run->ticks) us.push_back(static_cast<double>(t.us));
        for (int again = 1; again < runs; ++again) {
            const auto timed = runScene(scene->spec, driveOf(*scene), ticks);
            if (!timed) return timed.errors();
            for (std::size_t i = 0; i < us.size(); ++i)
                us[i] = std::min(us[i], static_cast<double>(timed->ticks[i].us));
        }
        result.us.insert(result.us.end(), us.begin(), us.end());
        all.take(looks.seen());
        if (full)
            fmt::print(stderr, "{} seed {}: {} crossings, {:.3g} um\n", found.name, seed,
                       looks.seen().crossings + looks.seen().between, kUm * looks.seen().overlap);
    }
    result.poses = all.poses;
    addTruth(found, all, triangles, result.figures);
    if (!triangles)
        result.figures.push_back({"faults in following the hand" + (not_followed.empty() ? "" : ": " + not_followed),
                                  "", not_followed.empty() ? 0.0 : 1.0, 0.0, !found.outruns});
    addForces(found, all, result.figures);
    result.figures.push_back(
        {"processor time of a tick, p99.9", "us", ranked(result.us, 0.999), found.most_us, false, found.was.time});
    result.figures.push_back({"processor time of a tick, longest", "us", ranked(result.us, 1.0), kMostTick});
    return result;
}

std::string describe(const Found& found, const char* method, const FoundMeasured& measured) {
    std::string text = fmt::format("{} {}: {} ticks, {} poses judged, tick median {:.0f} us\n", found.name, method,
                                   measured.us.size(), measured.poses, ranked(measured.us, 0.5));
    for (const Figure& figure : measured.figures)
        text += fmt::format("  {:6} {:>9.4g} <= {:<6.4g} {:4}{}{}{}\n",
                            !std::isfinite(figure.mark) ? "told"
                            : figure.met()              ? "met"
                                                        : "MISSED",
                            figure.value, figure.mark, figure.unit, figure.name, figure.was.empty() ? "" : "; was ",
                            figure.was);
    return text;
}

}  // namespace passung::hard
