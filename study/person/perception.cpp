#include "study/person/perception.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace passung::person {

double Perception::chance(double x, double guess) const {
    return guess + (1.0 - guess - lapse) * 0.5 * std::erfc((threshold - x) / (sigma * std::sqrt(2.0)));
}

Perception perceptionOf(std::string_view study, std::string_view code, std::uint64_t study_seed,
                        std::string_view staircase, double low, double high) {
    Random random(streamSeed(study, code, "perception", "simulated|" + std::string(staircase), study_seed));
    const double width = high - low;
    Perception perception;
    perception.threshold = low + width * std::clamp(0.5 + 0.1 * random.normal(), 0.2, 0.8);
    perception.sigma = 0.08 * width * std::exp(0.25 * random.normal());
    perception.lapse = std::min(0.02 * std::exp(0.5 * random.normal()), 0.06);
    return perception;
}

bool perceives(const Perception& perception, double x, double guess, Random& random) {
    return random.uniform() < perception.chance(x, guess);
}

}  // namespace passung::person
