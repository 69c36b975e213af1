#include "study/design/allocation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "core/base/random.h"

namespace passung::design {
namespace {

std::vector<std::size_t> groupsOf(const std::vector<Place>& places) {
    std::vector<std::size_t> groups;
    for (const Place& place : places) groups.push_back(place.group);
    return groups;
}

TEST(Allocation, DrawsPermutedBlocksOfEachStratum) {
    // Truth: independent program (integer arithmetic in Python 3.11 from the definition of the streams).
    const Allocation three{3, 4, 1, "demo", 42};
    EXPECT_EQ(groupsOf(placesOf(three, "real", 0)), (std::vector<std::size_t>{1, 0, 2, 2, 0, 1, 2, 0, 1, 2, 1, 0}));
    EXPECT_EQ(groupsOf(placesOf(three, "simulated", 0)),
              (std::vector<std::size_t>{2, 0, 1, 2, 1, 0, 0, 1, 2, 2, 0, 1}));
    EXPECT_EQ(groupsOf(placesOf({2, 2, 2, "demo", 42}, "real", 0)), (std::vector<std::size_t>{1, 0, 1, 0, 1, 0, 0, 1}));
}

TEST(Allocation, OneGroupTakesTheRowsInOrder) {
    // Truth: closed form: what a study without between factors always did.
    const auto places = firstPlaces({1, 3, 1, "demo", 42}, "real", 5);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(places[i], (Place{0, i % 3, i / 3}));
}

TEST(Allocation, GroupsAreEvenAfterEveryBlock) {
    // Truth: invariant: blocks of 2 × 3 places; every row of every group once in a replicate.
    const Allocation allocation{3, 5, 2, "demo", 9};
    std::map<std::size_t, int> counts;
    std::set<std::array<std::size_t, 3>> rows;
    const auto places = firstPlaces(allocation, "real", 60);
    for (std::size_t i = 0; i < places.size(); ++i) {
        ++counts[places[i].group];
        rows.insert({places[i].group, places[i].sequence, places[i].replicate});
        if (i % 6 == 5) {
            for (std::size_t group = 0; group < 3; ++group) EXPECT_EQ(counts[group], static_cast<int>(i + 1) / 3);
        }
    }
    EXPECT_EQ(rows.size(), 60u);
}

}  // namespace
}  // namespace passung::design
