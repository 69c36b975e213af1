#include "study/plan/participant.h"

#include <gtest/gtest.h>

namespace passung::plan {
namespace {

TEST(Participant, CodesBeginWithTheKindsLetterAndGrowBeyondThreeDigits) {
    // Truth: closed form (the documented pattern)
    EXPECT_EQ(participantCode(ParticipantKind::Real, 1), "P001");
    EXPECT_EQ(participantCode(ParticipantKind::Simulated, 42), "S042");
    EXPECT_EQ(participantCode(ParticipantKind::Pilot, 1000), "T1000");
}

TEST(Participant, CodesThatCouldLeaveAFolderOrNameAPersonAreRefused) {
    // Truth: invariant (a code names files)
    for (const char* good : {"P001", "A1", "GROUP-B_7"}) EXPECT_TRUE(isParticipantCode(good)) << good;
    for (const char* bad : {"", "P", "p001", "P00a", "1P1", "P/../1", "P 1", "Müller1", "Anna1"}) {
        EXPECT_FALSE(isParticipantCode(bad)) << bad;
    }
}

TEST(Participant, EachKindRehearsesThePersonOfItsNumber) {
    // Truth: closed form (the letter of people in place of the kind's)
    EXPECT_EQ(rehearsedCode("S001"), "P001");
    EXPECT_EQ(rehearsedCode("TB012"), "PB012");
    EXPECT_EQ(rehearsedCode("P007"), "P007");
    EXPECT_EQ(rehearsedCode(""), "");
}

TEST(Participant, KindsAreNamedAsTheDatabaseAllowsThem) {
    // Truth: closed form (the schema's CHECK)
    EXPECT_EQ(participantKindNames(), (std::vector<std::string>{"real", "pilot", "simulated"}));
}

}  // namespace
}  // namespace passung::plan
