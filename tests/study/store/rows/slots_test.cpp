#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "core/base/random.h"
#include "study/store/read/store_reader.h"
#include "tests/study/store/fake_study.h"

namespace passung::store {
namespace {

using fake::require;

/// 4 orders of method × clearance for each of two groups.
plan::StudyPlan twoGroups(int participants) {
    plan::StudyPlan plan = fake::makePlan();
    plan.participants = participants;
    plan.factors.push_back({"training", plan::FactorKind::Between, "", {{"none"}, {"long"}}});
    const auto half = plan.conditions;
    plan.conditions.clear();
    for (std::size_t i = 0; i < half.size(); ++i)
        for (std::size_t training = 0; training < 2; ++training) {
            plan.conditions.push_back(half[i]);
            plan.conditions.back().name += training == 0 ? "/none" : "/long";
            plan.conditions.back().levels = {i / 2, i % 2, training};
        }
    plan.expanded_json = R"({"name": "fake", "seed": )" + std::to_string(plan.seed) +
                         R"(, "groups": ["none", "long"], "allocation_blocks": 1, "sessions": 2})";
    return plan;
}

/// One session of the participant without trials; false: it does not complete.
void hold(Store& store, const plan::StudyPlan& plan, const std::string& sha, const std::string& code, bool complete) {
    SessionStart start;
    start.protocol_sha256 = sha;
    start.participant = code;
    start.ordinal = require(store.nextOrdinal(code));
    start.seed = plan.seed;
    start.session_id = sessionId(plan.name, code, start.ordinal, start.seed);
    start.device.name = "sigma7";
    const auto writer = require(store.createSession(start, {}));
    require(writer->finishSession(complete, 1000));
}

TEST(Slots, StayBalancedWhenThreeInTenDropOut) {
    // Truth: invariant: 32 people who complete fill 2 groups × 4 rows 4 times each, whoever left in between.
    const fake::TempFolder folder;
    const auto store = fake::openStore(folder / "s.db");
    const plan::StudyPlan plan = twoGroups(32);
    const std::string sha = require(store->importProtocol(plan));
    Random random(5);
    std::map<std::pair<std::size_t, std::int64_t>, int> completed;
    int done = 0, left = 0;
    for (std::int64_t number = 1; done < 32; ++number) {
        const std::string code = plan::participantCode(plan::ParticipantKind::Real, number);
        require(store->enrol(code, plan::ParticipantKind::Real, "2001-01-01T00:00:00.000Z"));
        const Slot slot = require(store->assignSlot(sha, code));
        const bool stays = random.uniform() >= 0.3;
        hold(*store, plan, sha, code, stays);
        if (stays) ++completed[{slot.group, slot.sequence_index}], ++done;
        left += stays ? 0 : 1;
    }
    EXPECT_GE(left, 5) << "else nothing was tested";
    EXPECT_EQ(completed.size(), 8u);
    for (const auto& [place, count] : completed) EXPECT_EQ(count, 4);
}

TEST(Slots, OfTwoStationsFillOneSquareTogether) {
    // Truth: closed form: 4 rows, two stations with two people each: every row once, and once more with two more each.
    const fake::TempFolder folder;
    const plan::StudyPlan plan = fake::makePlan();
    std::map<std::int64_t, int> rows;
    std::vector<std::unique_ptr<Store>> stores;
    for (const Station& station : {Station{"A", 0, 2}, Station{"B", 1, 2}}) {
        OpenOptions options = fake::options();
        options.station = station;
        stores.push_back(fake::openStore(folder / (station.name + ".db"), options));
    }
    for (int round = 1; round <= 4; ++round) {
        for (const auto& store : stores) {
            const std::string sha = require(store->importProtocol(plan));
            const std::string code = require(store->nextCode(plan::ParticipantKind::Real));
            require(store->enrol(code, plan::ParticipantKind::Real, "2001-01-01T00:00:00.000Z"));
            ++rows[require(store->assignSlot(sha, code)).sequence_index];
        }
        if (round % 2 == 0) {
            EXPECT_EQ(rows,
                      (std::map<std::int64_t, int>{{0, round / 2}, {1, round / 2}, {2, round / 2}, {3, round / 2}}));
        }
    }
}

TEST(Slots, OfSeveralStationsStayBalancedWhenThreeInTenDropOut) {
    // Truth: invariant. A station fills its own passes through the 2 groups × 4 rows, one after another: no two people
    // who complete have one place, whoever enrols where in between; a station leaves at most its running pass open, so
    // that no order has more than one completed session per station more than another; and none once all are full.
    const plan::StudyPlan plan = twoGroups(48);
    for (const int stations : {2, 3, 5}) {
        const fake::TempFolder folder;
        std::vector<std::unique_ptr<Store>> stores;
        for (int i = 0; i < stations; ++i) {
            OpenOptions options = fake::options();
            options.station = {std::string(1, static_cast<char>('A' + i)), i, stations};
            stores.push_back(fake::openStore(folder / (options.station.name + ".db"), options));
        }
        Random random(static_cast<std::uint64_t>(stations));
        std::map<std::pair<std::size_t, std::int64_t>, int> completed;
        for (std::size_t group = 0; group < 2; ++group)
            for (std::int64_t row = 0; row < 4; ++row) completed[{group, row}] = 0;
        std::set<std::pair<std::size_t, std::int64_t>> places;
        std::vector<int> done(stores.size());
        int left = 0, worst = 0;
        const auto imbalance = [&] {
            const auto [least, most] = std::minmax_element(
                completed.begin(), completed.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
            return most->second - least->second;
        };
        while (std::any_of(done.begin(), done.end(), [](int people) { return people < 16; })) {
            const auto station = static_cast<std::size_t>(random.below(stores.size()));
            if (done[station] == 16) continue;
            Store& store = *stores[station];
            const std::string sha = require(store.importProtocol(plan));
            const std::string code = require(store.nextCode(plan::ParticipantKind::Real));
            require(store.enrol(code, plan::ParticipantKind::Real, "2001-01-01T00:00:00.000Z"));
            const Slot slot = require(store.assignSlot(sha, code));
            const bool stays = random.uniform() >= 0.3;
            hold(store, plan, sha, code, stays);
            left += stays ? 0 : 1;
            if (!stays) continue;
            ++done[station], ++completed[{slot.group, slot.sequence_index}];
            EXPECT_TRUE(places.insert({slot.group, slot.number}).second) << code << " has somebody else's place";
            worst = std::max(worst, imbalance());
        }
        EXPECT_GE(left, 5) << "else nothing was tested";
        EXPECT_LE(worst, stations);
        EXPECT_EQ(imbalance(), 0);
        std::printf("%d stations: %d of %d left; largest imbalance on the way %d, at the end %d\n", stations, left,
                    left + 16 * stations, worst, imbalance());
    }
}

TEST(Slots, AreKeptOverAParticipantsSessions) {
    // Truth: invariant: two sessions, one person, one row; the second may fail and be done again.
    const fake::TempFolder folder;
    const plan::StudyPlan plan = twoGroups(8);
    const std::string code = "P001";
    Slot slot;
    std::string sha;
    {
        const auto store = fake::openStore(folder / "s.db");
        sha = require(store->importProtocol(plan));
        require(store->enrol(code, plan::ParticipantKind::Real, "2001-01-01T00:00:00.000Z"));
        slot = require(store->assignSlot(sha, code));
        EXPECT_EQ(require(store->nextPart(sha, code)), 1);
        hold(*store, plan, sha, code, true);
        EXPECT_EQ(require(store->nextPart(sha, code)), 2);
        hold(*store, plan, sha, code, false);
    }
    const auto store = fake::openStore(folder / "s.db");
    const Slot again = require(store->assignSlot(sha, code));
    EXPECT_EQ(again.number, slot.number);
    EXPECT_EQ(again.group, slot.group);
    EXPECT_EQ(require(store->nextPart(sha, code)), 2);
    EXPECT_EQ(require(require(StoreReader::open(folder / "s.db")).participants())[0].status, "enrolled");
    hold(*store, plan, sha, code, true);
    EXPECT_EQ(require(require(StoreReader::open(folder / "s.db")).participants())[0].status, "complete");
    EXPECT_FALSE(store->assignSlot(sha, code)) << "nobody takes part twice";
}

}  // namespace
}  // namespace passung::store
