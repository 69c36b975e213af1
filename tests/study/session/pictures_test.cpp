#include <gtest/gtest.h>

#include "study/session/session.h"
#include "tests/study/session/scripted_session.h"

// What a trial owes to the pictures that the participant sees of it.

namespace passung::session {
namespace {

class PicturesTest : public SessionTest {
protected:
    /// One trial that succeeds, seen by `participant` with so many pictures, the oldest so old [µs].
    AttemptEnd seenBy(const std::string& participant, std::int64_t frames, double age_us) {
        planTrials({successScript()});
        Presentation given;
        given.frames = frames;
        given.frame_age_max_us = age_us;
        apparatus_.given = given;
        Session session({plan::FrozenPlan(plan_), trials_, participant, 7, false}, apparatus_, sink_, {});
        EXPECT_TRUE(session.run());
        return sink_.ends.at(0);
    }
};

TEST_F(PicturesTest, ATrialOfTwoPicturesDoesNotCount) {
    // Truth: closed form: 10 a second are asked for unless the protocol says otherwise, of 1.45 s 14 or one less.
    const AttemptEnd end = seenBy("P001", 2, 100e3);
    EXPECT_FALSE(end.valid);
    EXPECT_EQ(end.invalid_reason, "pictures: 1.4 a second, at least 10.0 count");
    EXPECT_EQ(end.outcome, Outcome::Success);
}

TEST_F(PicturesTest, ATrialWithAnOldPictureDoesNotCount) {
    // Truth: closed form.
    EXPECT_EQ(seenBy("P001", 40, 1.2e6).invalid_reason, "picture: up to 1200 ms old, at most 1000 ms count");
}

TEST_F(PicturesTest, EnoughYoungPicturesCount) {
    // Truth: closed form: 14 of 14.5 that are asked for: one more or less says nothing.
    const AttemptEnd end = seenBy("P001", 14, 999e3);
    EXPECT_TRUE(end.valid) << end.invalid_reason;
    EXPECT_EQ(end.health.presentation->frames, 14);
}

TEST_F(PicturesTest, TheProtocolSaysWhatCounts) {
    // Truth: invariant.
    plan_.view.max_picture_age = 0.25;
    plan_.view.min_pictures_per_s = 0.0;
    EXPECT_EQ(seenBy("P001", 0, 300e3).invalid_reason, "picture: up to 300 ms old, at most 250 ms count");
}

TEST_F(PicturesTest, NobodyLooksAtTheScreenOfASimulatedParticipant) {
    // Truth: invariant.
    EXPECT_TRUE(seenBy("S001", 2, 9e6).valid);
}

}  // namespace
}  // namespace passung::session
