#include "analysis/truth/accuracy_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <numeric>
#include <optional>

#include "core/query/part_query.h"
#include "core/scene/timed_store.h"
#include "core/tick/tick_query.h"

namespace passung::truth {

namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Time of the calling thread on its core [s]: what other programs do on the machine does not count.
double threadSeconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Built {
    SharedPart part;
    double seconds = 0.0;  // that building the field or the points took
};

Result<Built> build(const scene::PartSpec& spec, const scene::PartNeeds& needs, scene::BuildStore* store) {
    scene::TimedStore timed(store);
    auto part = scene::buildPart(spec, needs, &timed);
    if (!part) return part.errors();
    return Built{std::make_shared<const scene::Part>(std::move(*part)), timed.seconds()};
}

/// A scene of FIELD at the origin and SHELL in the hand. Its contact is that of fields, whose settings are measured.
scene::Scene sceneOf(const scene::ContactSpec& contact, const SharedPart& field, const SharedPart& shell) {
    scene::Scene scene;
    scene.spec.contact = contact;
    scene.spec.contact.geometry = scene::Geometry::Field;
    scene.spec.parts.resize(2);
    scene.spec.parts[1].held = true;
    scene.parts = {field, shell};
    scene.held = 1;
    return scene;
}

/// Errors of all poses so far.
struct ErrorLists {
    std::vector<double> depth, force, direction, torque;

    void add(const tick::QueryReading& answer, const PoseTruth& truth, double lever, double least_force) {
        if (truth.inContact() || answer.depth > 0.0)
            depth.push_back(std::abs(answer.depth - std::max(0.0, -truth.distance)));
        const double size = truth.wrench.force.norm();
        if (!(size > 0.0 && size >= least_force)) return;
        force.push_back(std::abs(answer.wrench.force.norm() - size) / size);
        torque.push_back((answer.wrench.torque - truth.wrench.torque).norm() / (size * lever));
        if (answer.wrench.force.norm() > 0.0)
            direction.push_back(std::atan2(answer.wrench.force.cross(truth.wrench.force).norm(),
                                           answer.wrench.force.dot(truth.wrench.force)));
    }

    void summarise(SettingCost& row) const {
        row.depth = spreadOf(depth);
        row.force = spreadOf(force);
        row.direction = spreadOf(direction);
        row.torque = spreadOf(torque);
    }
};

/// What `ask` takes at each pose: the fastest of `repetitions` after one round that does not count.
template <class Ask>
Spread timesOf(const std::vector<Pose>& poses, int repetitions, const Ask& ask) {
    std::vector<double> times(poses.size(), kUnlimited);
    for (int round = 0; round <= repetitions; ++round) {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const double begin = threadSeconds();
            ask(poses[i]);
            if (round > 0) times[i] = std::min(times[i], threadSeconds() - begin);
        }
    }
    return spreadOf(std::move(times));
}

/// Why `r` cannot be, given the truth; nothing if it can.
std::optional<std::string> contradiction(const query::PartQueryResult& r, const PoseTruth& truth) {
    const auto said = [&](const char* what) {
        return fmt::format(
            "{}: distance {:.6g} mm, stated bound {:.4g} mm, interval [{:.6g}, {:.6g}] mm; FCL: {}, "
            "separation {:.6g} mm; true distance {:.6g} mm, uncertain by {:.2g} mm",
            what, 1e3 * r.signed_distance, 1e3 * r.error_bound, 1e3 * r.lower_bound, 1e3 * r.upper_bound,
            toString(truth.relation), 1e3 * truth.separation, 1e3 * truth.distance, 1e3 * truth.uncertainty);
    };
    if (truth.relation == Relation::SurfacesIntersect && r.lower_bound > truth.uncertainty)
        return said("said to be apart, but the surfaces intersect");
    // Wholly inside: no point of SHELL's surface is outside FIELD.
    if (truth.relation == Relation::BInsideA && r.lower_bound > truth.uncertainty)
        return said("said to be apart, but SHELL is inside FIELD");
    if (std::isnan(truth.distance)) return std::nullopt;
    if (!(std::abs(r.signed_distance - truth.distance) <= r.error_bound + truth.uncertainty))
        return said("the error is larger than the bound stated for it");
    if (!(r.lower_bound <= truth.distance + truth.uncertainty && r.upper_bound >= truth.distance - truth.uncertainty))
        return said("the truth is outside the interval");
    return std::nullopt;
}

void compare(const AccuracySetting& setting, query::PartQuery& query, const std::vector<JudgedPose>& poses,
             AccuracyResult& result, double& bound_max) {
    for (const JudgedPose& pose : poses) {
        const query::PartQueryResult answer = query.at(pose.X_FS);
        bound_max = std::max(bound_max, answer.error_bound);
        ++result.compared;
        if (answer.lower_bound <= 0.0 && answer.upper_bound >= 0.0) ++result.undecided;
        if (const auto what = contradiction(answer, pose.truth))
            result.disagreements.push_back({setting, pose.X_FS, *what});
    }
}

/// Marks who is faster than all that are as good, by an error `of` a row.
template <class ErrorOf, class Flag>
void markFront(std::vector<SettingCost>& rows, const ErrorOf& of, Flag flag) {
    std::vector<SettingCost*> order;
    for (SettingCost& row : rows)
        if (std::isfinite(of(row))) order.push_back(&row);
    std::stable_sort(order.begin(), order.end(), [&](const SettingCost* a, const SettingCost* b) {
        return std::pair(a->time.p99, of(*a)) < std::pair(b->time.p99, of(*b));
    });
    double best = kUnlimited;
    for (SettingCost* row : order) {
        row->*flag = of(*row) < best;
        best = std::min(best, of(*row));
    }
}

}  // namespace

std::vector<double> defaultSpacings(double length) {
    const double wanted = length / 50.0;
    const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
    double rounded = decade;
    for (const double step : {1.0, 2.0, 5.0, 10.0})
        if (std::abs(std::log(step * decade / wanted)) < std::abs(std::log(rounded / wanted))) rounded = step * decade;
    return {4.0 * rounded, 2.0 * rounded, rounded, 0.5 * rounded};
}

Spread spreadOf(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    const auto rank = static_cast<std::size_t>(std::ceil(0.99 * static_cast<double>(n)));
    return {.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n),
            .median = 0.5 * (values[(n - 1) / 2] + values[n / 2]),
            .p99 = values[rank - 1],
            .max = values.back()};
}

void markFronts(std::vector<SettingCost>& rows) {
    markFront(
        rows, [](const SettingCost& row) { return row.depth.p99; }, &SettingCost::on_depth_front);
    markFront(
        rows, [](const SettingCost& row) { return row.force.p99; }, &SettingCost::on_force_front);
}

SettingCost measureSetting(const AccuracySetting& setting, scene::ContactSpec contact, const SharedPart& field,
                           const SharedPart& shell, const std::vector<JudgedPose>& poses,
                           const std::vector<Pose>& timed, int repetitions, double lever) {
    contact.mode = setting.mode;
    contact.budget_nodes = setting.budget_nodes;
    const shell::SphereTree& points = *shell->shell;
    SettingCost row{.setting = setting};
    row.points = points.points().size();
    row.field_bytes = static_cast<double>(scene::fieldBytes(*field));
    row.shell_bytes = static_cast<double>(points.nodes().size_bytes() + points.points().size_bytes());
    tick::TickQuery query(sceneOf(contact, field, shell), kAreaStiffness);
    double largest_force = 0.0;
    for (const JudgedPose& pose : poses) largest_force = std::max(largest_force, pose.truth.wrench.force.norm());
    ErrorLists errors;
    std::vector<Pose> apart;
    std::vector<double> distance;
    for (const JudgedPose& pose : poses) {
        errors.add(query.at(pose.X_FS), pose.truth, lever, kLeastForce * largest_force);
        if (pose.truth.inContact()) continue;
        apart.push_back(pose.X_FS);
        distance.push_back(std::abs(query.distanceAt(pose.X_FS) - pose.truth.distance));
    }
    errors.summarise(row);
    row.distance = spreadOf(std::move(distance));
    row.distance_time = timesOf(apart, repetitions, [&](const Pose& X_FS) { query.distanceAt(X_FS); });
    row.time = timesOf(timed, repetitions, [&](const Pose& X_FS) { query.at(X_FS); });
    return row;
}

Result<AccuracyResult> sweepAccuracy(const scene::PartSpec& field, const scene::PartSpec& shell,
                                     const AccuracySpace& space, const std::vector<JudgedPose>& poses,
                                     const std::vector<JudgedPose>& shaken, double lever, const StepReport& report,
                                     scene::BuildStore* store) {
    AccuracyResult result;
    scene::ContactSpec contact;
    contact.method = scene::ContactMethod::Penalty;
    contact.variant = scene::PenaltyVariant::AreaWeighted;
    std::vector<Pose> timed;
    for (const JudgedPose& pose : poses) timed.push_back(pose.X_FS);
    const double steps = static_cast<double>(space.tolerances.size() * (1 + space.spacings.size()));
    double done = 0.0;
    for (const double tolerance : space.tolerances) {
        report(fmt::format("field to {:g} um", 1e6 * tolerance), done / steps);
        auto field_part = build(field, {.field = true, .tolerance = tolerance}, store);
        if (!field_part) return field_part.errors();
        done += 1.0;
        for (const double spacing : space.spacings) {
            report(fmt::format("field to {:g} um, points {:g} mm apart", 1e6 * tolerance, 1e3 * spacing), done / steps);
            auto shell_part = build(shell, {.shell = true, .tolerance = tolerance, .spacing = spacing}, store);
            if (!shell_part) return shell_part.errors();
            for (const field::FieldMode mode : space.modes) {
                for (const int budget : space.budgets) {
                    SettingCost row = measureSetting({mode, tolerance, spacing, budget}, contact, field_part->part,
                                                     shell_part->part, poses, timed, space.repetitions, lever);
                    row.field_build = field_part->seconds;
                    row.shell_build = shell_part->seconds;
                    query::PartQuery query(*field_part->part, *shell_part->part,
                                           {.area_stiffness = kAreaStiffness, .max_nodes = budget, .mode = mode});
                    compare(row.setting, query, poses, result, row.bound_max);
                    result.rows.push_back(row);
                }
            }
            // FCL alone, at many more poses: the bounds hold whatever the mode or the budget.
            double ignored = 0.0;
            query::PartQuery query(*field_part->part, *shell_part->part, {.area_stiffness = kAreaStiffness});
            compare({.tolerance = tolerance, .spacing = spacing}, query, shaken, result, ignored);
            done += 1.0;
        }
    }
    report("", 1.0);
    markFronts(result.rows);
    return result;
}

}  // namespace passung::truth
