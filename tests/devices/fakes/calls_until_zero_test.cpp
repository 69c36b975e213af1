#include "tests/devices/fakes/calls_until_zero.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

#include "tests/devices/fakes/dhd_block.h"

namespace passung {
namespace {

std::optional<std::int64_t> count(const std::vector<double>& forces, std::int64_t from) {
    return fake::callsUntilZero(static_cast<std::int64_t>(forces.size()), from,
                                [&](std::int64_t i) { return forces[static_cast<std::size_t>(i)] == 0.0; });
}

TEST(CallsUntilZero, NamesTheFirstCallThatIsZeroForGood) {
    // Truth: closed form, counted by hand.
    EXPECT_EQ(count({5, 5, 0, 0}, 2), 1);
    EXPECT_EQ(count({5, 5, 5, 0}, 2), 2);
    EXPECT_EQ(count({5, 5, 0, 5, 0, 0}, 2), 3) << "a zero that does not last is none";
    EXPECT_EQ(count({5, 5, 5}, 2), std::nullopt);
    EXPECT_EQ(count({5, 5}, 2), std::nullopt) << "what was commanded last stands";
    EXPECT_EQ(count({5, 0}, 2), 0);
    EXPECT_EQ(count({}, 0), 0);
    EXPECT_EQ(count({0, 0, 0}, 0), 1);
    EXPECT_EQ(count({5, 0, 0}, 0), 2);
}

TEST(CallsUntilZero, LooksAtEveryComponentThatTheDeviceFeels) {
    // Truth: closed form, counted by hand.
    const auto ring = std::make_unique<fake::SharedRing<fake::DhdCommand>>();
    fake::DhdCommand command;
    command.felt[0] = 1.0;
    ring->push(command);
    command = {};
    command.asked[0] = 1.0;  // asked for, not felt
    command.felt[5] = 1e-300;
    ring->push(command);
    command.felt[5] = 0.0;
    ring->push(command);
    EXPECT_EQ(fake::callsUntilZero(*ring, 1), 2);
    command.felt[6] = std::numeric_limits<double>::quiet_NaN();
    ring->push(command);
    EXPECT_EQ(fake::callsUntilZero(*ring, 1), std::nullopt);
}

}  // namespace
}  // namespace passung
