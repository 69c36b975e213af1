#include "tests/bench/contact_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/bench/ours.h"
#include "tests/bench/stopwatch.h"

namespace passung::bench {

namespace {

constexpr double kPercent = 100.0, kDeg = 180.0 / std::numbers::pi;

/// Tolerance of the field and spacing of the shell [m], coarse to fine.
struct Setting {
    double tolerance, spacing;
};

std::vector<Setting> oneWaySettings(bool few) {
    if (few) return {{50e-6, 1e-3}};
    std::vector<Setting> all;
    for (const double tolerance : {100e-6, 50e-6, 20e-6, 10e-6})
        for (const double spacing : {2e-3, 1e-3, 0.5e-3, 0.25e-3}) all.push_back({tolerance, spacing});
    all.push_back({16e-6, 0.6e-3});
    all.push_back({16e-6, 0.5e-3});
    return all;
}

std::vector<Setting> twoWaySettings(bool few) {
    if (few) return {{50e-6, 2e-3}};
    return {{50e-6, 2e-3}, {20e-6, 1e-3}};
}

/// Errors of one method over all poses.
struct Errors3 {
    std::vector<double> distance, force, turn, torque;

    void add(const Answer& answer, double true_distance, const Wrench& truth, double lever) {
        if (!std::isnan(answer.signed_distance))
            distance.push_back(kUm * std::abs(answer.signed_distance - true_distance));
        const double size = truth.force.norm();
        if (std::isnan(answer.wrench.force.x()) || !(size > 0.0)) return;
        force.push_back(kPercent * std::abs(answer.wrench.force.norm() - size) / size);
        const double sine = answer.wrench.force.cross(truth.force).norm();
        turn.push_back(kDeg * std::atan2(sine, answer.wrench.force.dot(truth.force)));
        torque.push_back(kPercent * (answer.wrench.torque - truth.torque).norm() / (size * lever));
    }
};

Times summariseIfAny(std::vector<double> values) { return values.empty() ? Times{} : summarise(std::move(values)); }

double leverOf(const geometry::TriangleMesh& tool) {
    double lever = 0.0;
    for (const Vec3& v : tool.vertices) lever = std::max(lever, v.norm());
    return lever;
}

}  // namespace

Row measure(const Candidate& candidate, const char* group, const std::vector<TruePose>& poses, double lever,
            int repetitions) {
    Row row{.group = group, .method = candidate.name, .settings = candidate.settings, .ours = candidate.ours};
    row.samples = poses.size();
    row.build_s = candidate.build_s;
    row.memory_MB = 1e-6 * candidate.memory_bytes;
    std::vector<double> times(poses.size(), std::numeric_limits<double>::infinity());
    std::vector<Answer> answers(poses.size());
    for (int repetition = 0; repetition <= repetitions; ++repetition) {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const Stopwatch watch;
            answers[i] = candidate.method->at(poses[i].X_FS);
            if (repetition > 0) times[i] = std::min(times[i], kUm * watch.seconds());
        }
    }
    row.time_us = summarise(times);
    Errors3 errors;
    double contacts = 0.0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const TruePose& pose = poses[i];
        const Answer& answer = answers[i];
        const double truth =
            candidate.two_way ? std::min(pose.shell_in_field, pose.field_in_shell) : pose.shell_in_field;
        errors.add(answer, truth, candidate.two_way ? pose.two_way : pose.one_way, lever);
        contacts += answer.contacts;
        if (std::isnan(answer.error_bound)) continue;
        row.bound_max_um = std::fmax(row.bound_max_um, kUm * answer.error_bound);
        const bool broken = !(std::abs(answer.signed_distance - truth) <= answer.error_bound + pose.uncertainty);
        row.bound_broken = (std::isnan(row.bound_broken) ? 0.0 : row.bound_broken) + (broken ? 1.0 : 0.0);
    }
    row.contacts_mean = contacts / static_cast<double>(poses.size());
    row.distance_error_um = summariseIfAny(errors.distance);
    row.force_error_percent = summariseIfAny(errors.force);
    row.force_turn_deg = summariseIfAny(errors.turn);
    row.torque_error_percent = summariseIfAny(errors.torque);
    return row;
}

Result<std::vector<Row>> contactRows(const ContactScene& scene, const Extent& extent) {
    std::vector<Row> rows;
    const double lever = leverOf(scene.tool);
    const auto add = [&](const Candidate& candidate, const char* group, const std::vector<TruePose>& poses) {
        rows.push_back(measure(candidate, group, poses, lever, extent.repetitions));
        std::fprintf(stderr, "  %s, %s: %s\n", group, candidate.name.c_str(), candidate.settings.c_str());
    };
    const auto wanted = [&](const char* group, const char* method) { return extent.wanted(group, method); };
    PartStore bunny(scene.bunny), tool(scene.tool);
    const auto ours = [&](const char* group, const std::vector<TruePose>& poses, bool ticks) -> Result<Done> {
        if (!wanted(group, "passung query") && !(ticks && wanted(group, "passung tick"))) return Done{};
        for (const bool two_way : {false, true}) {
            for (const auto& [tolerance, spacing] :
                 two_way ? twoWaySettings(extent.few_settings) : oneWaySettings(extent.few_settings)) {
                const auto field = bunny.get(tolerance, two_way ? spacing : 0.0);
                const auto shell = tool.get(two_way ? tolerance : 0.0, spacing);
                if (!field) return field.errors();
                if (!shell) return shell.errors();
                if (wanted(group, "passung query"))
                    add(ourQuery(**field, **shell, tolerance, spacing,
                                 {.area_stiffness = kAreaStiffness, .two_way = two_way}),
                        group, poses);
                if (ticks && !two_way && wanted(group, "passung tick"))
                    add(ourTick(**field, **shell, tolerance, spacing), group, poses);
            }
        }
        return Done{};
    };
    if (auto done = ours(kPressedGroup, scene.pressed, true); !done) return done.errors();
    if (wanted(kPressedGroup, "FCL all contacts"))
        add(fclAllContacts(scene.bunny, scene.tool), kPressedGroup, scene.pressed);
    if (wanted(kPressedGroup, "ODE trimesh")) add(odeTrimesh(scene.bunny, scene.tool), kPressedGroup, scene.pressed);
    if (wanted(kPressedGroup, "Bullet GImpact"))
        add(bulletGimpact(scene.bunny, scene.tool), kPressedGroup, scene.pressed);
    if (wanted(kPressedGroup, "OpenVDB all points")) {
        const auto shell = tool.get(0.0, 1e-3);
        if (!shell) return shell.errors();
        for (const double cell : {1e-3, 0.5e-3}) {
            Candidate candidate = openvdbPoints(scene.bunny, cell, (*shell)->part.shell->points());
            candidate.settings = fmt::format("cell {:g} mm, band 4 cells, our {} points", 1e3 * cell,
                                             (*shell)->part.shell->points().size());
            add(candidate, kPressedGroup, scene.pressed);
        }
    }
    if (auto done = ours(kApartGroup, scene.apart, false); !done) return done.errors();
    if (wanted(kApartGroup, "FCL distance")) add(fclDistance(scene.bunny, scene.tool), kApartGroup, scene.apart);
    return rows;
}

}  // namespace passung::bench
