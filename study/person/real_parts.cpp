#include "study/person/real_parts.h"

#include <algorithm>

#include "study/person/completion_time.h"

namespace passung::person {

RealTrial realTrial(const SimulatedPerson& person, std::int64_t trials_before, Random& random) {
    RealTrial trial;
    trial.time = 0.5 * completionTime(person, trials_before, random);
    trial.time += std::max(0.25 + 0.05 * random.normal(), 0.1);
    trial.success = random.uniform() >= 0.2 * person.lapse_rate;
    return trial;
}

}  // namespace passung::person
