#include "study/measures/period_clock.h"

#include <gtest/gtest.h>

namespace passung::measures {
namespace {

TickRecord tick(std::int64_t number, std::uint32_t periods = 1) {
    TickRecord record;
    record.tick = number;
    record.periods = periods;
    return record;
}

TEST(PeriodClock, IsTheTickInVirtualTime) {
    // Truth: closed form
    PeriodClock clock;
    for (std::int64_t i = 0; i < 5; ++i) EXPECT_EQ(clock.at(tick(i)), i);
    EXPECT_EQ(clock.missed(), 0);
    EXPECT_EQ(clock.until(9), 9);
}

TEST(PeriodClock, CountsMissedCyclesAndTakesALostRecordForOnePeriod) {
    // Truth: closed form. Tick 1 at 1; tick 2 after two missed cycles at 4; tick 3 was lost: 5; tick 4 at 6.
    PeriodClock clock;
    EXPECT_EQ(clock.at(tick(0)), 0);
    EXPECT_EQ(clock.at(tick(1)), 1);
    EXPECT_EQ(clock.at(tick(2, 3)), 4);
    EXPECT_EQ(clock.at(tick(4)), 6);
    EXPECT_EQ(clock.missed(), 2);
    EXPECT_EQ(clock.periods(), 6);
    EXPECT_EQ(clock.until(6), 8);
}

TEST(PeriodClock, LeavesOutWhatWasMissedBeforeItsOrigin) {
    // Truth: closed form
    PeriodClock clock(100);
    EXPECT_EQ(clock.at(tick(99, 7)), 0);
    EXPECT_EQ(clock.at(tick(100, 50)), 0);
    EXPECT_EQ(clock.at(tick(101, 2)), 2);
    EXPECT_EQ(clock.missed(), 1);
}

}  // namespace
}  // namespace passung::measures
