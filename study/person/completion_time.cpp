#include "study/person/completion_time.h"

#include <algorithm>
#include <cmath>

namespace passung::person {

double completionTime(const SimulatedPerson& person, std::int64_t trials_before, Random& random) {
    const double reach = std::max(2.6 + 0.25 * random.normal(), 1.0);
    const double search = -0.6 * std::log1p(-random.uniform());
    const bool lapses = random.uniform() < person.lapse_rate;
    return (reach + search) / person.paceAfter(trials_before) + (lapses ? person.lapse_duration : 0.0);
}

}  // namespace passung::person
