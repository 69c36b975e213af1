#include "study/person/simulated_person.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

using namespace passung;
using namespace passung::person;

namespace {

std::vector<double> values(const SimulatedPerson& person) {
    std::vector<double> all;
    for (const Trait& trait : traits()) all.push_back(person.*trait.value);
    return all;
}

TEST(SimulatedPerson, SameSeedIsTheSamePerson) {
    // Truth: invariant, bit for bit.
    for (std::uint64_t seed = 0; seed < 50; ++seed) EXPECT_EQ(values(drawPerson(seed)), values(drawPerson(seed)));
}

TEST(SimulatedPerson, DifferentParticipantsStudiesAndSeedsDiffer) {
    // Truth: invariant; codes lead to seeds by streamSeed.
    std::set<double> paces;
    for (const char* code : {"S001", "S002", "S003", "S004", "S005", "S006", "S007", "S008"})
        paces.insert(personOf("peg_in_hole", code, 1).pace);
    paces.insert(personOf("peg_in_hole", "S001", 2).pace);
    paces.insert(personOf("another", "S001", 1).pace);
    EXPECT_EQ(paces.size(), 10u);
}

TEST(SimulatedPerson, TheTableHasEveryTraitOnceWithUnitMeaningAndRange) {
    // Truth: invariant; the struct is nothing but its traits.
    EXPECT_EQ(traits().size() * sizeof(double), sizeof(SimulatedPerson));
    std::set<std::string_view> names;
    std::set<const double*> places;
    const SimulatedPerson median;
    for (const Trait& trait : traits()) {
        names.insert(trait.name);
        places.insert(&(median.*trait.value));
        EXPECT_STRNE(trait.unit, "");
        EXPECT_STRNE(trait.meaning, "");
        EXPECT_LT(trait.low, median.*trait.value) << trait.name;
        EXPECT_GT(trait.high, median.*trait.value) << trait.name;
    }
    EXPECT_EQ(names.size(), traits().size());
    EXPECT_EQ(places.size(), traits().size());
}

TEST(SimulatedPerson, EveryTraitStaysInItsRangeAndVaries) {
    // Truth: closed form, the median of a log-normal is unmoved by a range on both sides. The median of 2000 draws has
    // a standard error of 1.2533 spread / sqrt(2000); 4 of them are allowed.
    constexpr std::size_t kDraws = 2000;
    std::vector<std::vector<double>> draws(traits().size());
    for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
        const SimulatedPerson person = drawPerson(seed);
        for (std::size_t i = 0; i < traits().size(); ++i) draws[i].push_back(person.*traits()[i].value);
    }
    for (std::size_t i = 0; i < traits().size(); ++i) {
        const Trait& trait = traits()[i];
        const double median = SimulatedPerson{}.*trait.value;
        std::ranges::sort(draws[i]);
        EXPECT_GE(draws[i].front(), trait.low) << trait.name;
        EXPECT_LE(draws[i].back(), trait.high) << trait.name;
        EXPECT_NEAR(draws[i][kDraws / 2], median, 4 * 1.2533 * trait.spread / std::sqrt(kDraws) * median) << trait.name;
        EXPECT_LT(draws[i][kDraws / 20], 0.97 * median) << trait.name << " does not vary";
    }
}

TEST(SimulatedPerson, DampingFollowsFromTheRatio) {
    // Truth: closed form, a damping ratio of 1 is critical: b = 2 sqrt(k m).
    SimulatedPerson p;
    p.arm_damping_ratio = 1.0;
    p.arm_stiffness = 400.0;
    p.arm_mass = 1.0;
    EXPECT_DOUBLE_EQ(p.armDamping(), 40.0);
    p.wrist_damping_ratio = 0.5;
    p.wrist_stiffness = 4.0;
    p.wrist_inertia = 1e-3;
    EXPECT_NEAR(p.wristDamping(), std::sqrt(4e-3), 1e-15);
}

TEST(SimulatedPerson, PracticeMakesFasterByAnExponentialLaw) {
    // Truth: closed form.
    SimulatedPerson p;
    p.pace = 1.2;
    p.learning = 0.5;
    p.learning_trials = 4.0;
    EXPECT_DOUBLE_EQ(p.paceAfter(0), 1.2 / 1.5);
    EXPECT_DOUBLE_EQ(p.paceAfter(4), 1.2 / (1.0 + 0.5 / std::exp(1.0)));
    EXPECT_NEAR(p.paceAfter(200), 1.2, 1e-12);
}

}  // namespace
