#include <gtest/gtest.h>

#include <QtGui/QImage>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "study/store/read/store_reader.h"
#include "tests/ui/cli/small_study.h"
#include "tests/ui/window/windows.h"

// A try-out of a study: the scene that follows the mouse, the console's keys, both languages.

namespace passung::test {
namespace {

namespace state = presenter::state;

TEST_F(Windows, TwoClicksLeadToARunningTrialThatTheMouseMoves) {
    // Truth: invariant. The part on the participant's screen goes where it is dragged, and the stored attempts follow
    // the experimenter's commands.
    picture(app_->experimenter(), "studies");
    click("study-peg_in_hole");
    click("tryOut");
    waitFor<state::Running>();
    QQuickWindow* participant = app_->participant();
    waitFor([&] { return participant->isExposed() && participant->isActive(); });

    const QImage before = picture(participant, "participant");
    const QPointF held = heldPart(before);
    ASSERT_GT(held.x(), 0.0) << "the held part is not drawn";
    EXPECT_GT(pixelsLike(before, QColor("#56b4e9"), 40), 100) << "the target's ring is not drawn";

    const double x0 = static_cast<double>(run().last()->hand_position_m[0]);
    dragUntil(Qt::LeftButton, held.toPoint(), {-8, 0},
              [&] { return static_cast<double>(run().last()->hand_position_m[0]) < x0 - 0.005; });
    const QPointF moved = heldPart(picture(participant, "participant_moved"));
    EXPECT_LT(moved.x(), held.x() - 15.0);

    const auto turn = [&] {
        const auto& q = run().last()->hand_quaternion;
        return 2.0 * std::acos(std::min(1.0, std::abs(static_cast<double>(q[0]))));
    };
    dragUntil(Qt::RightButton, held.toPoint(), {0, 4}, [&] { return turn() > 0.1; });

    // Pressed down by a key until the plate pushes back: the arrow says so.
    QTest::keyPress(participant, Qt::Key_Down);
    waitFor([&] { return app_->screen().arrow() && run().view().force_N > 1.0; });
    const QImage pressed = picture(participant, "participant_contact");
    EXPECT_GT(pixelsLike(pressed, QColor("#d55e00"), 20), 60) << "the force is not drawn";
    const QImage console = picture(app_->experimenter(), "session");
    QTest::keyRelease(participant, Qt::Key_Down);
    EXPECT_GT(heldPart(console.copy(380, 160, 660, 420)).x(), 0.0) << "the mirror shows no held part";
}

TEST_F(Windows, KeysStopContinueAndLeaveOutTrialsInEitherLanguage) {
    // Truth: invariant. What the state line says is what the session does.
    click("study-peg_in_hole");
    click("watch");
    waitFor<state::Running>();
    app_->experimenter()->requestActivate();
    waitFor([&] { return app_->experimenter()->isActive(); });
    waitFor([&] { return run().last()->tick > 500; });  // of the five seconds that the trial takes
    picture(app_->experimenter(), "session_watched");
    pressKey(Qt::Key_Escape);
    waitFor<state::Stopped>();
    const QImage stopped = picture(app_->experimenter(), "session_stopped");
    EXPECT_GT(pixelsLike(stopped.copy(20, 60, 12, 120), app_->look().bad()), 300) << "the state line is not marked";
    EXPECT_EQ(run().view().rows[0].state, presenter::RowState::Next);
    EXPECT_EQ(run().view().rows[0].attempts, 1);
    const auto stored = store::StoreReader::open(folder_ / "data/peg_in_hole.db");
    ASSERT_TRUE(stored);
    const auto attempts = stored->attempts();
    ASSERT_TRUE(attempts);
    const auto presentation = attempts->at(0).presentation;
    ASSERT_TRUE(presentation);
    EXPECT_EQ(presentation->drawn_pose, "proxy");
    EXPECT_GT(presentation->frames, 0);
    EXPECT_GT(presentation->frame_age_median_us, 0.0);
    EXPECT_GE(presentation->frame_age_p99_us, presentation->frame_age_median_us);
    EXPECT_GE(presentation->frame_age_max_us, presentation->frame_age_p99_us);
    EXPECT_EQ(presentation->sound, "none") << "the study has nothing to be heard";

    click("language");
    EXPECT_EQ(item(app_->experimenter(), "stateLine")->property("text").toString(), "Not-Halt: Motoren sind aus");
    click("theme");
    EXPECT_GT(pixelsLike(picture(app_->experimenter(), "session_stopped_de_light"), app_->look().panel(), 4), 200'000);

    pressKey(Qt::Key_K, Qt::ControlModifier);
    waitFor([&] { return run().view().rows[0].state == presenter::RowState::Skipped; });
    pressKey(Qt::Key_P, Qt::ControlModifier);
    waitFor<state::Running>();
    EXPECT_EQ(run().view().number, 2);
    picture(app_->participant(), "participant_de_light");
    click("page-studies");
    picture(app_->experimenter(), "studies_de_light");
}

TEST_F(Windows, AWindowThatNobodySeesPausesTheTrialAndComesBackWithoutLosingIt) {
    // Truth: invariant. The attempt that nobody saw is aborted, its trial is done again; a key that was held when the
    // window went away is no longer held.
    click("study-peg_in_hole");
    click("tryOut");
    waitFor<state::Running>();
    QQuickWindow* participant = app_->participant();
    waitFor([&] { return participant->isExposed() && participant->isActive(); });
    QTest::keyPress(participant, Qt::Key_Left);
    const double x0 = static_cast<double>(run().last()->hand_position_m[0]);
    waitFor([&] { return static_cast<double>(run().last()->hand_position_m[0]) < x0 - 0.002; });
    EXPECT_EQ(item(app_->experimenter(), "openDisplay"), nullptr);
    participant->close();
    waitFor<state::Paused>();
    EXPECT_FALSE(participant->isVisible());
    EXPECT_EQ(run().view().rows[0].attempts, 1);
    EXPECT_EQ(run().view().rows[0].state, presenter::RowState::Next);
    EXPECT_EQ(item(app_->experimenter(), "stateLine")->property("text").toString(),
              "Paused: the participant's window is closed");
    picture(app_->experimenter(), "session_window_closed");

    click("openDisplay");
    waitFor([&] { return participant->isExposed(); });
    EXPECT_TRUE(run().view().is<state::Paused>()) << "only the experimenter goes on";
    EXPECT_EQ(item(app_->experimenter(), "openDisplay"), nullptr);
    click("pause");
    waitFor<state::Running>();
    const double x1 = static_cast<double>(run().last()->hand_position_m[0]);
    const std::int64_t tick = run().last()->tick;
    waitFor([&] { return run().last()->tick > tick + 500; });
    EXPECT_NEAR(static_cast<double>(run().last()->hand_position_m[0]), x1, 1e-4) << "the key is still held";
    EXPECT_GT(heldPart(picture(participant, "participant_again")).x(), 0.0) << "the new window shows no part";
}

TEST_F(Windows, LostGraphicsPauseTheTrialUntilTheExperimenterGoesOn) {
    // Truth: invariant. The scene graph's own signals, as the driver's reset sends them.
    click("study-peg_in_hole");
    click("tryOut");
    waitFor<state::Running>();
    emit app_->participant()->sceneGraphInvalidated();
    waitFor<state::Paused>();
    EXPECT_EQ(run().view().display, presenter::Display::Lost);
    EXPECT_EQ(item(app_->experimenter(), "stateLine")->property("text").toString(),
              "Paused: the participant's picture is lost");
    emit app_->participant()->sceneGraphInitialized();
    waitFor([&] { return run().view().display == presenter::Display::Shown; });
    EXPECT_TRUE(run().view().is<state::Paused>());
    emit app_->participant()->sceneGraphError(QQuickWindow::ContextNotAvailable, "no context");
    waitFor([&] { return run().view().display == presenter::Display::Lost; });
    click("openDisplay");
    waitFor([&] { return app_->participant()->isExposed() && run().view().display == presenter::Display::Shown; });
    click("pause");
    waitFor<state::Running>();
    EXPECT_EQ(run().view().rows[0].attempts, 1);
}

TEST_F(Windows, ATrialWithSomethingToHearSaysWhereItsSoundComesFromOrThatItHasNone) {
    // Truth: invariant. Whether this machine has an output or not, the console and the data say the same.
    protocols_ = folder_ / "studies";
    std::filesystem::create_directories(protocols_ + "/heard");
    std::ofstream(protocols_ + "/heard/study.toml")
        << smallStudy("heard") << "[feedback]\ncues = [\"audio\"]\nmasking_noise = true\n";
    open("en", true);
    click("study-heard");
    click("watch");
    waitFor([&] { return run().view().brief.sound; });
    QQuickItem* line = item(app_->experimenter(), "sound");
    ASSERT_NE(line, nullptr);
    waitFor([&] { return !run().view().isRunning(); });
    ASSERT_FALSE(run().view().is<state::Failed>()) << run().view().failure();
    const bool heard = app_->desk().soundOutput().has_value();
    EXPECT_EQ(line->property("text").toString().startsWith("Sound: "), heard);
    EXPECT_EQ(line->property("text").toString().startsWith("No sound: "), !heard);
    const auto stored = store::StoreReader::open(folder_ / "data/heard.db");
    ASSERT_TRUE(stored);
    const auto attempts = stored->attempts();
    ASSERT_TRUE(attempts);
    const auto last = attempts->back().presentation;
    ASSERT_TRUE(last);
    EXPECT_EQ(last->sound, heard ? "played" : "silent");
    EXPECT_EQ(last->sound_output.empty(), !heard);
    EXPECT_EQ(last->sound_delay_us > 0.0, heard);
}

TEST_F(Windows, ASessionOfWhichNoLogCanBeKeptSaysSo) {
    // Truth: the folder that stands where the log belongs.
    std::filesystem::create_directories(folder_ / "data/peg_in_hole.db.log");
    click("study-peg_in_hole");
    click("watch");
    waitFor<state::Running>();
    const QString said = item(app_->experimenter(), "warnings")->property("text").toString();
    EXPECT_TRUE(said.startsWith("Warning: no log is kept beside the database")) << said.toStdString();
}

TEST_F(Windows, ARefusedCommandSaysWhyInTheLanguageOfTheWindows) {
    // Truth: invariant. The session refuses what its screen would not offer.
    click("study-peg_in_hole");
    click("watch");
    waitFor<state::Running>();
    click("language");
    app_->desk().command({.kind = session::CommandKind::Continue});
    waitFor([&] { return run().view().answered.has_value(); });
    EXPECT_EQ(item(app_->experimenter(), "answer")->property("text").toString(),
              "Jetzt nicht möglich: Die Sitzung ist nicht angehalten.");
}

}  // namespace
}  // namespace passung::test

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
