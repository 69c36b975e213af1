#include "devices/unit/linked_unit.h"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "core/base/random.h"
#include "devices/unit/wrench_gate.h"
#include "tests/devices/unit/scripted_link.h"
#include "tests/support/rt_guard.h"

namespace passung::unit {
namespace {

using loop::DeviceState;
using Kind = Exchange::Kind;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();
const Wrench kPush{Vec3(3, 0, 0), Vec3(0, 0, 0.1)};

LinkedParams params() {
    LinkedParams p;
    p.description.max_force_N = 12.0;
    p.description.max_torque_Nm = 0.2;
    p.first_retry = std::chrono::milliseconds(1);
    p.stale_after = p.frozen_after = std::chrono::milliseconds(100);
    return p;
}

bool isZero(const Wrench& F) { return F.force.isZero(0.0) && F.torque.isZero(0.0); }

/// A unit on a script, lent and armed, with the test as its loop.
struct Bench {
    Script script;
    std::unique_ptr<LinkedUnit> unit;

    explicit Bench(const LinkedParams& p = params()) {
        script.answers = trembling;
        unit = std::make_unique<LinkedUnit>(std::make_unique<ScriptedLink>(script), p);
        const std::lock_guard lock(script.mutex);
        script.state = [this] { return unit->state(); };
    }
    bool becomes(DeviceState state) {
        return reached([&] { return unit->state() == state; });
    }
    /// Ready, lent, and pushing for some ticks.
    void push(int ticks = 20) {
        ASSERT_TRUE(becomes(DeviceState::Present));
        unit->arm();
        ASSERT_TRUE(becomes(DeviceState::Ready));
        unit->lend({});
        unit->takeNews();
        for (int i = 0; i < ticks; ++i) tick();
    }
    /// One cycle of a loop, and an exchange of the unit's thread.
    DeviceReading tick(const Wrench& F = kPush) {
        const std::size_t before = script.count();
        DeviceReading reading = unit->read();
        unit->command(F);
        reached([&] { return script.count() > before || unit->state() == DeviceState::Lost; });
        return reading;
    }
    /// Exchanges from the first of this state to the last with a wrench that is not zero; 0: there is none.
    std::int64_t notZeroSince(DeviceState lost) {
        const std::lock_guard lock(script.mutex);
        const auto first = std::find(script.state_then.begin(), script.state_then.end(), lost);
        std::int64_t last = 0;
        for (auto i = static_cast<std::size_t>(first - script.state_then.begin()); i < script.got.size(); ++i)
            if (!isZero(script.got[i])) last = static_cast<std::int64_t>(i) - (first - script.state_then.begin()) + 1;
        return last;
    }
    std::vector<UnitNews> losses() {
        std::vector<UnitNews> all;
        for (const UnitNews& news : unit->takeNews())
            if (news.isLoss()) all.push_back(news);
        return all;
    }
    /// A wrench comes through; of one that a busy machine brings late nothing does.
    bool pushes() {
        return reached([&] {
            tick();
            const std::lock_guard lock(script.mutex);
            return !isZero(script.got.back());
        });
    }
};

TEST(LinkedUnit, IsPresentUntilItIsArmedAndGivesNoForceBefore) {
    // Truth: invariant: the states as unit.h tells them.
    Bench bench;
    ASSERT_TRUE(bench.becomes(DeviceState::Present));
    EXPECT_EQ(bench.unit->identity()->serial, "7");
    bench.unit->lend({});
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(bench.tick().fresh);
    EXPECT_EQ(bench.unit->status().state, DeviceState::Present);
    EXPECT_FALSE(bench.unit->status().commanded) << "the result of a command comes with the next reading";
    EXPECT_EQ(bench.notZeroSince(DeviceState::Present), 0);
    bench.unit->arm();
    ASSERT_TRUE(bench.becomes(DeviceState::Ready));
    EXPECT_TRUE(reached([&] { return bench.tick().fresh; }));
    EXPECT_TRUE(bench.unit->status().commanded);
    EXPECT_TRUE(bench.pushes());
}

TEST(LinkedUnit, GetsNoForceBetweenAttempts) {
    // Truth: invariant.
    Bench bench;
    bench.push();
    bench.unit->giveBack();
    const std::size_t then = bench.script.count();
    ASSERT_TRUE(reached([&] { return bench.script.count() > then + 5; }));
    const std::lock_guard lock(bench.script.mutex);
    for (std::size_t i = then + 1; i < bench.script.got.size(); ++i) EXPECT_TRUE(isZero(bench.script.got[i]));
}

TEST(LinkedUnit, AnAttemptKeepsItsForceThoughTheOneBeforeItEndsLater) {
    // Truth: invariant: the next attempt's device is made before the last one's is gone.
    Bench bench;
    bench.push();
    auto first = std::make_unique<LentUnit>(*bench.unit, Pose{});
    bench.unit->giveBack();
    const LentUnit second(*bench.unit, Pose{});
    first.reset();
    EXPECT_TRUE(bench.pushes());
}

TEST(LinkedUnit, ALoopThatHangsPushesNobody) {
    // Truth: invariant: a wrench holds for a heartbeat; the unit's thread goes on.
    Bench bench;
    bench.push();
    const std::size_t then = bench.script.count();
    ASSERT_TRUE(reached([&] { return bench.script.count() > then + 10; }));
    const std::lock_guard lock(bench.script.mutex);
    for (std::size_t i = then + 2; i < bench.script.got.size(); ++i)
        EXPECT_TRUE(isZero(bench.script.got[i])) << "exchange " << i - then << " after the last command";
    EXPECT_EQ(bench.unit->state(), DeviceState::Ready) << "nothing is wrong with the device";
}

TEST(LinkedUnit, ALoopThatGoesOnGetsItsForceBackByARamp) {
    // Truth: invariant: no step, however long it hung.
    Bench bench;
    bench.push();
    const std::size_t then = bench.script.count();
    ASSERT_TRUE(reached([&] { return bench.script.count() > then + 5; }));
    const std::size_t back = bench.script.count();
    ASSERT_TRUE(reached([&] {
        bench.tick();
        const std::lock_guard lock(bench.script.mutex);
        return bench.script.got.back().force == kPush.force;
    }));
    const std::lock_guard lock(bench.script.mutex);
    int between = 0;
    for (std::size_t i = back; i < bench.script.got.size(); ++i) {
        const double felt = bench.script.got[i].force.x();
        between += felt > 0.0 && felt < kPush.force.x() ? 1 : 0;
    }
    EXPECT_GT(between, 0);
}

struct FaultCase {
    const char* name;
    DeviceState state;
    std::function<Exchange(std::int64_t)> answers;
};

class LinkedUnitFault : public testing::TestWithParam<FaultCase> {};

TEST_P(LinkedUnitFault, TakesTheForceAtOnceIsToldOnceAndNeedsToBeArmed) {
    // Truth: invariant: from the exchange after the one that showed the fault on all wrenches are zero; one piece of
    // news; sound values alone do not bring the force back, being armed does.
    Bench bench;
    bench.push();
    bench.script.say(GetParam().answers);
    for (int i = 0; i < 400000 && bench.unit->state() == DeviceState::Ready; ++i) bench.tick();
    ASSERT_EQ(bench.unit->state(), GetParam().state);
    for (int i = 0; i < 20; ++i) bench.tick();
    EXPECT_EQ(bench.notZeroSince(GetParam().state), 0);
    const auto losses = bench.losses();
    ASSERT_EQ(losses.size(), 1u);
    EXPECT_EQ(losses.front().state, GetParam().state);
    EXPECT_FALSE(losses.front().why.empty());

    bench.script.say(trembling);
    for (int i = 0; i < 20; ++i) bench.tick();
    EXPECT_EQ(bench.notZeroSince(GetParam().state), 0) << "not armed";
    bench.unit->arm();
    ASSERT_TRUE(bench.becomes(DeviceState::Ready));
    EXPECT_TRUE(bench.pushes());
}

template <class Change>
std::function<Exchange(std::int64_t)> bent(Change change) {
    return [change](std::int64_t n) {
        Exchange exchange = trembling(n);
        change(exchange.said.X_BD);
        return exchange;
    };
}

std::vector<FaultCase> faults() {
    return {
        {"Silence", DeviceState::Stale, [](std::int64_t) { return Exchange{}; }},
        {"ToldStale", DeviceState::Stale,
         [](std::int64_t) {
             return Exchange{Kind::Stale, {}, "silent"};
         }},
        {"Wrong", DeviceState::Fault,
         [](std::int64_t) {
             return Exchange{Kind::Wrong, {}, "half a frame"};
         }},
        {"Frozen", DeviceState::Fault, [](std::int64_t) { return pose(Vec3(1e-6, 0, 0)); }},
        {"NotANumber", DeviceState::Fault, bent([](Pose& X) { X.p.y() = kNaN; })},
        {"Infinite", DeviceState::Fault, bent([](Pose& X) { X.p.z() = kInfinity; })},
        {"NoRotation", DeviceState::Fault, bent([](Pose& X) { X.q.coeffs() *= 1.1; })},
        {"ZeroQuaternion", DeviceState::Fault, bent([](Pose& X) { X.q.coeffs().setZero(); })},
        {"Jump", DeviceState::Fault, [](std::int64_t n) { return pose(Vec3(n < 3 ? 0.0 : 900.0, 0, 0)); }},
        {"TooFar", DeviceState::Fault, [](std::int64_t) { return pose(Vec3(0, 2e3, 0)); }},
    };
}
INSTANTIATE_TEST_SUITE_P(Faults, LinkedUnitFault, testing::ValuesIn(faults()),
                         [](const testing::TestParamInfo<FaultCase>& fault) { return fault.param.name; });

TEST(LinkedUnit, StampsAWrenchWithTheTimeAtWhichTheLoopMadeIt) {
    // Truth: invariant: exchanges that follow without a command of the loop's have the stamp of its last.
    Bench bench;
    bench.push();
    const auto stamps = [&] {
        const std::lock_guard lock(bench.script.mutex);
        return bench.script.stamps;
    };
    const auto monotonic = [] {
        timespec t{};
        clock_gettime(CLOCK_MONOTONIC, &t);
        return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
    };
    const std::int64_t before = monotonic();
    bench.unit->command(kPush);
    const std::int64_t after = monotonic();
    const std::size_t from = stamps().size() + 1;  // one may be on its way
    ASSERT_TRUE(reached([&] { return stamps().size() > from + 5; }));
    const auto all = stamps();
    for (std::size_t i = from; i < all.size(); ++i) {
        EXPECT_GE(all[i], before);
        EXPECT_LE(all[i], after);
    }
}

TEST(LinkedUnit, WhatIsToldBesideAFaultIsNoOtherFault) {
    // Truth: invariant: of a unit that is in use a remark is told; of one that has a fault it would be a second one.
    Bench bench;
    bench.push();
    const auto remarking = [](std::int64_t n) {
        Exchange exchange = trembling(n);
        exchange.why = "by the way";
        return exchange;
    };
    bench.script.say(remarking);
    EXPECT_TRUE(reached([&] {
        bench.tick();
        const auto news = bench.unit->takeNews();
        return std::any_of(news.begin(), news.end(), [](const UnitNews& n) { return n.why == "by the way"; });
    }));
    bench.script.say([remarking](std::int64_t n) {
        return n == 0 ? Exchange{Kind::Wrong, {}, "broken"} : remarking(n);
    });
    ASSERT_TRUE(reached([&] {
        bench.tick();
        return bench.unit->state() == DeviceState::Fault;
    }));
    for (int i = 0; i < 20; ++i) bench.tick();
    const auto losses = bench.losses();
    ASSERT_EQ(losses.size(), 1u);
    EXPECT_EQ(losses.front().why, "broken");
}

TEST(LinkedUnit, IsLookedForAgainWhenItWasUnpluggedAndWaitsToBeArmed) {
    // Truth: invariant.
    Bench bench;
    bench.push();
    bench.script.plug(false);
    bench.tick();
    ASSERT_TRUE(bench.becomes(DeviceState::Lost));
    EXPECT_FALSE(bench.unit->read().fresh);
    ASSERT_TRUE(reached([&] { return bench.unit->trouble() == "nothing is plugged in: plug it in"; }));
    ASSERT_EQ(bench.losses().size(), 1u);
    bench.script.plug(true);
    ASSERT_TRUE(bench.becomes(DeviceState::Present));
    EXPECT_EQ(bench.script.opened, 2);
    const std::size_t then = bench.script.count();
    for (int i = 0; i < 10; ++i) bench.tick();
    {
        const std::lock_guard lock(bench.script.mutex);
        for (std::size_t i = then; i < bench.script.got.size(); ++i) EXPECT_TRUE(isZero(bench.script.got[i]));
    }
    bench.unit->arm();
    ASSERT_TRUE(bench.becomes(DeviceState::Ready));
    EXPECT_TRUE(bench.pushes());
}

/// Readings in a row that are not fresh, with the age [s] of the newest of them.
struct Gap {
    int readings = 0;
    double age_s = 0.0;
};

/// The longest gaps of so many readings, which `between` parts.
std::vector<Gap> gapsOf(LinkedUnit& unit, int readings, const std::function<void()>& between) {
    std::vector<Gap> gaps;
    Gap gap;
    for (int i = 0; i < readings; ++i) {
        between();
        if (unit.read().fresh) {
            if (gap.readings > 0) gaps.push_back(gap);
            gap = {};
        } else {
            ++gap.readings;
            gap.age_s = unit.status().age_s;
        }
    }
    gaps.push_back(gap);
    return gaps;
}

TEST(LinkedUnit, AReadingStandsForAMomentWithoutTheNextAndIsHeldBefore) {
    // Truth: invariant: the tick's input guard holds one sample and takes the force at the second that is not fresh.
    // Two such are older than reading_stands, whatever the machine does.
    Bench bench;
    bench.push();
    bench.script.say([](std::int64_t n) { return n % 4 == 0 ? trembling(n / 4) : Exchange{}; });
    std::size_t gaps = 0;
    for (const Gap& gap : gapsOf(*bench.unit, 400, [&] { bench.unit->command(kPush); })) {
        if (gap.readings > 0) ++gaps;
        EXPECT_TRUE(gap.readings <= 1 || gap.age_s > 5e-3) << gap.readings << ", " << gap.age_s;
    }
    EXPECT_GT(gaps, 10u) << "a reading without news is held for a tick first";
}

TEST(LinkedUnit, WhatIsOlderIsNotFresh) {
    // Truth: invariant.
    Bench bench;
    bench.push();
    bench.script.say([](std::int64_t) { return Exchange{}; });
    poll(nullptr, 0, 10);
    bench.unit->read();
    for (int i = 0; i < 20; ++i) EXPECT_FALSE(bench.unit->read().fresh);
}

TEST(WrenchGate, ScalesIntoTheLimitsKeepsTheDirectionAndStopsWhatIsNoNumber) {
    // Truth: closed form: one factor for both halves.
    DeviceDescription limits;
    limits.max_force_N = 10.0;
    limits.max_torque_Nm = 0.5;
    const Wrench within = passed({Vec3(30, 0, 0), Vec3(0, 0.3, 0)}, limits, true);
    EXPECT_NEAR(within.force.x(), 10.0, 1e-9);
    EXPECT_NEAR(within.torque.y(), 0.1, 1e-9);
    EXPECT_LE(within.force.norm(), 10.0);
    EXPECT_TRUE(isZero(passed(kPush, limits, false)));
    for (const double bad : {kNaN, kInfinity, 1e200})
        EXPECT_TRUE(isZero(passed({Vec3(1, 0, 0), Vec3(0, bad, 0)}, limits, true))) << bad;
    limits.actuated_degrees = 3;
    EXPECT_TRUE(passed(kPush, limits, true).torque.isZero(0.0));
}

TEST(LinkedUnit, WhateverItSaysTheWrenchIsFiniteWithinLimitsAndZeroUnlessReady) {
    // Truth: invariant. Readings and commands drawn at random, most of them sound; in a long run a million ticks.
    const int ticks = std::getenv("PASSUNG_LONG") != nullptr ? 1'000'000 : 5'000;
    Bench bench;
    Random random(22), commands(23);
    const auto number = [&random](double scale) {
        switch (random.below(400)) {
            case 0:
                return kNaN;
            case 1:
                return kInfinity;
            case 2:
                return -1e308;
            case 3:
                return 5e-324;
            default:
                return scale * random.uniform(-1.0, 1.0);
        }
    };
    bench.push();
    bench.script.say([&](std::int64_t) {
        const auto kind = random.below(200);
        if (kind == 0) return Exchange{Kind::Wrong, {}, "wrong"};
        if (kind == 1) return Exchange{Kind::Stale, {}, "stale"};
        if (kind < 6) return Exchange{};
        Exchange exchange = pose(Vec3(number(1e-3), number(1e-3), number(1e-3)));
        if (kind < 8) exchange.said.X_BD.q.coeffs() *= number(2.0);
        return exchange;
    });
    for (int i = 0; i < ticks; ++i) {
        if (bench.unit->state() != DeviceState::Ready) bench.unit->arm();
        Wrench F;
        for (int k = 0; k < 3; ++k) {
            F.force[k] = commands.uniform(-40.0, 40.0);
            F.torque[k] = commands.below(50) == 0 ? kNaN : commands.uniform(-1.0, 1.0);
        }
        bench.tick(F);
    }
    const std::lock_guard lock(bench.script.mutex);
    const DeviceDescription limits = params().description;
    int ready = 0;
    for (std::size_t i = 0; i < bench.script.got.size(); ++i) {
        const Wrench& F = bench.script.got[i];
        ASSERT_TRUE(isFinite(F));
        ASSERT_LE(F.force.norm(), limits.max_force_N);
        ASSERT_LE(F.torque.norm(), limits.max_torque_Nm);
        const bool is_ready = bench.script.state_then[i] == DeviceState::Ready;
        ready += is_ready ? 1 : 0;
        ASSERT_TRUE(is_ready || isZero(F)) << i;
    }
    std::printf("fuzzed: %d ticks, %zu exchanges, %d of them ready\n", ticks, bench.script.got.size(), ready);
    EXPECT_GT(ready, ticks / 20);
}

double seconds() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

TEST(LinkedUnit, ReadsAndCommandsWithoutALockAndInMicroseconds) {
    // Truth: invariant (support::RtGuard); the times are printed, without a mark.
    if (!support::RtGuard::available()) GTEST_SKIP();
    Bench bench;
    bench.push();
    std::array<double, 5000> reads{}, commands{};
    {
        const support::RtGuard guard;
        for (std::size_t i = 0; i < reads.size(); ++i) {
            const double a = seconds();
            bench.unit->read();
            const double b = seconds();
            bench.unit->command(kPush);
            reads[i] = b - a;
            commands[i] = seconds() - b;
        }
        EXPECT_EQ(guard.violations(), 0) << guard.describe();
    }
    std::sort(reads.begin(), reads.end());
    std::sort(commands.begin(), commands.end());
    std::printf("read() median %.2f p99 %.2f us, command() median %.2f p99 %.2f us\n", 1e6 * reads[2500],
                1e6 * reads[4950], 1e6 * commands[2500], 1e6 * commands[4950]);
}

TEST(LinkedUnit, AHandleOfItsOwnGoesAtTheSpeedThatIsSaidAndGivesWayToAWall) {
    // Truth: closed form (rate_handle.h): on a wall of stiffness K it rests v/(b K) behind the surface at the force
    // v/b.
    LinkedParams p = params();
    p.gives_speeds = true;
    p.pushes = false;
    p.clutch = 2;
    p.description.workspace_radius_m = 0.15;
    Bench bench(p);
    Exchange pushed{Kind::News, {}, {}};
    pushed.said.V_D_B.v = Vec3(0.05, 0, 0);
    bench.script.say([pushed](std::int64_t n) { return n == 0 ? pushed : Exchange{}; });
    ASSERT_TRUE(bench.becomes(DeviceState::Present));
    bench.unit->arm();
    ASSERT_TRUE(bench.becomes(DeviceState::Ready));
    ASSERT_TRUE(reached([&] { return bench.script.since > 0; }));
    bench.unit->lend({});
    EXPECT_FALSE(bench.unit->pushesHand());
    DeviceReading reading;
    const auto run = [&](int ticks, double stiffness, double wall) {
        double force = 0.0;
        for (int i = 0; i < ticks; ++i) {
            reading = bench.unit->read();
            force = std::max(0.0, stiffness * (reading.X_BD.p.x() - wall));
            bench.unit->command({Vec3(-force, 0, 0), Vec3::Zero()});
        }
        return force;
    };
    run(1000, 0.0, 0.0);
    EXPECT_NEAR(reading.X_BD.p.x(), 0.05, 1e-12);
    EXPECT_TRUE(reading.fresh) << "at rest a mouse has nothing to say";
    constexpr double kStiffness = 2000.0, kWall = 0.08;
    EXPECT_NEAR(run(3000, kStiffness, kWall), 0.05 / RateHandle::kGiving, 1e-6);
    EXPECT_NEAR(reading.X_BD.p.x() - kWall, 0.05 / (RateHandle::kGiving * kStiffness), 1e-9);
    run(5000, 0.0, 0.0);
    EXPECT_NEAR(reading.X_BD.p.x(), 0.15, 1e-12) << "the workspace ends";
    pushed.said.V_D_B.v = Vec3(-0.05, 0, 0);
    pushed.said.buttons = 2;
    bench.script.say([pushed](std::int64_t n) { return n == 0 ? pushed : Exchange{}; });
    ASSERT_TRUE(reached([&] { return bench.unit->read().buttons == 2; }));
    const double then = bench.unit->read().X_BD.p.x();
    run(500, 0.0, 0.0);
    EXPECT_EQ(reading.X_BD.p.x(), then) << "the clutch lets go";
}

}  // namespace
}  // namespace passung::unit
