#include <algorithm>

#include "study/measures/passage_watch.h"
#include "study/measures/period_clock.h"
#include "study/measures/tick_facts.h"
#include "study/measures/type_measures.h"

namespace passung::measures {
namespace {

/// What happened since the passage was last entered.
struct Passing {
    bool through = false;
    std::int64_t entries = 0;
    std::int64_t entered = 0, left = 0;  // times
    double path = 0.0;                   // [m]
    double contact_periods = 0.0;
    double peak_force = 0.0;  // [N]
};

std::optional<Passing> passingOf(const Trial& trial) {
    const auto* facts = std::get_if<PassageFacts>(&trial.context.form);
    if (facts == nullptr || trial.ticks.empty()) return std::nullopt;
    Passing passing;
    PassageWatch watch(*facts, trial.context.X_WT);
    PeriodClock clock(trial.context.start_tick);
    for (std::size_t i = 0; i < trial.points.size() && !watch.through(); ++i) {
        const TickRecord& record = trial.points[i];
        const std::int64_t time = clock.at(record);
        const bool was_inside = watch.inside();
        watch.follow(record);
        if (watch.entries() > passing.entries) passing = {.entries = watch.entries(), .entered = time};
        if (was_inside && watch.entries() > 0)
            passing.path += (proxyPosition(record) - proxyPosition(trial.points[i - 1])).norm();
        if (watch.through()) passing.left = time;
        if (!watch.inside() || i >= trial.ticks.size()) continue;
        if (isContact(record)) passing.contact_periods += trial.lengthOf(i);
        const auto& f = record.force_N;
        passing.peak_force = std::max(passing.peak_force, Vec3(f[0], f[1], f[2]).norm());
    }
    passing.through = watch.through();
    return passing;
}

template <class Value>
Optional ofEntered(const Trial& trial, Value value) {
    const auto passing = passingOf(trial);
    return passing && passing->entries > 0 ? Optional(value(*passing)) : std::nullopt;
}

Optional passageTime(const Trial& trial) {
    const auto passing = passingOf(trial);
    return passing && passing->through ? Optional(seconds(passing->entered, passing->left)) : std::nullopt;
}

Optional passagePath(const Trial& trial) {
    return ofEntered(trial, [](const Passing& passing) { return passing.path; });
}

Optional passageContactTime(const Trial& trial) {
    return ofEntered(trial, [](const Passing& passing) { return passing.contact_periods / kPeriodsPerSecond; });
}

Optional passagePeakForce(const Trial& trial) {
    return ofEntered(trial, [](const Passing& passing) { return passing.peak_force; });
}

Optional passageEntries(const Trial& trial) {
    const auto passing = passingOf(trial);
    return passing ? Optional(static_cast<double>(passing->entries)) : std::nullopt;
}

}  // namespace

std::vector<Measure> passageMeasures() {
    return {
        {{"passage_time_s", "Time in the passage", "s",
          "from the last entry to the tick at which the proxy's origin is through; empty without; entry: the proxy's "
          "origin crosses z = 0 of the target's frame from above, or from less than 0.2 mm below, within half the "
          "passage's width of the z axis; "
          "through: it gets from the passage below z = -length; time: as for the trial time"},
         passageTime},
        {{"passage_path_m", "Path in the passage", "m",
          "sum of the steps of the proxy's origin since the last entry, as for the passage time; empty without entry"},
         passagePath},
        {{"passage_contact_time_s", "Contact time in the passage", "s",
          "as the contact time, over the trial ticks in the passage since the last entry; empty without entry"},
         passageContactTime},
        {{"passage_peak_force_N", "Peak force in the passage", "N",
          "largest |force| over the trial ticks in the passage since the last entry; empty without entry"},
         passagePeakForce},
        {{"passage_entries", "Entries into the passage", "1", "number of entries, as for the passage time"},
         passageEntries},
    };
}

}  // namespace passung::measures
