#include "study/person/detection_response.h"

#include <cmath>

namespace passung::person {
namespace {

constexpr double kSpread = 0.2;         // of the natural logarithm of a response time
constexpr double kMistakes = 0.03;      // share of stimuli
constexpr double kMistakeAfter = 2.6;   // [s]
constexpr double kMissesUnderLoad = 2;  // how many times more, beside the usual ones

}  // namespace

DetectionResponse respond(const SimulatedPerson& person, double load, Random& random) noexcept {
    // Every draw is made whatever comes of it, so that one stimulus does not shift the next one's.
    const bool missed = random.uniform() < person.miss_rate * (1.0 + kMissesUnderLoad * load);
    const double time =
        person.reaction_time * (1.0 + person.reaction_load * load) * std::exp(kSpread * random.normal());
    const bool mistaken = random.uniform() < kMistakes;
    DetectionResponse response;
    if (!missed) response.press = time;
    if (mistaken) response.mistake = kMistakeAfter;
    return response;
}

}  // namespace passung::person
