#include "study/store/schema/identity.h"

#include <gtest/gtest.h>

#include <set>

#include "study/plan/participant.h"
#include "study/store/schema/utc_clock.h"

namespace passung::store {
namespace {

TEST(Identity, SessionsOfDifferentPeopleOrdinalsAndSeedsDiffer) {
    // Truth: invariant
    std::set<std::string> ids;
    for (const char* study : {"a", "b"}) {
        for (int person = 1; person <= 50; ++person) {
            for (int ordinal = 1; ordinal <= 3; ++ordinal) {
                for (const std::uint64_t seed : {0u, 1u, 2u}) {
                    const auto code = plan::participantCode(plan::ParticipantKind::Real, person);
                    const std::string id = sessionId(study, code, ordinal, seed);
                    EXPECT_EQ(id, sessionId(study, code, ordinal, seed));
                    EXPECT_EQ(id.size(), 16u);
                    ids.insert(id);
                }
            }
        }
    }
    EXPECT_EQ(ids.size(), 2u * 50u * 3u * 3u);
}

TEST(UtcClock, VirtualTimeBeginsWithTheYear2000) {
    // Truth: closed form (calendar)
    EXPECT_EQ(UtcClock::virtualEpoch().at(0), "2000-01-01T00:00:00.000Z");
    EXPECT_EQ(UtcClock::virtualEpoch().at(3'661'250'999'999), "2000-01-01T01:01:01.250Z");
    EXPECT_EQ(UtcClock::virtualEpoch().at((31 + 28) * 86'400'000'000'000), "2000-02-29T00:00:00.000Z");
}

TEST(UtcClock, WallTimeIsUtc) {
    // Truth: independent program (GNU date -u -d @1709210096: 2024-02-29T12:34:56)
    EXPECT_EQ(UtcClock::wall(1'709'210'096'789).at(0), "2024-02-29T12:34:56.789Z");
}

}  // namespace
}  // namespace passung::store
