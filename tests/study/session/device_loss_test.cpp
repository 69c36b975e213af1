#include <gtest/gtest.h>

#include "tests/study/session/scripted_session.h"

/// What a session does when a device that lives as long as it is lost.
namespace passung::session {
namespace {

/// Loses its device at a tick of an attempt, once, and gets it back when the test says so.
class LosingApparatus : public ScriptedApparatus {
public:
    using ScriptedApparatus::ScriptedApparatus;

    int lose_at_poll = -1;  // of all polls; -1: never
    bool there = true, ready = true;

    void advance(std::int64_t ticks) override {
        ScriptedApparatus::advance(ticks);
        if (poll_++ != lose_at_poll) return;
        there = ready = false;
        news_.push_back({"device_lost", R"({"serial":"7"})", "right (haply 7): unplugged"});
    }
    void rearm() override {
        ScriptedApparatus::rearm();
        if (!there) return;
        ready = true;
        news_.push_back({"device_ready", "{}", ""});
    }
    std::vector<DeviceNews> takeDeviceNews() override { return std::exchange(news_, {}); }
    std::string deviceNotReady(bool or_there) const override {
        return ready || (or_there && there) ? "" : "right (haply 7) is lost: plug it in";
    }

private:
    int poll_ = 0;
    std::vector<DeviceNews> news_;
};

class DeviceLoss : public SessionTest {
protected:
    LosingApparatus losing_{log_};

    int count(const std::string& event) const {
        return static_cast<int>(
            std::count_if(sink_.events.begin(), sink_.events.end(), [&](const Event& e) { return e.event == event; }));
    }
};

TEST_F(DeviceLoss, PausesTheSessionAndRepeatsTheAttemptWhenItIsArmedAgain) {
    // Truth: invariant: an attempt on a lost device does not count, its trial is done again, nobody else arms a device.
    planTrials({successScript(), successScript()});
    losing_.scripts = {successScript(), successScript(), successScript()};
    losing_.lose_at_poll = 30;
    Session session({plan::FrozenPlan(plan_), trials_, "P001", 7, false}, losing_, sink_, {});
    ASSERT_TRUE(session.run());
    EXPECT_EQ(session.state(), SessionState::Paused);
    ASSERT_EQ(sink_.ends.size(), 1u);
    EXPECT_FALSE(sink_.ends[0].valid);
    EXPECT_EQ(sink_.ends[0].outcome, Outcome::Aborted);
    EXPECT_EQ(sink_.ends[0].invalid_reason, "device right (haply 7): unplugged");
    EXPECT_EQ(sink_.ends[0].then, Then::RepeatNow);
    EXPECT_EQ(count("device_lost"), 1);

    const Reply refused = session.command({CommandKind::Continue});
    EXPECT_EQ(refused.why, WhyNot::DeviceAway);
    EXPECT_EQ(refused.text, "right (haply 7) is lost: plug it in");
    losing_.there = true;
    ASSERT_TRUE(session.command({CommandKind::Continue}).accepted);
    ASSERT_TRUE(session.run());
    EXPECT_EQ(session.state(), SessionState::Complete);
    ASSERT_EQ(sink_.ends.size(), 3u);
    EXPECT_EQ(sink_.starts[1].trial_index, sink_.starts[0].trial_index);
    EXPECT_TRUE(sink_.ends[1].valid && sink_.ends[2].valid);
    EXPECT_EQ(count("device_lost"), 1);
    EXPECT_EQ(count("device_ready"), 1);
}

TEST_F(DeviceLoss, NoTrialBeginsOnADeviceThatIsNotReady) {
    // Truth: invariant.
    planTrials({successScript()});
    losing_.scripts = {successScript()};
    losing_.ready = false;
    Session session({plan::FrozenPlan(plan_), trials_, "P001", 7, false}, losing_, sink_, {});
    ASSERT_TRUE(session.run());
    EXPECT_EQ(session.state(), SessionState::Paused);
    EXPECT_TRUE(sink_.starts.empty());
    ASSERT_TRUE(session.command({CommandKind::Continue}).accepted);
    ASSERT_TRUE(session.run());
    EXPECT_EQ(session.state(), SessionState::Complete);
}

}  // namespace
}  // namespace passung::session
