#include "study/person/simulated_person.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/base/random.h"

using namespace passung;
using namespace passung::person;

namespace {

std::vector<double> traits(const SimulatedPerson& p) {
    return {p.visual_delay,
            p.haptic_delay,
            p.arm_mass,
            p.arm_stiffness,
            p.arm_damping_ratio,
            p.wrist_inertia,
            p.wrist_stiffness,
            p.wrist_damping_ratio,
            p.tremor,
            p.lateral_error,
            p.depth_error,
            p.tilt_error,
            p.pace,
            p.press_force};
}

}  // namespace

TEST(SimulatedPerson, SameSeedIsTheSamePerson) {
    // Truth: invariant, bit for bit.
    for (std::uint64_t seed = 0; seed < 50; ++seed) EXPECT_EQ(traits(drawPerson(seed)), traits(drawPerson(seed)));
}

TEST(SimulatedPerson, DifferentParticipantsDiffer) {
    // Truth: invariant; codes lead to seeds by streamSeed.
    std::set<double> paces;
    for (const char* code : {"S01", "S02", "S03", "S04", "S05", "S06", "S07", "S08"})
        paces.insert(drawPerson(streamSeed("peg_in_hole", code, "", "person", 1)).pace);
    EXPECT_EQ(paces.size(), 8u);
}

TEST(SimulatedPerson, EveryTraitStaysInItsDocumentedRange) {
    // Truth: invariant, the ranges of the header.
    const std::vector<double> low = {0.15, 0.09, 0.3, 200, 0.4, 0.8e-3, 2, 0.4, 1.5e-5, 0.5e-3, 0.25e-3, 0.008, 0.7, 2};
    const std::vector<double> high = {0.32, 0.20, 1.0, 500, 1.0, 3e-3, 4, 1.0, 6e-5, 1.5e-3, 0.8e-3, 0.018, 1.4, 4};
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        const std::vector<double> t = traits(drawPerson(seed));
        for (std::size_t i = 0; i < t.size(); ++i) {
            ASSERT_GE(t[i], low[i]) << "trait " << i << " seed " << seed;
            ASSERT_LE(t[i], high[i]) << "trait " << i << " seed " << seed;
        }
    }
}

TEST(SimulatedPerson, MediansAreTheDocumentedOnes) {
    // Truth: closed form, the median of a log-normal is unmoved by clamping on both sides. The median of 2000 draws has
    // a standard error of 1.25 spread / sqrt(2000) = 0.8 % for the widest spread of 0.3; 4 of them are allowed.
    const std::vector<double> median = traits(SimulatedPerson{});
    std::vector<std::vector<double>> draws(median.size());
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        const std::vector<double> t = traits(drawPerson(seed));
        for (std::size_t i = 0; i < t.size(); ++i) draws[i].push_back(t[i]);
    }
    for (std::size_t i = 0; i < median.size(); ++i) {
        std::ranges::sort(draws[i]);
        EXPECT_NEAR(draws[i][1000], median[i], 0.034 * median[i]) << "trait " << i;
        EXPECT_LT(draws[i][100], 0.97 * median[i]) << "trait " << i << " does not vary";
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
