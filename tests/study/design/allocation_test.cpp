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

/// How often each row is met by the first `each` participants of every one of so many stations.
std::vector<int> rowCounts(const std::vector<std::size_t>& rows, std::size_t stations, std::size_t each) {
    std::size_t all = 1;
    for (const std::size_t count : rows) all *= count;
    std::vector<int> counts(all);
    for (std::size_t index = 0; index < stations; ++index) {
        const Share share{index, stations};
        for (const Place& place : firstPlaces({1, all, 1, "demo", 42}, "real", each, share, firstRow(rows, share))) {
            ++counts[place.sequence];
            EXPECT_EQ(place.replicate % stations, index);
        }
    }
    return counts;
}

TEST(Allocation, StationsMeetAllRowsAsEvenlyAsTheirNumberAllows) {
    // Truth: closed form: equally many at each station; rows then differ by at most one, and by none at multiples.
    for (std::size_t rows = 2; rows <= 20; ++rows)
        for (std::size_t stations = 1; stations <= 8; ++stations)
            for (std::size_t each = 1; each <= 2 * rows; ++each) {
                const auto counts = rowCounts({rows}, stations, each);
                const auto [low, high] = std::minmax_element(counts.begin(), counts.end());
                EXPECT_LE(*high - *low, each * stations % rows == 0 ? 0 : 1) << rows << " " << stations << " " << each;
            }
}

TEST(Allocation, StationsBeginEverySquareOfSeveralWithAnotherRow) {
    // Truth: closed form: of 4 x 2 rows two stations with two each take rows 0, 1 and 2, 3 of the first square, and row
    // 0 and 1 of the second.
    EXPECT_EQ(rowCounts({4, 2}, 2, 2), (std::vector<int>{1, 1, 0, 0, 0, 0, 1, 1}));
    EXPECT_EQ(rowCounts({4, 2}, 2, 8), std::vector<int>(8, 2));
}

TEST(Allocation, OneStationBeginsWithTheFirstRow) {
    // Truth: closed form: what a study at one place always did.
    EXPECT_EQ(firstRow(std::vector<std::size_t>{4, 3}, {}), 0u);
    EXPECT_EQ(firstPlaces({3, 4, 1, "demo", 42}, "real", 12), placesOf({3, 4, 1, "demo", 42}, "real", 0));
}

}  // namespace
}  // namespace passung::design
