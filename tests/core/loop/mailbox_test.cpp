#include "core/loop/mailbox.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

namespace passung {
namespace {

TEST(Mailbox, GivesTheNewestValueAgainAndAgain) {
    // Truth: invariant (contract).
    loop::Mailbox<int> box(7);
    EXPECT_EQ(box.latest(), 7);
    for (int i = 0; i < 5; ++i) {
        box.put(i);
        if (i != 2) continue;
        EXPECT_EQ(box.latest(), 2);
    }
    EXPECT_EQ(box.latest(), 4);
    EXPECT_EQ(box.latest(), 4);
    box.put(9);
    EXPECT_EQ(box.latest(), 9);
}

TEST(Mailbox, TearsNothingAndNeverGoesBackBetweenTwoThreads) {
    // Truth: invariant. Every value read is whole, not older than the one before, and the last one arrives; also run
    // under TSan.
    using Value = std::array<std::int64_t, 16>;
    constexpr std::int64_t kLast = 50000;
    loop::Mailbox<Value> box(Value{});
    std::thread writer([&] {
        Value value{};
        for (std::int64_t i = 1; i <= kLast; ++i) {
            value.fill(i);
            box.put(value);
        }
    });
    std::int64_t seen = 0;
    bool whole = true, rising = true;
    while (seen < kLast) {
        const Value& value = box.latest();
        for (const std::int64_t part : value) whole = whole && part == value[0];
        rising = rising && value[0] >= seen;
        seen = value[0];
    }
    writer.join();
    EXPECT_TRUE(whole);
    EXPECT_TRUE(rising);
}

}  // namespace
}  // namespace passung
