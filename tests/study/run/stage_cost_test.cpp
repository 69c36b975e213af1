#include "study/run/machine/stage_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "core/scene/scene.h"

namespace passung::run {
namespace {

scene::SceneSpec pegOverPlate() {
    scene::SceneSpec spec;
    scene::PartSpec plate, peg;
    plate.name = "plate";
    plate.geometry = shape::Shape(shape::BorePlate{0.04, 0.04, 0.012, 0.022, 0.01, 0.001});
    peg.name = "peg";
    peg.held = true;
    peg.geometry = shape::Shape(shape::Peg{0.02, 0.02, 0.001});
    peg.X_WP.p = Vec3(0.004, 0.0, 0.008);
    spec.parts = {plate, peg};
    spec.contact.cell = 1e-3;
    spec.contact.spacing = 3e-3;
    return spec;
}

/// Keeps every processor busy.
class Load {
public:
    Load() {
        for (unsigned i = 0; i < 2 * std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads_.emplace_back([this] {
                while (!over_.load()) {
                }
            });
    }
    ~Load() {
        over_ = true;
        for (auto& thread : threads_) thread.join();
    }

private:
    std::atomic<bool> over_{false};
    std::vector<std::thread> threads_;
};

TEST(TickCost, IsOfThousandsOfTicksInContactAndOneVerdict) {
    // Truth: invariant (quantiles are in order; a stage is a part of the tick; a peg on a plate takes microseconds).
    scene::PartCache cache;
    const auto scene = scene::buildScene(pegOverPlate(), cache);
    ASSERT_TRUE(scene) << toString(scene.errors()[0]);
    const TickCost cost = measureTick(*scene);
    EXPECT_GE(cost.ticks, 2000);
    EXPECT_TRUE(cost.in_contact);
    EXPECT_GT(cost.median_us, 0.0);
    EXPECT_LE(cost.median_us, cost.p99_us);
    EXPECT_LE(cost.p99_us, cost.most_us);
    for (const StageCost& stage : cost.stages) EXPECT_LE(stage.p99_us, cost.most_us) << stage.name;
    TickCost slow = cost;
    EXPECT_TRUE(slow.fits());
    slow.p99_us = 1000.0;
    EXPECT_FALSE(slow.fits());
}

TEST(TickCost, TellsWhatATickAtTheCapOfItsWorkTakes) {
    // Truth: invariant: beyond the longest tick that did less, and the line through the ticks of a scene that works up
    // to its cap comes near what its longest ticks took. Closed forms have no cap.
    scene::PartCache cache;
    auto spec = pegOverPlate();
    spec.contact.method = scene::ContactMethod::GodObject;
    spec.contact.geometry = scene::Geometry::Surface;
    const auto scene = scene::buildScene(spec, cache);
    ASSERT_TRUE(scene) << toString(scene.errors()[0]);
    const TickCost cost = measureTick(*scene);
    EXPECT_EQ(cost.work_cap, 38000u);
    EXPECT_GT(cost.most_work, 0u);
    EXPECT_LE(cost.most_work, cost.work_cap);
    EXPECT_GT(cost.at_cap_us, cost.median_us);
    spec.contact.geometry = scene::Geometry::ClosedForm;
    const auto smooth = scene::buildScene(spec, cache);
    ASSERT_TRUE(smooth) << toString(smooth.errors()[0]);
    EXPECT_EQ(measureTick(*smooth).work_cap, 0u);
}

TEST(TickCost, DoesNotCountOtherPrograms) {
    // Truth: invariant (processor time of equal work): under a load that lets a thread wait for milliseconds in one
    // tick of a hundred the 99th percentile stays where it was. The factor is what shared caches may cost.
    scene::PartCache cache;
    const auto scene = scene::buildScene(pegOverPlate(), cache);
    ASSERT_TRUE(scene);
    const double quiet = measureTick(*scene).p99_us;
    const Load load;
    EXPECT_LT(measureTick(*scene).p99_us, 5.0 * quiet + 5.0);
}

}  // namespace
}  // namespace passung::run
