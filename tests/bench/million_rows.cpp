#include "tests/bench/million_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/bench/ours.h"

namespace passung::bench {

namespace {

constexpr double kMillionTolerance = 50e-6;
constexpr double kMillionSpacing = 0.073e-3;  // gives a million points
constexpr double kQuickSpacing = 1e-3;        // to see that it works
constexpr double kShare = 0.01;
constexpr double kMostShift = 3e-3;
constexpr int kBisections = 24;
constexpr std::size_t kMostPoses = 100;

/// `pose` moved along its force until a share of kShare of the points is in contact.
TruePose withShare(Method& method, TruePose pose, double points) {
    const Vec3 out = pose.one_way.force.normalized();
    const Vec3 p = pose.X_FS.p;
    double in = -kMostShift, away = kMostShift;
    for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (in + away);
        pose.X_FS.p = p + middle * out;
        (method.at(pose.X_FS).contacts > kShare * points ? in : away) = middle;
    }
    // What was true at the old place is not true here.
    pose.shell_in_field = pose.field_in_shell = kNotGiven;
    pose.one_way = pose.two_way = {};
    return pose;
}

}  // namespace

Result<std::vector<Row>> millionRows(const ContactScene& scene, const Extent& extent) {
    std::vector<Row> rows;
    if (!extent.wanted(kMillionGroup, kOnePercent) && !extent.wanted(kMillionGroup, "passung query")) return rows;
    PartStore bunny(scene.bunny), tool(scene.tool);
    const double spacing = extent.few_settings ? kQuickSpacing : kMillionSpacing;
    const auto field = bunny.get(kMillionTolerance, 0.0);
    const auto shell = tool.get(0.0, spacing);
    if (!field) return field.errors();
    if (!shell) return shell.errors();
    const auto points = static_cast<double>((*shell)->part.shell->points().size());
    std::vector<TruePose> pressed(
        scene.pressed.begin(),
        scene.pressed.begin() + static_cast<std::ptrdiff_t>(std::min(kMostPoses, scene.pressed.size())));
    const double lever = 1.0;  // torque errors are not judged here
    if (extent.wanted(kMillionGroup, kOnePercent)) {
        Candidate tick = ourTick(**field, **shell, kMillionTolerance, spacing);
        tick.name = kOnePercent;
        std::vector<TruePose> poses;
        for (const TruePose& pose : pressed) poses.push_back(withShare(*tick.method, pose, points));
        rows.push_back(measure(tick, kMillionGroup, poses, lever, extent.repetitions));
        rows.back().distance_error_um = {};
    }
    if (extent.wanted(kMillionGroup, "passung query")) {
        for (const int budget : {0, 3000, 1000, 300, 100}) {
            Candidate query = ourQuery(**field, **shell, kMillionTolerance, spacing,
                                       {.area_stiffness = kAreaStiffness, .max_nodes = budget});
            if (budget > 0) query.settings += fmt::format(", budget {} nodes", budget);
            rows.push_back(measure(query, kMillionGroup, pressed, lever, extent.repetitions));
            rows.back().torque_error_percent = {};
        }
    }
    return rows;
}

}  // namespace passung::bench
