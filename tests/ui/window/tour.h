#pragma once

#include <QElapsedTimer>

#include <functional>

#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/run/run_study.h"
#include "tests/ui/window/asking_study.h"
#include "tests/ui/window/four_trials.h"
#include "tests/ui/window/windows.h"
#include "ui/presenter/participant_access.h"

namespace passung::test {

/// Goes through every screen of both windows, as a lab does in an afternoon: studies, somebody watched, somebody
/// enrolled who consents, answers and begins, recorded data.
class Tour : public Windows {
protected:
    using Look = std::function<void(QQuickWindow*, const QString& screen)>;

    /// The shipped studies, one that asks for everything, and one with a mistake.
    void SetUp() override {
        namespace fs = std::filesystem;
        protocols_ = folder_ / "protocols";
        fs::create_directories(protocols_);
        for (const char* shipped : {"peg_in_hole", "rendering_methods", "accuracy_threshold", "questionnaires"})
            fs::copy(std::string(PASSUNG_SOURCE_DIR "/protocols/") + shipped, protocols_ + "/" + shipped,
                     fs::copy_options::recursive);
        writeAskingStudy(protocols_ + "/asking");
        writeFile(protocols_ + "/asking/study.toml", askingByHand());
        warnings.clear();
    }

    void takeTour(const char* language, bool dark, double scale, const Look& look) {
        look_ = look;
        data_ = folder_ / (language + std::to_string(tours_++) + "/tryouts");
        dress(dark, scale);
        open(language, dark);
        app_->look().setScale(scale);
        console_ = app_->experimenter();
        seeStudies();
        seeTrial();
        seeMistake();
        seePeople();
        seeQuestions();
        seeTrialByHand();
        seeData();
    }

private:
    /// The participant's window looks as the studies say.
    void dress(bool dark, double scale) {
        const std::string view = std::string(kOnAnyMachine) + "theme = \"" + (dark ? "dark" : "light") +
                                 "\"\ntext_percent = " + std::to_string(std::lround(100 * scale)) + "\n";
        for (const auto& folder : std::filesystem::directory_iterator(protocols_)) {
            const std::string path = folder.path() / "study.toml";
            if (!std::filesystem::exists(path)) continue;
            std::string text = textOf(path);
            writeFile(path, text.substr(0, text.find(kOnAnyMachine)) + view);
        }
    }

    /// Every second condition is timed by the experimenter.
    static std::string askingByHand() {
        std::string text = smallStudy("asking") + kAsks;
        const std::string hopeless = R"("task.timeout_s" = 0.4, "contact.method" = "penalty")";
        const std::string by_hand = R"("task.timed_by" = "experimenter", "feedback.kinesthetic" = false)";
        return text.replace(text.find(hopeless), hopeless.size(), by_hand);
    }

    void see(QQuickWindow* window, const QString& screen) { look_(window, screen); }

    /// One of the values side by side.
    void pick(const char* choice, int index) {
        waitFor([&] { return item(console_, choice) != nullptr; });
        layOut(console_->contentItem());
        QQuickItem* row = item(console_, choice)->childItems().front();
        QQuickItem* option = row->childItems()[index];
        QTest::mouseClick(console_, Qt::LeftButton, {},
                          option->mapToScene({option->width() / 2, option->height() / 2}).toPoint());
    }

    void seeStudies() {
        activate(console_);
        click("study-peg_in_hole");
        pick("part", 0);
        see(console_, "console_studies");
        pick("part", 1);
        waitFor([&] { return !app_->details().design().isEmpty(); });
        see(console_, "console_studies_design");
        pick("part", 2);
        see(console_, "console_studies_tick");
        pick("part", 3);
        see(console_, "console_studies_accuracy");
        pick("part", 4);
        see(console_, "console_studies_protocol");
        pick("part", 0);
    }

    void seeTrial() {
        click("watch");
        waitFor([&] { return run().view().force_N > 0.5 && run().view().trial_s > 1.5; });
        see(app_->participant(), "participant_task");
        see(console_, "console_session");
        activate(console_);
        pressKey(Qt::Key_Escape);
        waitFor<presenter::state::Stopped>();
        see(console_, "console_session_stopped");
        see(app_->participant(), "participant_stopped");
        app_->participant()->close();
        waitFor([&] { return run().view().display == presenter::Display::Closed; });
        see(console_, "console_session_window_closed");
        click("openDisplay");
        endSession();
        see(console_, "console_session_ended");
        see(app_->participant(), "participant_end");
    }

    /// A window that comes up between the two clicks takes the focus and the first click back: then both are made
    /// again.
    void endSession() {
        const auto is_over = [&] { return run().view().is<presenter::state::Incomplete, presenter::state::Failed>(); };
        while (!is_over()) {
            activate(console_);
            QQuickItem* abort = item(console_, "abort");
            if (abort != nullptr) click(console_, "abort");
            if (abort != nullptr && abort->property("armed").toBool()) continue;
            QElapsedTimer waiting;
            waiting.start();
            waitFor([&] { return is_over() || waiting.hasExpired(2000); });
        }
        waitFor<presenter::state::Incomplete>();
    }

    void seeMistake() {
        std::filesystem::create_directories(protocols_ + "/mistaken");
        std::string text = smallStudy("mistaken");
        writeFile(protocols_ + "/mistaken/study.toml", text.replace(text.find("seed = 7"), 8, "seed = -7"));
        click("page-studies");
        click("reload");
        click("study-mistaken");
        see(console_, "console_studies_mistake");
        std::filesystem::remove_all(protocols_ + "/mistaken");
        click("reload");
    }

    void seePeople() {
        click("study-asking");
        click("page-participants");
        settle();
        see(console_, "console_participants_none");
        type("experimenter", "AB");
        for (int i = 0; i < 2; ++i) {
            click("enrol");
            settle();
        }
        click("person-P001");
        click("consent-0-yes");
        settle();
        see(console_, "console_participants");
        click("leave");
        see(console_, "console_leaving");
        click("scope3");
        type("leavingReason", "fell ill");
        click("leavingNext");
        see(console_, "console_leaving_sure");
        click("leavingBack");
        click("leavingBack");
    }

    void seeQuestions() {
        click("startSession");
        waitFor<presenter::state::Consenting>();
        QQuickWindow* window = app_->participant();
        waitFor([&] { return app_->form().shown(); });
        see(console_, "console_session_consent");
        see(window, "participant_consent");
        activate(window);
        layOut(window->contentItem());
        click(window, "label0");
        click(window, "formNext");
        waitFor<presenter::state::Ready>();
        see(console_, "console_session_ready");
        see(window, "participant_ready");
        activate(console_);
        pressKey(Qt::Key_F5);
        waitFor<presenter::state::Answering>();
        for (int page = 0; page < 3; ++page) {
            waitFor([&] { return app_->form().shown() && app_->form().page() == page; });
            see(window, QString("participant_questions_%1").arg(page + 1));
            if (page == 0) see(console_, "console_session_answering");
            click(window, "formNext");  // points out what is open
            waitFor([&] { return !item(window, "notice")->property("text").toString().isEmpty(); });
            if (page == 0) see(window, "participant_questions_open");
            click(window, "formNext");
        }
        waitFor<presenter::state::ReadingPage>();
        waitFor([&] { return item(window, "picture")->property("status").toInt() == 1; });
        see(window, "participant_instruction");
        click(window, "goOn");
    }

    void seeTrialByHand() {
        const auto isThere = [&] { return run().view().is<presenter::state::ToStart, presenter::state::Running>(); };
        const auto byHand = [&] { return run().view().brief.timed_by == plan::TimedBy::Experimenter; };
        waitFor([&] { return isThere() || byHand(); });
        if (!byHand()) {
            activate(console_);
            pressKey(Qt::Key_K, Qt::ControlModifier);
        }
        waitFor([&] { return byHand() && !app_->screen().drawn(); });
        see(console_, "console_session_by_hand");
        see(app_->participant(), "participant_by_hand");
        activate(console_);
        pressKey(Qt::Key_Escape);
        waitFor<presenter::state::Stopped>();
        endSession();
        click("page-participants");
        settle();
        see(console_, "console_participants_broken_off");
    }

    /// A simulated participant's whole session.
    void perform(const std::string& study) {
        const auto plan =
            protocol::readProtocol(protocols_ + "/" + study + "/study.toml", run::knownDevices(), run::knownMeasures());
        ASSERT_TRUE(plan) << toString(plan.errors().front());
        run::RunOptions options;
        options.database = presenter::studyDatabase(data_, study);
        options.simulated = 1;
        options.backup = false;
        const auto end = run::runStudy(*plan, options, {});
        ASSERT_TRUE(end) << toString(end.errors().front());
    }

    void seeData() {
        perform("peg_in_hole");
        click("page-data");
        settle();
        click("page-studies");
        click("study-peg_in_hole");
        click("page-data");
        pick("source", 1);
        settle();
        see(console_, "console_data_tryouts");
        pick("source", 0);
        settle();
        type("exportFolder", "exports/peg_in_hole");
        click("attempt-2");
        see(console_, "console_data");
        click("again");
        waitFor([&] { return app_->replay().there() || !app_->replay().told().isEmpty(); });
        app_->replay().seek(0.8 * app_->replay().length());
        see(console_, "console_replay");
        click("closeReplay");
    }

    Look look_;
    QQuickWindow* console_ = nullptr;
    int tours_ = 0;
};

}  // namespace passung::test
