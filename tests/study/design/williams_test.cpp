#include "study/design/williams.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace passung::design {
namespace {

std::string text(const Square& square) {
    std::string result;
    for (const auto& row : square) {
        if (!result.empty()) result += ' ';
        for (const auto entry : row) result += static_cast<char>('0' + entry);
    }
    return result;
}

TEST(Williams, GivesThePublishedSquares) {
    // Truth: squares written out by hand from Williams' rule.
    EXPECT_EQ(text(williamsSquare(2)), "01 10");
    EXPECT_EQ(text(williamsSquare(3)), "012 120 201 210 021 102");
    EXPECT_EQ(text(williamsSquare(4)), "0132 1203 2310 3021");
    EXPECT_EQ(text(williamsSquare(5)), "01423 12034 23140 34201 40312 32410 43021 04132 10243 21304");
    EXPECT_EQ(text(williamsSquare(6)), "015243 120354 231405 342510 453021 504132");
}

TEST(Williams, BalancesPositionsAndNeighboursForTwoToTenConditions) {
    // Truth: definition of a balanced square, counted here independently of balanceOf.
    for (std::size_t n = 2; n <= 10; ++n) {
        SCOPED_TRACE(n);
        const auto square = williamsSquare(n);
        const std::size_t times = n % 2 == 0 ? 1 : 2;
        ASSERT_EQ(square.size(), williamsRows(n));
        for (const auto& row : square) {
            auto sorted = row;
            std::sort(sorted.begin(), sorted.end());
            for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(sorted[i], i);
        }
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = 0; b < n; ++b) {
                std::size_t stands = 0, follows = 0;
                for (const auto& row : square) {
                    stands += row[b] == a;
                    for (std::size_t i = 1; i < n; ++i) follows += row[i - 1] == a && row[i] == b;
                }
                EXPECT_EQ(stands, times) << a << " in position " << b;
                EXPECT_EQ(follows, a == b ? 0 : times) << b << " after " << a;
            }
    }
}

TEST(Williams, ReportsEqualCountsForACompleteSquare) {
    // Truth: definition of a balanced square.
    for (std::size_t n = 2; n <= 10; ++n) {
        const auto balance = balanceOf(assignedRows(3 * williamsRows(n), n));
        const int times = n % 2 == 0 ? 3 : 6;
        EXPECT_EQ(balance.positions.low, times);
        EXPECT_EQ(balance.positions.high, times);
        EXPECT_EQ(balance.neighbours.low, times);
        EXPECT_EQ(balance.neighbours.high, times);
    }
}

TEST(Williams, ReportsTheCarryOverOfACyclicSquare) {
    // Truth: counted by hand: in 0123 1230 2301 3012 each condition is followed three times by its successor, never by
    // another.
    const Square cyclic{{0, 1, 2, 3}, {1, 2, 3, 0}, {2, 3, 0, 1}, {3, 0, 1, 2}};
    const auto balance = balanceOf(cyclic);
    EXPECT_TRUE(balance.positions.even());
    EXPECT_EQ(balance.positions.low, 1);
    EXPECT_EQ(balance.neighbours.low, 0);
    EXPECT_EQ(balance.neighbours.high, 3);
}

TEST(Williams, HalfOfAnOddSquareBalancesPositionsOnly) {
    // Truth: counted by hand: 012 120 201 has the pairs 01 12 20 twice and 10 21 02 never.
    const auto balance = balanceOf(assignedRows(3, 3));
    EXPECT_TRUE(balance.positions.even());
    EXPECT_EQ(balance.neighbours.low, 0);
    EXPECT_EQ(balance.neighbours.high, 2);
}

TEST(Williams, SaysInWordsHowEvenTheOrdersAre) {
    // Truth: counted by hand. 9 = 8 + 1 people: nine rows, one of them twice.
    EXPECT_EQ(balanceSentence(8, 8), "8 participants = 1 complete Williams square of 8");
    EXPECT_EQ(balanceSentence(24, 8), "24 participants = 3 complete Williams squares of 8");
    EXPECT_EQ(balanceSentence(6, 3), "6 participants = 1 complete Williams square of 3 (6 rows)");
    EXPECT_EQ(balanceSentence(9, 8),
              "9 is not a multiple of 8: position counts 1-2, neighbour counts 1-2; balanced with 8 or 16");
    EXPECT_EQ(balanceSentence(1, 2),
              "1 is not a multiple of 2: position counts 0-1, neighbour counts 0-1; balanced with 2");
    EXPECT_EQ(balanceSentence(3, 3),
              "3 is not a multiple of 6: position counts 1, neighbour counts 0-2; balanced with 6");
}

}  // namespace
}  // namespace passung::design
