#include <algorithm>
#include <cmath>

#include "study/measures/contour_watch.h"
#include "study/measures/type_measures.h"

namespace passung::measures {
namespace {

/// Sums over the ticks at which the line was followed.
struct Following {
    double progress = 0.0;
    double ticks = 0.0;
    double square = 0.0, largest = 0.0;  // of the deviation [m²], [m]
    double force = 0.0, force_square = 0.0;
};

std::optional<Following> followingOf(const Trial& trial) {
    const auto* facts = std::get_if<ContourFacts>(&trial.context.form);
    if (facts == nullptr || trial.ticks.empty()) return std::nullopt;
    Following sums;
    ContourWatch watch(*facts, trial.context.X_WT);
    for (const TickRecord& record : trial.points) {
        watch.follow(record);
        if (&record == &trial.points.back() && trial.points.size() > trial.ticks.size()) break;
        if (!watch.following()) continue;
        const auto& f = record.force_N;
        const double force = Vec3(f[0], f[1], f[2]).norm();
        sums.ticks += 1.0;
        sums.square += watch.deviation() * watch.deviation();
        sums.largest = std::max(sums.largest, watch.deviation());
        sums.force += force;
        sums.force_square += (force - facts->force) * (force - facts->force);
    }
    sums.progress = watch.progress();
    return sums;
}

template <class Value>
Optional ofFollowed(const Trial& trial, Value value) {
    const auto sums = followingOf(trial);
    return sums && sums->ticks > 0.0 ? Optional(value(*sums)) : std::nullopt;
}

Optional progress(const Trial& trial) {
    const auto sums = followingOf(trial);
    return sums ? Optional(sums->progress) : std::nullopt;
}

Optional deviation(const Trial& trial) {
    return ofFollowed(trial, [](const Following& sums) { return std::sqrt(sums.square / sums.ticks); });
}

Optional maxDeviation(const Trial& trial) {
    return ofFollowed(trial, [](const Following& sums) { return sums.largest; });
}

Optional meanForce(const Trial& trial) {
    return ofFollowed(trial, [](const Following& sums) { return sums.force / sums.ticks; });
}

Optional forceError(const Trial& trial) {
    return ofFollowed(trial, [](const Following& sums) { return std::sqrt(sums.force_square / sums.ticks); });
}

}  // namespace

std::vector<Measure> contourMeasures() {
    return {
        {{"contour_progress", "Followed share of the line", "1",
          "place on the line at the last record up to the end tick / the line's length; place: the point of the line "
          "nearest to the proxy's origin among those from the place so far up to task.reach_mm ahead along the line, "
          "if it is not farther away than task.reach_mm, else the place so far; at first the line's first point"},
         progress},
        {{"contour_deviation_m", "Deviation from the line", "m",
          "root mean square distance of the proxy's origin from its place on the line, over the trial ticks at which "
          "it is not more than task.reach_mm (followed ticks); empty without such; place: as for the progress"},
         deviation},
        {{"contour_max_deviation_m", "Largest deviation from the line", "m",
          "largest such distance over the followed ticks"},
         maxDeviation},
        {{"contour_force_N", "Force while following", "N", "mean of |force| over the followed ticks"}, meanForce},
        {{"contour_force_error_N", "Deviation from the asked force", "N",
          "root mean square of |force| - task.force_N over the followed ticks"},
         forceError},
    };
}

}  // namespace passung::measures
