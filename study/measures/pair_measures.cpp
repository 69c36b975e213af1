#include "study/measures/pair_watch.h"
#include "study/measures/period_clock.h"
#include "study/measures/type_measures.h"

namespace passung::measures {
namespace {

/// The pair up to its end tick; nothing for other trials and without an answer.
std::optional<PairWatch> answered(const Trial& trial) {
    if (!std::holds_alternative<PairFacts>(trial.context.form)) return std::nullopt;
    PairWatch watch;
    PeriodClock clock(trial.context.start_tick);
    for (const TickRecord& record : trial.points) watch.follow(record, clock.at(record));
    if (watch.phase() != PairWatch::Phase::Answered) return std::nullopt;
    return watch;
}

Optional comparisonInterval(const Trial& trial) {
    const auto* pair = std::get_if<PairFacts>(&trial.context.form);
    return pair != nullptr ? Optional(pair->comparison_interval) : std::nullopt;
}

Optional answer(const Trial& trial) {
    const auto watch = answered(trial);
    return watch ? Optional(watch->answer()) : std::nullopt;
}

Optional correct(const Trial& trial) {
    const auto watch = answered(trial);
    if (!watch) return std::nullopt;
    return watch->answer() == std::get<PairFacts>(trial.context.form).comparison_interval ? 1.0 : 0.0;
}

Optional responseTime(const Trial& trial) {
    const auto watch = answered(trial);
    return watch ? Optional(seconds(0, watch->responsePeriods())) : std::nullopt;
}

}  // namespace

std::vector<Measure> pairMeasures() {
    return {
        {{"comparison_interval", "Interval with the comparison", "1",
          "1 or 2: the interval that was rendered with the keys of task.comparison, drawn from the attempt's seed"},
         comparisonInterval},
        {{"answer", "Interval that was named", "1",
          "1 or 2: which of the device's first two buttons went down first after the second interval, alone; empty "
          "without an answer; an interval lasts from a tick with status bit 16 to the next one without"},
         answer},
        {{"correct", "The comparison was named", "1",
          "1 if answer = comparison_interval, else 0; empty without an "
          "answer"},
         correct},
        {{"response_time_s", "Response time", "s",
          "from the first tick after the second interval to the answer's tick, as for the answer; time: as for the "
          "trial time"},
         responseTime},
    };
}

}  // namespace passung::measures
