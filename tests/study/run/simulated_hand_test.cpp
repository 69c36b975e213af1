#include "study/run/person/simulated_hand.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <string_view>

namespace passung::run {
namespace {

bool differ(const simulated::HandParams& a, const simulated::HandParams& b) { return std::memcmp(&a, &b, sizeof a); }

TEST(SimulatedHand, EveryTraitChangesItButThoseOfAnsweringASecondaryTask) {
    // Truth: invariant
    const std::set<std::string_view> answering{"reaction_time", "reaction_load", "miss_rate"};
    std::size_t found = 0;
    static_assert(sizeof(simulated::HandParams) % sizeof(double) == 0);
    const simulated::HandParams usual = simulatedHand({}, 3);
    for (const person::Trait& trait : person::traits()) {
        person::SimulatedPerson person;
        person.*trait.value = trait.high;
        const bool of_answers = answering.count(trait.name) > 0;
        EXPECT_NE(differ(simulatedHand(person, 3), usual), of_answers) << trait.name;
        found += of_answers ? 1u : 0u;
    }
    EXPECT_EQ(found, answering.size());
}

TEST(SimulatedHand, IsFitToUseWhoeverThePersonIs) {
    // Truth: invariant
    for (std::uint64_t seed = 0; seed < 500; ++seed)
        EXPECT_TRUE(simulatedHand(person::drawPerson(seed), 0).validate().empty()) << seed;
}

TEST(SimulatedHand, IsFasterAfterPractice) {
    // Truth: closed form, paceAfter()
    person::SimulatedPerson person;
    person.learning = 0.5;
    EXPECT_NEAR(simulatedHand(person, 1000).insert_speed / simulatedHand(person, 0).insert_speed, 1.5, 1e-12);
    EXPECT_NEAR(simulatedHand(person, 1000).approach_duration / simulatedHand(person, 0).approach_duration, 1 / 1.5,
                1e-12);
}

}  // namespace
}  // namespace passung::run
