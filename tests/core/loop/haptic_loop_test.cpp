#include "core/loop/haptic_loop.h"

#include <gtest/gtest.h>

#include <time.h>
#include <array>
#include <chrono>

#include <algorithm>
#include <cmath>
#include <thread>

#include "core/base/processor_clock.h"
#include "core/base/random.h"
#include "core/loop/cadence.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

/// Stays at one pose, counts what it is told.
class StillDevice final : public loop::HapticDevice {
public:
    explicit StillDevice(const Pose& pose) : pose_(pose) {}
    const DeviceDescription& description() const override { return description_; }
    DeviceReading read() noexcept override { return {pose_}; }
    void command(const Wrench& wrench) noexcept override { last = wrench; }
    void show(const loop::DisplayedImage& image) noexcept override {
        ++images;
        last_image = image;
    }

    Wrench last;
    int images = 0;
    loop::DisplayedImage last_image;

private:
    Pose pose_;
    DeviceDescription description_;
};

test::Bench ballInTable() {
    return test::Bench(test::scene(shape::Sphere{0.02}, {Quat::Identity(), Vec3(0, 0, 0.012)},
                                   shape::Box{0.06, 0.06, 0.02}, {Quat::Identity(), Vec3(0, 0, -0.01)},
                                   scene::ContactMethod::GodObjectHeuristic));
}
const Pose kPressed{Quat::Identity(), Vec3(0, 0, 0.008)};

TEST(HapticCycle, RecordsEveryTickAndShowsSixtyImagesASecond) {
    // Truth: closed form (60 of 1000 ticks) and invariant.
    test::Bench bench = ballInTable();
    StillDevice device(kPressed);
    loop::RecordRing ring(2048);
    loop::HapticCycle cycle(bench.whole(), device, ring, true);
    for (int i = 0; i < 1000; ++i) cycle.run(i == 500 ? 3 : 0);
    std::vector<TickRecord> records(2048);
    records.resize(ring.take(records));
    ASSERT_EQ(records.size(), 1000u);
    for (std::size_t i = 0; i < records.size(); ++i) {
        EXPECT_EQ(records[i].tick, static_cast<std::int64_t>(i));
        EXPECT_EQ((records[i].status & kOverrun) != 0, i == 500);
        EXPECT_EQ(records[i].periods, i == 500 ? 4u : 1u);
    }
    EXPECT_EQ(device.images, 60);
    EXPECT_NEAR(device.last_image.X_WShown.p.z(), 0.01, 1e-4);  // the proxy
    EXPECT_NEAR(records.back().force_N[2], static_cast<float>(device.last.force.z()), 1e-6f);
    EXPECT_EQ(cycle.timing().count(), 1000);
    cycle.release();
    EXPECT_EQ(device.last.force.norm(), 0.0);
}

TEST(HapticCycle, GivesEachOfTwoHandsItsOwnDeviceAndRing) {
    // Truth: closed form. The ball is pressed 2 mm into a table in another hand, two springs of 1000 N/m: each hand
    // feels 1 N, in opposite directions; a released cycle commands nothing. Each person sees both parts.
    auto spec = test::scene(shape::Sphere{0.02}, {Quat::Identity(), Vec3(0, 0, 0.012)}, shape::Box{0.06, 0.06, 0.02},
                            {Quat::Identity(), Vec3(0, 0, -0.01)}, scene::ContactMethod::GodObject);
    spec.contact.geometry = scene::Geometry::ClosedForm;
    spec.contact.stiffness = 1000;
    spec.parts[1].held = true;
    spec.parts[1].hand = 1;
    spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate, "left"});
    const test::Bench bench(spec);
    StillDevice ball(kPressed), table({Quat::Identity(), Vec3(0, 0, -0.01)});
    loop::RecordRing of_ball(256), of_table(256);
    loop::ScreenRing screen(256);
    const std::array screens{&screen};
    const std::array hands{loop::HandPort{&ball, &of_ball}, loop::HandPort{&table, &of_table}};
    loop::HapticCycle cycle(std::array{tick::SceneTurn{&bench.whole()}}, hands, true, screens);
    {
        support::RtGuard guard;
        for (int i = 0; i < 200; ++i) cycle.run();
        EXPECT_EQ(guard.violations(), 0) << guard.describe();
    }
    std::vector<TickRecord> balls(256), tables(256);
    balls.resize(of_ball.take(balls));
    tables.resize(of_table.take(tables));
    ASSERT_EQ(balls.size(), 200u);
    ASSERT_EQ(tables.size(), 200u);
    EXPECT_EQ(tables.back().tick, 199);
    EXPECT_NEAR(ball.last.force.z(), 1.0, 1e-3);
    EXPECT_NEAR(table.last.force.z(), -1.0, 1e-3);
    EXPECT_NEAR(tables.back().force_N[2], -1.0, 1e-3);
    for (const StillDevice* device : {&ball, &table}) {
        EXPECT_GT(device->images, 10);
        EXPECT_NEAR(device->last_image.X_WHeld[0].p.z(), 0.009, 1e-5);
        EXPECT_NEAR(device->last_image.X_WHeld[1].p.z(), -0.011, 1e-5);
    }
    EXPECT_EQ(ball.last_image.X_WShown.p, ball.last_image.X_WHeld[0].p);
    EXPECT_EQ(table.last_image.X_WShown.p, table.last_image.X_WHeld[1].p);
    std::vector<loop::ScreenTick> shown(256);
    ASSERT_EQ(screen.take(shown), 200u);
    EXPECT_NEAR(shown[199].others[0].X_WG.p.z(), -0.011, 1e-5);
    EXPECT_NEAR(shown[199].others[0].X_WH.p.z(), -0.01, 1e-12);
    cycle.release();
    EXPECT_EQ(ball.last.force.norm(), 0.0);
    EXPECT_EQ(table.last.force.norm(), 0.0);
}

TEST(HapticCycle, ShowsTheGoSignToAllHandsOnceAllAreEngaged) {
    // Truth: definition of the trial's begin (SceneSequence). The second hand's gate asks for 100 ticks, the first
    // one's for none.
    auto spec = test::scene(shape::Sphere{0.02}, {Quat::Identity(), Vec3(0, 0, 0.012)}, shape::Box{0.06, 0.06, 0.02},
                            {Quat::Identity(), Vec3(0, 0, -0.01)}, scene::ContactMethod::GodObject);
    spec.contact.geometry = scene::Geometry::ClosedForm;
    spec.parts[1].held = true;
    spec.parts[1].hand = 1;
    spec.other_hands.push_back({spec.limits, spec.registration, {1.0, 3.0, 100}, "left"});
    const test::Bench bench(spec);
    StillDevice ball({Quat::Identity(), Vec3(0, 0, 0.012)}), table({Quat::Identity(), Vec3(0, 0, -0.01)});
    loop::RecordRing of_ball(256), of_table(256);
    loop::ScreenRing screen(256);
    const std::array screens{&screen};
    const std::array hands{loop::HandPort{&ball, &of_ball}, loop::HandPort{&table, &of_table}};
    loop::HapticCycle cycle(std::array{tick::SceneTurn{&bench.whole()}}, hands, true, screens);
    for (int i = 0; i < 80; ++i) cycle.run();
    EXPECT_FALSE(ball.last_image.running) << "the other hand is not there yet";
    EXPECT_FALSE(table.last_image.running);
    for (int i = 0; i < 80; ++i) cycle.run();
    EXPECT_TRUE(ball.last_image.running);
    EXPECT_TRUE(table.last_image.running);
    std::vector<TickRecord> balls(256), tables(256);
    ASSERT_EQ(of_ball.take(balls), 160u);
    ASSERT_EQ(of_table.take(tables), 160u);
    std::vector<loop::ScreenTick> shown(256);
    ASSERT_EQ(screen.take(shown), 160u);
    EXPECT_NE(balls[0].status & kEngaged, 0u);
    for (std::size_t i = 0; i < 160; ++i) EXPECT_EQ(shown[i].engaged, (tables[i].status & kEngaged) != 0) << i;
}

TEST(HapticCycle, RecordsWhatATickTookOfTheProcessorBesideTheWallClock) {
    // Truth: closed form: a thread cannot spend more on a processor than passes on the wall, but for the two readings
    // of the wall clock inside; and what the ticks took is no more than the thread took for all.
    test::Bench bench = ballInTable();
    StillDevice device(kPressed);
    loop::RecordRing ring(2048);
    loop::HapticCycle cycle(bench.whole(), device, ring, true);
    const std::int64_t begin = threadProcessorNanoseconds();
    for (int i = 0; i < 1000; ++i) cycle.run();
    const std::int64_t all = threadProcessorNanoseconds() - begin;
    std::vector<TickRecord> records(2048);
    records.resize(ring.take(records));
    std::int64_t sum = 0;
    std::vector<std::int64_t> excess;
    for (const TickRecord& record : records) {
        EXPECT_GT(record.processor_ns, 0);
        sum += record.processor_ns;
        excess.push_back(record.processor_ns - record.duration_ns);
    }
    EXPECT_LE(sum, all);
    std::nth_element(excess.begin(), excess.begin() + 500, excess.end());
    EXPECT_LT(excess[500], 10'000);  // [ns], some readings of a clock
    EXPECT_EQ(cycle.processorTiming().count(), 1000);
    EXPECT_NEAR(cycle.processorTiming().meanMicroseconds(), 1e-6 * static_cast<double>(sum), 1e-9);
}

TEST(HapticCycle, EveryScreenGetsEveryTickWithTheTimeAtWhichItBegan) {
    // Truth: invariant. A screen that nobody empties costs the others and the recording nothing.
    test::Bench bench = ballInTable();
    StillDevice device(kPressed);
    loop::RecordRing ring(256);
    loop::ScreenRing screen(256), forgotten(16);
    const std::array screens{&forgotten, &screen};
    loop::HapticCycle cycle(bench.whole(), device, ring, true, screens);
    const auto steady = [] { return std::chrono::steady_clock::now().time_since_epoch().count(); };
    std::int64_t before = steady();
    for (int i = 0; i < 200; ++i) cycle.run();
    const std::int64_t after = steady();
    std::vector<loop::ScreenTick> ticks(256);
    ASSERT_EQ(screen.take(ticks), 200u);
    for (std::size_t i = 0; i < 200; ++i) {
        EXPECT_EQ(ticks[i].record.tick, static_cast<std::int64_t>(i));
        EXPECT_GE(ticks[i].began_ns, before);
        before = ticks[i].began_ns;
    }
    EXPECT_LE(before, after);
    EXPECT_EQ(forgotten.dropped(), 184);
    EXPECT_EQ(ring.dropped(), 0);
}

TEST(HapticCycle, AllocatesLocksAndWritesNothing) {
    // Truth: invariant, counted by interposed functions; the cycle reads the clock, nothing else.
    if (!support::RtGuard::available()) GTEST_SKIP() << "the sanitizer owns the interposed functions";
    test::Bench bench = ballInTable();
    StillDevice device(kPressed);
    loop::RecordRing ring(1024);  // fills up: dropping must be as quiet
    loop::ScreenRing screen(64);
    const std::array screens{&screen};
    loop::HapticCycle cycle(bench.whole(), device, ring, true, screens);
    support::RtGuard guard;
    for (int i = 0; i < 10000; ++i) cycle.run();
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
    EXPECT_EQ(ring.dropped(), 10000 - 1024);
}

TEST(RealTimeThread, RunsCyclesAndStopsWithAZeroWrench) {
    // Truth: invariant; no deadline is asserted. Also run under TSan: records are read while the thread runs.
    test::Bench bench = ballInTable();
    StillDevice device(kPressed);
    loop::RecordRing ring(4096);
    loop::HapticCycle cycle(bench.whole(), device, ring, true);
    std::int64_t seen = 0;
    {
        loop::RealTimeThread thread(cycle);
        std::vector<TickRecord> records(256);
        while (seen < 50) {
            const std::size_t count = ring.take(records);
            for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(records[i].tick, seen++);
        }
        thread.stop();
        EXPECT_GE(thread.ticks(), 50);
        EXPECT_EQ(thread.ticks(), cycle.ticks());
    }
    EXPECT_EQ(device.last.force.norm(), 0.0);
}

TEST(Cadence, MissesTheCyclesThatAreDueBeforeTheLastOneEnds) {
    // Truth: closed form. Cycles due every 1 000 000 ns from 5 on; each row: when the cycle ends after it was due, and
    // how many are missed. One that ends just when the next is due misses none.
    constexpr std::int64_t ms = kTickNanoseconds;
    loop::Cadence cadence(5);
    std::int64_t due = 5;
    for (const auto& [took, missed] : std::vector<std::pair<std::int64_t, std::int64_t>>{
             {ms / 2, 0}, {ms, 0}, {ms + 1, 1}, {2 * ms, 1}, {2 * ms + 1, 2}, {ms / 3, 0}, {100 * ms, 99}}) {
        EXPECT_EQ(cadence.due(), due);
        EXPECT_EQ(cadence.finish(due + took), missed) << took;
        due += (1 + missed) * ms;
    }
    EXPECT_EQ(cadence.due(), due);
}

/// Takes two and a half periods for its eleventh and its twenty-first reading, by a clock that it only ever looks at.
class SlowDevice final : public loop::HapticDevice {
public:
    const DeviceDescription& description() const override { return description_; }
    DeviceReading read() noexcept override {
        if (readings_ == 10 || readings_ == 20) {
            for (const std::int64_t end = now() + 5 * kTickNanoseconds / 2; now() < end;) continue;
        }
        ++readings_;
        return {kPressed};
    }
    void command(const Wrench&) noexcept override {}

private:
    static std::int64_t now() noexcept {
        timespec t{};
        clock_gettime(CLOCK_MONOTONIC, &t);
        return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
    }
    int readings_ = 0;
    DeviceDescription description_;
};

TEST(RealTimeThread, RecordsEveryCycleThatASlowDeviceMadeItMiss) {
    // Truth: invariant. A cycle of 2.5 periods or more lets at least two pass; a busy machine may add to it.
    test::Bench bench = ballInTable();
    SlowDevice device;
    loop::RecordRing ring(4096);
    loop::HapticCycle cycle(bench.whole(), device, ring, true);
    loop::RealTimeThread thread(cycle);
    std::vector<TickRecord> records, some(256);
    const auto takeAll = [&] {
        while (const std::size_t count = ring.take(some))
            records.insert(records.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
    };
    while (records.size() < 30) takeAll();
    thread.stop();
    takeAll();
    std::int64_t missed = 0;
    for (const TickRecord& record : records) {
        EXPECT_GE(record.periods, record.tick == 11 || record.tick == 21 ? 3u : 1u) << record.tick;
        EXPECT_EQ((record.status & kOverrun) != 0, record.periods > 1) << record.tick;
        missed += record.periods - 1;
    }
    EXPECT_EQ(thread.overruns(), missed);
}

TEST(TimingHistogram, ShorterThanAHundredNanosecondsIsOneBucket) {
    // Truth: closed form. 1 ns is told as the largest, 40 ns, next to a long one as the bucket's edge, 100 · 2^(1/8)
    // ns.
    loop::TimingHistogram histogram;
    histogram.add(1);
    histogram.add(40);
    EXPECT_DOUBLE_EQ(histogram.quantileMicroseconds(0.5), 0.040);
    histogram.add(1000);
    EXPECT_DOUBLE_EQ(histogram.quantileMicroseconds(0.5), 0.1 * std::exp2(0.125));
}

TEST(TimingHistogram, QuantilesAreWithinABucketOfTheTruth) {
    // Truth: closed form: the sorted sample itself.
    loop::TimingHistogram histogram;
    Random random(2);
    std::vector<double> sample;
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto ns = static_cast<std::int64_t>(1000.0 * std::exp(2.0 * random.normal()) + 200.0);
        histogram.add(ns);
        sample.push_back(static_cast<double>(ns) * 1e-3);
        sum += sample.back();
    }
    std::sort(sample.begin(), sample.end());
    for (const double q : {0.5, 0.9, 0.99, 0.999}) {
        const double truth = sample[static_cast<std::size_t>(q * 20000.0) - 1];
        EXPECT_GE(histogram.quantileMicroseconds(q), truth * 0.999);
        EXPECT_LE(histogram.quantileMicroseconds(q), truth * std::exp2(1.0 / 8) * 1.001);
    }
    EXPECT_EQ(histogram.quantileMicroseconds(1.0), sample.back());
    EXPECT_NEAR(histogram.meanMicroseconds(), sum / 20000, 1e-6 * sum / 20000);
    std::int64_t count = 0;
    for (const auto n : histogram.octaves()) count += n;
    EXPECT_EQ(count, 20000);
}

}  // namespace
}  // namespace passung
