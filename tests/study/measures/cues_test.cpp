#include "study/measures/cues.h"

#include <gtest/gtest.h>

#include <cmath>

namespace passung::measures {
namespace {

/// A hand that comes down at `speed` [m/s] and touches from tick `touch` on, 1 mm deep.
TickRecord tickAt(std::int64_t tick, double speed, std::int64_t touch) {
    TickRecord record;
    record.tick = tick;
    record.hand_position_m = {0.0f, 0.0f, static_cast<float>(-speed * static_cast<double>(tick) * kTickSeconds)};
    if (tick < touch) return record;
    record.contacts = 3;
    record.hand_depth_m = 0.001f;
    return record;
}

TEST(Cues, FollowDepthAndImpactSpeed) {
    // Truth: closed form: 1 mm of 2 mm; 30 mm/s of 100 mm/s, falling by exp(-t / 50 ms).
    CueSignals signals({true, true, true, 0.002, 0.1, 0.05});
    for (std::int64_t tick = 0; tick < 200; ++tick) {
        const CueCommands commands = signals.at(tickAt(tick, 0.03, 100));
        EXPECT_NEAR(commands.visual, tick < 100 ? 0.0 : 0.5, 1e-7) << tick;
        EXPECT_EQ(commands.vibration, commands.visual);
        const double since = 0.001 * static_cast<double>(tick - 100);
        EXPECT_NEAR(commands.sound, tick < 100 ? 0.0 : 0.3 * std::exp(-since / 0.05), 1e-4) << tick;
    }
}

TEST(Cues, NeverPassOne) {
    // Truth: invariant: a command is from 0 to 1, however deep and fast.
    CueSignals signals({true, true, true, 1e-5, 0.001, 0.05});
    for (std::int64_t tick = 0; tick < 20; ++tick) {
        const CueCommands commands = signals.at(tickAt(tick, 2.0, 10));
        EXPECT_LE(commands.visual, 1.0);
        EXPECT_LE(commands.sound, 1.0);
        if (tick == 10) {
            EXPECT_EQ(commands.sound, 1.0);
        }
    }
}

TEST(Cues, KnowMissedCycles) {
    // Truth: closed form: the impact's record lies 4 periods after the one before, so its speed is a quarter.
    CueSignals signals({false, false, true, 0.002, 0.1, 0.05});
    TickRecord before = tickAt(0, 0.0, 10), impact = tickAt(1, 0.08, 0);
    impact.periods = 4;
    signals.at(before);
    EXPECT_NEAR(signals.at(impact).sound, 0.2, 1e-6);
}

TEST(Cues, AreZeroWhereTheConditionHasNone) {
    // Truth: invariant.
    CueSignals signals({});
    for (std::int64_t tick = 0; tick < 20; ++tick) {
        const CueCommands commands = signals.at(tickAt(tick, 0.05, 10));
        EXPECT_EQ(commands.visual + commands.vibration + commands.sound, 0.0);
    }
}

}  // namespace
}  // namespace passung::measures
