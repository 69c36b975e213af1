#include "core/loop/haptic_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "core/base/random.h"
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
    return test::Bench(test::scene(model::Sphere{0.02}, {Quat::Identity(), Vec3(0, 0, 0.012)},
                                   model::Box{0.06, 0.06, 0.02}, {Quat::Identity(), Vec3(0, 0, -0.01)},
                                   model::ContactMethod::GodObjectHeuristic));
}
const Pose kPressed{Quat::Identity(), Vec3(0, 0, 0.008)};

TEST(HapticCycle, RecordsEveryTickAndShowsSixtyImagesASecond) {
    // Truth: closed form (60 of 1000 ticks) and invariant.
    test::Bench bench = ballInTable();
    StillDevice device(kPressed);
    loop::RecordRing ring(2048);
    loop::HapticCycle cycle(bench.model(), device, ring, true);
    for (int i = 0; i < 1000; ++i) cycle.run(i == 500);
    std::vector<TickRecord> records(2048);
    records.resize(ring.take(records));
    ASSERT_EQ(records.size(), 1000u);
    for (std::size_t i = 0; i < records.size(); ++i) {
        EXPECT_EQ(records[i].tick, static_cast<std::int64_t>(i));
        EXPECT_EQ((records[i].status & kOverrun) != 0, i == 500);
    }
    EXPECT_EQ(device.images, 60);
    EXPECT_NEAR(device.last_image.X_WShown.p.z(), 0.01, 1e-4);  // the proxy
    EXPECT_NEAR(records.back().force_N[2], static_cast<float>(device.last.force.z()), 1e-6f);
    EXPECT_EQ(cycle.timing().count(), 1000);
    cycle.release();
    EXPECT_EQ(device.last.force.norm(), 0.0);
}

TEST(HapticCycle, AllocatesLocksAndWritesNothing) {
    // Truth: invariant, counted by interposed functions; the cycle reads the clock, nothing else.
    if (!support::RtGuard::available()) GTEST_SKIP() << "the sanitizer owns the interposed functions";
    test::Bench bench = ballInTable();
    StillDevice device(kPressed);
    loop::RecordRing ring(1024);  // fills up: dropping must be as quiet
    loop::HapticCycle cycle(bench.model(), device, ring, true);
    support::RtGuard guard;
    for (int i = 0; i < 10000; ++i) cycle.run(false);
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
    EXPECT_EQ(ring.dropped(), 10000 - 1024);
}

TEST(RealTimeThread, RunsCyclesAndStopsWithAZeroWrench) {
    // Truth: invariant; no deadline is asserted. Also run under TSan: records are read while the thread runs.
    test::Bench bench = ballInTable();
    StillDevice device(kPressed);
    loop::RecordRing ring(4096);
    loop::HapticCycle cycle(bench.model(), device, ring, true);
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
