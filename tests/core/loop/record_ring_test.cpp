#include "core/loop/record_ring.h"

#include <gtest/gtest.h>

#include <thread>

namespace passung {
namespace {

TickRecord numbered(std::int64_t tick) {
    TickRecord record;
    record.tick = tick;
    record.duration_ns = 7 * tick;  // so that a torn record shows
    return record;
}

TEST(RecordRing, KeepsOrderAndDropsTheNewestWhenFull) {
    // Truth: invariant (contract).
    loop::RecordRing ring(4);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(ring.tryPush(numbered(i)), i < 4);
    EXPECT_EQ(ring.dropped(), 2);
    std::vector<TickRecord> taken(3);
    ASSERT_EQ(ring.take(taken), 3u);
    EXPECT_EQ(taken[0].tick, 0);
    EXPECT_EQ(taken[2].tick, 2);
    EXPECT_TRUE(ring.tryPush(numbered(10)));
    taken.resize(8);
    ASSERT_EQ(ring.take(taken), 2u);
    EXPECT_EQ(taken[1].tick, 10);
    EXPECT_EQ(ring.take(taken), 0u);
}

TEST(RecordRing, LosesAndTearsNothingBetweenTwoThreads) {
    // Truth: invariant. Every record that was accepted arrives once, whole and in order; also run under TSan.
    loop::RecordRing ring(64);
    constexpr std::int64_t kRecords = 20000;
    std::thread producer([&] {
        for (std::int64_t i = 0; i < kRecords;) i += ring.tryPush(numbered(i)) ? 1 : 0;
    });
    std::vector<TickRecord> taken(50);
    std::int64_t expected = 0;
    while (expected < kRecords) {
        const std::size_t count = ring.take(taken);
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_EQ(taken[i].tick, expected);
            ASSERT_EQ(taken[i].duration_ns, 7 * expected);
            ++expected;
        }
    }
    producer.join();
}

}  // namespace
}  // namespace passung
