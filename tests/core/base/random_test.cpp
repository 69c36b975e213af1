#include "core/base/random.h"

#include <gtest/gtest.h>

#include <numeric>

namespace passung {
namespace {

std::vector<int> countingUp(int n) {
    std::vector<int> items(static_cast<std::size_t>(n));
    std::iota(items.begin(), items.end(), 0);
    return items;
}

TEST(Random, SeedsAsPublishedForSplitmix64) {
    // Truth: published vector of splitmix64 for the seed 1234567.
    std::uint64_t state = 1234567;
    for (const std::uint64_t expected : {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                         4593380528125082431u, 16408922859458223821u})
        EXPECT_EQ(splitmix64(state), expected);
}

TEST(Random, DrawsTheSequenceOfXoshiro256StarStar) {
    // Truth: independent program (integer arithmetic in Python 3.11, written from the generator's publication).
    Random random(20240501);
    for (const std::uint64_t expected :
         {9072139047418651510u, 13574960570780548769u, 9854320771960880081u, 12365526487097569489u})
        EXPECT_EQ(random.next(), expected);
}

TEST(Random, ShufflesFromTheEnd) {
    // Truth: independent program (integer arithmetic in Python 3.11).
    Random one(1);
    auto eight = countingUp(8);
    shuffle(eight, one);
    EXPECT_EQ(eight, (std::vector<int>{7, 0, 1, 4, 3, 2, 6, 5}));
    Random other(20240501);
    auto ten = countingUp(10);
    shuffle(ten, other);
    EXPECT_EQ(ten, (std::vector<int>{7, 6, 8, 5, 9, 3, 4, 1, 2, 0}));
}

TEST(Random, NamesStreamsByFnv1a) {
    // Truth: published offset basis of FNV-1a (hash of nothing) and its vector for "a"; the stream's name by an
    // independent program (Python 3.11).
    EXPECT_EQ(fnv1a64(""), 0xcbf29ce484222325u);
    EXPECT_EQ(fnv1a64("a"), 0xaf63dc4c8601ec8cu);
    EXPECT_EQ(streamSeed("study", "P007", "main", "trial_order", 0), 0x63a7d2137ac24cbbu);
    EXPECT_EQ(streamSeed("study", "P007", "main", "trial_order", 0xff), 0x63a7d2137ac24c44u);
}

TEST(Random, KeepsTheSeparatorsOfEmptyNames) {
    // Truth: definition of a stream's name: four parts, three separators.
    EXPECT_EQ(streamSeed("demo", "", "", "relabel", 0), fnv1a64("demo|||relabel"));
}

TEST(Random, StaysBelowTheBoundForPowersOfTwoAndOthers) {
    // Truth: invariant; a bound of 1 and powers of two reject no draw (the rejection bound would be 2^64).
    Random random(3);
    for (const std::uint64_t n : {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{3}, std::uint64_t{10},
                                  std::uint64_t{1} << 63, (std::uint64_t{1} << 63) + 1})
        for (int i = 0; i < 100; ++i) EXPECT_LT(random.below(n), n);
    Random a(5), b(5);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(a.below(8), b.next() % 8);
}

TEST(Random, RejectsDrawsAboveTheLargestMultiple) {
    // Truth: definition. For n = 2^63 + 1 the largest multiple is n itself: draws at or above it are thrown away.
    const std::uint64_t n = (std::uint64_t{1} << 63) + 1;
    Random a(11), b(11);
    int rejected = 0;
    for (int i = 0; i < 50; ++i) {
        std::uint64_t x = b.next();
        for (; x >= n; x = b.next()) ++rejected;
        EXPECT_EQ(a.below(n), x);
    }
    EXPECT_GT(rejected, 10);
}

TEST(Random, DrawsUniformNumbersFromTheUpper53Bits) {
    // Truth: independent program (Python 3.11).
    Random random(20240501);
    EXPECT_EQ(random.uniform(), 0.4918016432150938);
    EXPECT_EQ(random.uniform(), 0.7359000871122666);
    EXPECT_EQ(random.uniform(), 0.5342037994664509);
}

TEST(Random, DrawsNormalNumbersByThePolarMethod) {
    // Truth: independent program (Python 3.11); log differs by an ulp between mathematical libraries.
    Random random(20240501);
    for (const double expected : {-0.06018243799518095, 1.7316936476623688, 0.4048220276521636, 2.0160327851828552})
        EXPECT_NEAR(random.normal(), expected, 1e-14);
}

TEST(Random, HasTheMomentsOfANormalDistribution) {
    // Truth: closed form: mean 0, variance 1, fourth moment 3; bounds of five standard errors with 200 000 draws.
    Random random(77);
    const int n = 200000;
    double sum = 0, squares = 0, fourth = 0;
    for (int i = 0; i < n; ++i) {
        const double x = random.normal();
        sum += x;
        squares += x * x;
        fourth += x * x * x * x;
    }
    EXPECT_NEAR(sum / n, 0.0, 5 * 0.00224);
    EXPECT_NEAR(squares / n, 1.0, 5 * 0.00316);
    EXPECT_NEAR(fourth / n, 3.0, 5 * 0.0219);
}

}  // namespace
}  // namespace passung
