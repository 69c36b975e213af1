#include "tests/study/session/scripted_session.h"

// What a person who sits there has a say in: commands while they read, and rests that somebody ends.

namespace passung::session {
namespace {

/// Reads without end, and rests as long as it is told to.
class SlowReader : public InstructionReader {
public:
    std::optional<PageRead> read(const Page& page) override {
        shown = page.instruction.text;
        return std::nullopt;
    }
    bool goesOn() override {
        ++asked;
        return rested;
    }

    std::string shown;
    bool rested = false;
    int asked = 0;
};

class Between : public SessionTest {
protected:
    void begin(std::vector<int> blocks, bool waits = false) {
        planTrials(std::vector<Records>(blocks.size(), successScript()));
        plan_.blocks = {{.name = "first"}, {.name = "second", .rest = 0.2}};
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            trials_[i].block_index = blocks[i];
            trials_[i].block = plan_.blocks[static_cast<std::size_t>(blocks[i])].name;
            trials_[i].trial_in_block = i > 0 && blocks[i] == blocks[i - 1] ? 1 : 0;
        }
        plan_.blocks[1].rest_ends = rest_ends_;
        SessionSetup setup{plan::FrozenPlan(plan_), trials_, "P001", 7, true};
        setup.waits = waits;
        setup.reader = &reader_;
        session_.emplace(std::move(setup), apparatus_, sink_, SessionListener{});
        if (waits) {
            EXPECT_TRUE(session_->command({.kind = CommandKind::Start}).accepted);
        }
    }
    /// Until the next trial runs, or so many calls.
    void advanceToTrial(int most = 2000) {
        while (most-- > 0 && session_->state() != SessionState::InTrial && !session_->isOver()) session_->advance();
    }
    void finishTrial() {
        while (session_->state() == SessionState::InTrial) session_->advance();
    }
    SlowReader reader_;
    plan::RestEnds rest_ends_ = plan::RestEnds::ByTime;
    std::optional<Session> session_;
};

TEST_F(Between, CommandsAreObeyedWhileSomebodyReads) {
    // Truth: invariant
    plan_.instructions = {{plan::ShowAt::SessionStart, "", "welcome", ""}};
    begin({0, 0});
    session_->advance();
    EXPECT_TRUE(session_->command({.kind = CommandKind::Stop}).accepted);
    EXPECT_EQ(session_->advance(), SessionState::Paused);
    EXPECT_TRUE(session_->command({.kind = CommandKind::Continue}).accepted);
    session_->advance();
    EXPECT_EQ(reader_.shown, "welcome");
    EXPECT_TRUE(session_->command({.kind = CommandKind::Abort}).accepted);
    EXPECT_EQ(session_->state(), SessionState::Interrupted);
}

TEST_F(Between, TheParticipantEndsARestButNotBeforeItsLeastTime) {
    // Truth: closed form: 200 periods of rest, then as often as it is asked.
    rest_ends_ = plan::RestEnds::ByParticipant;
    reader_.rested = true;  // would go on at once
    begin({0, 1});
    advanceToTrial();
    finishTrial();
    session_->advance();
    EXPECT_EQ(apparatus_.waited_ticks, 100);
    EXPECT_EQ(session_->view().rest, (RestView{1, plan::RestEnds::ByParticipant}));
    EXPECT_EQ(reader_.asked, 0);
    reader_.rested = false;
    for (int i = 0; i < 30; ++i) session_->advance();
    EXPECT_EQ(session_->view().rest, (RestView{0, plan::RestEnds::ByParticipant}));
    EXPECT_EQ(apparatus_.waited_ticks, 200);
    EXPECT_EQ(sink_.starts.size(), 1u);
    reader_.rested = true;
    advanceToTrial();
    EXPECT_EQ(sink_.starts.size(), 2u);
    EXPECT_EQ(session_->view().rest, std::nullopt);
}

TEST_F(Between, TheExperimenterEndsARestByContinue) {
    // Truth: invariant; without anybody who commands it ends by its time.
    rest_ends_ = plan::RestEnds::ByExperimenter;
    begin({0, 1}, true);
    advanceToTrial();
    finishTrial();
    for (int i = 0; i < 10; ++i) session_->advance();
    EXPECT_EQ(session_->state(), SessionState::Paused);
    EXPECT_TRUE(session_->command({.kind = CommandKind::Continue}).accepted);
    advanceToTrial();
    EXPECT_EQ(sink_.starts.size(), 2u);
    EXPECT_EQ(sink_.events.back().event, "rest_ended");
}

}  // namespace
}  // namespace passung::session
