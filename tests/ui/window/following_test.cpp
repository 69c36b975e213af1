#include <filesystem>
#include <fstream>

#include "tests/support/count_checks.h"
#include "tests/ui/cli/small_study.h"
#include "tests/ui/window/four_trials.h"
#include "tests/ui/window/windows.h"

// Pages and commands that follow a running session.

namespace passung::test {
namespace {

namespace state = presenter::state;

class Following : public Windows {
protected:
    void SetUp() override {
        protocols_ = folder_ / "studies";
        std::filesystem::create_directories(protocols_ + "/small");
        std::ofstream(protocols_ + "/small/study.toml") << smallStudy() << kOnAnyMachine;
        warnings.clear();
    }
};

TEST_F(Following, AFileThatWasWholeIsNotSearchedForDamageAfterEachTrial) {
    // Truth: independent program (SQLite tells each statement that it runs); the page shows the trials all the same.
    const CountChecks checks;
    open("en", true);
    click("study-small");
    app_->records().setProperty("source", 1);  // try-outs
    click("watch");
    waitFor<state::Running>();
    settle();
    const int begun = checks.count();
    EXPECT_GT(begun, 0);
    const auto ended = [&](std::size_t row) { return run().view().rows[row].attempts > 0; };
    waitFor([&] { return ended(0) && ended(1) && app_->records().attempts().size() >= 2; });
    settle();
    ASSERT_TRUE(run().view().isRunning()) << "the study was over too soon to say anything";
    EXPECT_EQ(checks.count(), begun);
}

TEST_F(Following, WhatTheSessionWouldRefuseIsNotOfferedAndSaysWhy) {
    // Truth: invariant: the session's own reason.
    open("en", true);
    click("study-small");
    click("watch");
    waitFor<state::Running>();
    click("pause");
    waitFor<state::Paused>();
    ASSERT_TRUE(item(app_->experimenter(), "repeat")->isEnabled());
    click("repeat");
    waitFor([&] { return !item(app_->experimenter(), "repeat")->isEnabled(); });
    EXPECT_EQ(item(app_->experimenter(), "repeat")->property("why").toString(), "The trial is repeated already.");
}

}  // namespace
}  // namespace passung::test
