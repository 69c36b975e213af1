#include "study/session/instruction_course.h"

#include "tests/study/session/scripted_session.h"

namespace passung::session {
namespace {

using plan::ShowAt;

/// Reads a page at the third look at it and remembers what it was shown.
class SlowReader : public InstructionReader {
public:
    std::vector<std::string> texts, pictures;
    bool reads = true;

    std::optional<PageRead> read(const Page& page) override {
        if (id_ != page.id) {
            id_ = page.id;
            looks_ = 0;
            texts.push_back(page.text);
            pictures.push_back(page.picture);
        }
        if (++looks_ < 3 || !reads) return std::nullopt;
        return PageRead{"participant", 1234};
    }

private:
    std::string id_;
    int looks_ = 0;
};

/// Two trials, each a block of its own, and a page before the first, before each block and at the end.
class InstructionDeskTest : public SessionTest {
protected:
    InstructionDeskTest() {
        plan_.blocks = {{.name = "first"}, {.name = "second"}};
        plan_.languages = {"en", "de"};
        plan_.texts = {{"hello", {{"en", "Hello"}, {"de", "Hallo"}}},
                       {"first", {{"en", "First"}, {"de", "Erster"}}},
                       {"second", {{"en", "Second"}, {"de", "Zweiter"}}},
                       {"thanks", {{"en", "Thanks"}, {"de", "Danke"}}}};
        plan_.instructions = {{ShowAt::SessionEnd, "", "thanks", ""},
                              {ShowAt::SessionStart, "", "hello", "task.png"},
                              {ShowAt::BeforeBlock, "second", "second", ""},
                              {ShowAt::BeforeBlock, "first", "first", ""}};
        plan_.pictures = {{"task.png", "study/task.png"}};
        planTrials({successScript(), successScript()});
        for (std::size_t i = 0; i < trials_.size(); ++i) {
            trials_[i].block_index = static_cast<std::int64_t>(i);
            trials_[i].block = plan_.blocks[i].name;
        }
    }
    SessionSetup setup(InstructionReader* reader, const std::string& language, bool timing_measured) {
        SessionSetup with{plan::FrozenPlan(plan_), trials_, "P001", 7, timing_measured};
        with.language = language;
        with.reader = reader;
        return with;
    }
    std::vector<Event> instructions() const {
        std::vector<Event> events;
        for (const Event& event : sink_.events)
            if (event.event.starts_with("instruction")) events.push_back(event);
        return events;
    }
};

TEST_F(InstructionDeskTest, TrialsWaitUntilEveryPageBeforeThemIsRead) {
    // Truth: closed form: the plan's pages by moment and block; the third look reads one.
    SlowReader reader;
    reader.reads = false;
    Session session(setup(&reader, "de", true), apparatus_, sink_, {});
    for (int look = 0; look < 10; ++look) EXPECT_EQ(session.advance(), SessionState::BetweenTrials);
    EXPECT_TRUE(sink_.starts.empty()) << "the first page is open";
    EXPECT_EQ(reader.texts, std::vector<std::string>{"Hallo"});
    reader.reads = true;
    ASSERT_TRUE(session.run());
    EXPECT_EQ(reader.texts, (std::vector<std::string>{"Hallo", "Erster", "Zweiter", "Danke"}));
    EXPECT_EQ(reader.pictures, (std::vector<std::string>{"study/task.png", "", "", ""}));
    EXPECT_EQ(sink_.starts.size(), 2u);
    EXPECT_TRUE(sink_.complete.value_or(false));
    const auto events = instructions();
    ASSERT_EQ(events.size(), 4u);
    EXPECT_EQ(events[0].source, "participant");
    EXPECT_EQ(events[0].payload_json,
              R"({"moment":"session_start","text":"hello","picture":"task.png","language":"de","reading_ms":1234})");
}

TEST_F(InstructionDeskTest, PagesThatNobodyShowsAreNotLoggedAsRead) {
    // Truth: invariant: without a reader nobody has read anything.
    Session session(setup(nullptr, "en", true), apparatus_, sink_, {});
    ASSERT_TRUE(session.run());
    const auto events = instructions();
    ASSERT_EQ(events.size(), 4u);
    for (const Event& event : events) {
        EXPECT_EQ(event.event, "instruction_not_shown");
        EXPECT_EQ(event.source, "session");
    }
}

TEST_F(InstructionDeskTest, NoReadingTimeIsKeptInVirtualTime) {
    // Truth: invariant: no measured duration reaches the data of virtual time.
    SlowReader reader;
    Session session(setup(&reader, "en", false), apparatus_, sink_, {});
    ASSERT_TRUE(session.run());
    for (const Event& event : instructions()) EXPECT_EQ(event.payload_json.find("reading_ms"), std::string::npos);
}

TEST_F(InstructionDeskTest, AnOpenPageGivesWayToThatOfTheTrialThatComesInstead) {
    // Truth: invariant: who skips the first block's trial must not be told of that block.
    SlowReader reader;
    reader.reads = false;
    plan_.instructions.erase(plan_.instructions.begin() + 1);
    Session session(setup(&reader, "en", true), apparatus_, sink_, {});
    session.advance();
    EXPECT_TRUE(session.command({.kind = CommandKind::Skip}).accepted);
    session.advance();
    EXPECT_EQ(reader.texts, (std::vector<std::string>{"First", "Second"}));
}

TEST_F(InstructionDeskTest, ASessionEndsWithoutTheLastPageIfItIsInterruptedThere) {
    // Truth: invariant: what was to be done is done; a page that nobody acknowledged is not logged as read.
    SlowReader reader;
    Session session(setup(&reader, "en", true), apparatus_, sink_, {});
    while (reader.texts.empty() || reader.texts.back() != "Thanks") session.advance();
    session.interrupt("the window was closed");
    EXPECT_EQ(session.state(), SessionState::Complete);
    EXPECT_EQ(instructions().size(), 3u);
}

}  // namespace
}  // namespace passung::session
