#include <gtest/gtest.h>

#include <functional>

#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/store/schema/sqlite.h"
#include "tests/ui/window/asking_study.h"
#include "tests/ui/window/windows.h"

// What the participant is asked at their window: consent, instructions, questionnaires; by keyboard alone and by mouse.

namespace passung::test {
namespace {

namespace state = presenter::state;

constexpr const char* kAnswers =
    "SELECT group_concat(item || '=' || coalesce(value_num, value_text, 'NULL'), '; ') FROM (SELECT * FROM "
    "item_response ORDER BY presented_index)";
constexpr const char* kExpected =
    "likert=6.0; load=55.0; pain=10.0; differential=-2.0; hand=9.0; age=37.0; remarks=fine, thanks; weight=1.0";

class Asked : public Windows {
protected:
    void begin(const std::string& participant, const char* language, const std::string& more = "") {
        const std::string file = writeAskingStudy(folder_ / "asking", more);
        const auto plan = protocol::readProtocol(file, run::knownDevices(), run::knownMeasures());
        ASSERT_TRUE(plan) << toString(plan.errors().front());
        app_->desk().start(*plan, {.database = database_,
                                   .participant = participant,
                                   .language = language,
                                   .experimenter = "E1",
                                   .waits = true});
        app_->participant()->requestActivate();
        waitFor([&] { return app_->participant()->isExposed() && app_->participant()->isActive(); });
    }

    std::string query(const std::string& sql) const {
        return store::Database(database_, store::OpenMode::ReadOnly).text(sql);
    }

    QQuickWindow* window() const { return app_->participant(); }
    void key(Qt::Key key) { QTest::keyClick(window(), key); }
    void keys(const char* text) {
        for (const char* c = text; *c != 0; ++c) QTest::keyClick(window(), *c);
    }
    QQuickItem* part(int row, const char* name) const {
        QQuickItem* in = item(window(), qPrintable(QString("row%1").arg(row)));
        return in == nullptr ? nullptr : item(in, name);
    }
    void clickPart(int row, const char* name, double share = 0.5) {
        QQuickItem* target = part(row, name);
        ASSERT_NE(target, nullptr) << row << " " << name;
        layOut(window()->contentItem());
        const QPointF at = target->mapToScene({share * target->width(), target->height() / 2});
        QTest::mouseClick(window(), Qt::LeftButton, {}, at.toPoint());
    }
    bool isFocused(const char* name) const {
        QQuickItem* wanted = item(window(), name);
        return wanted != nullptr && wanted->hasActiveFocus();
    }
    int page() const { return app_->form().page(); }
    void waitForFocus(const char* name) {
        waitFor([&] { return isFocused(name); });
    }
    void waitForForm(const char* title) {
        waitFor([&] {
            QQuickItem* shown = item(window(), "formTitle");
            return shown != nullptr && shown->property("text").toString() == title;
        });
    }
    void finish() {
        app_->desk().command({.kind = session::CommandKind::Abort});
        waitFor<state::Incomplete>();
    }

    const std::string database_ = folder_ / "asking.db";
};

TEST_F(Asked, KeyboardAloneAnswersConsentInstructionsAndEveryKindOfItem) {
    // Truth: closed form: what the keys mean. The person is real and their hand moves the mouse.
    begin("P001", "en");
    waitFor<state::Consenting>();
    waitForFocus("row0");
    picture(window(), "consent");
    key(Qt::Key_1);
    key(Qt::Key_Return);
    waitForFocus("formNext");
    key(Qt::Key_Return);
    waitFor([&] { return run().view().form() && run().view().form()->id == "consent|photos"; });
    waitForFocus("row0");
    key(Qt::Key_Right);
    key(Qt::Key_Right);
    key(Qt::Key_Tab);
    key(Qt::Key_Space);
    waitFor<state::Ready>();
    app_->experimenter()->requestActivate();
    waitFor([&] { return app_->experimenter()->isActive(); });
    pressKey(Qt::Key_F5);
    waitFor<state::Answering>();
    window()->requestActivate();
    waitFor([&] { return window()->isActive(); });

    waitForFocus("row0");
    picture(window(), "form_scales");
    key(Qt::Key_6);
    key(Qt::Key_Return);
    waitForFocus("row1");
    key(Qt::Key_Right);  // the middle
    key(Qt::Key_Right);
    key(Qt::Key_Tab);
    waitForFocus("row2");
    key(Qt::Key_End);
    key(Qt::Key_Return);
    waitForFocus("row3");
    key(Qt::Key_2);
    key(Qt::Key_Return);
    waitForFocus("row4");
    key(Qt::Key_Right);
    key(Qt::Key_Right);
    picture(window(), "form_scales_answered");
    key(Qt::Key_Return);
    waitForFocus("formNext");
    key(Qt::Key_Return);
    waitFor([&] { return page() == 1; });
    waitFor([&] { return part(0, "typed") != nullptr && part(0, "typed")->hasActiveFocus(); });
    keys("7");
    key(Qt::Key_Return);
    EXPECT_NE(app_->form().rows().front().toMap()["fault"].toString(), "");
    picture(window(), "form_typed_fault");
    QTest::keyClick(window(), Qt::Key_Backtab, Qt::ShiftModifier);
    waitFor([&] { return part(0, "typed")->hasActiveFocus(); });
    key(Qt::Key_Backspace);
    keys("37");
    key(Qt::Key_Return);
    waitFor([&] { return part(1, "typed")->hasActiveFocus(); });
    keys("fine, thanks");
    picture(window(), "form_typed");
    key(Qt::Key_Tab);
    QTest::keyClick(window(), Qt::Key_Tab);  // past the button that goes back
    waitForFocus("formNext");
    key(Qt::Key_Space);
    waitFor([&] { return page() == 2; });
    waitForFocus("row0");
    key(Qt::Key_2);
    picture(window(), "form_pair");
    key(Qt::Key_Return);
    waitForFocus("formNext");
    key(Qt::Key_Return);

    waitFor<state::ReadingPage>();
    waitForFocus("goOn");
    waitFor([&] { return item(window(), "picture")->property("status").toInt() == 1; });
    picture(window(), "instruction");
    key(Qt::Key_Return);
    waitFor([&] { return run().view().is<state::ToStart, state::Running>(); });
    finish();

    EXPECT_EQ(query(kAnswers), kExpected);
    EXPECT_EQ(query("SELECT count(*) FROM item_response WHERE rt_ms >= 0"), "8");
    EXPECT_EQ(query("SELECT payload_json->>'answered_by' FROM event WHERE event='questionnaire_answered'"),
              "participant");
    EXPECT_EQ(query("SELECT group_concat(clause || ' ' || decision || ' ' || language) FROM consent"),
              "data_use yes en,photos no en");
    EXPECT_EQ(query("SELECT count(*) FROM event WHERE event='instruction' AND source='participant' AND "
                    "payload_json->>'reading_ms' >= 0"),
              "1");
    EXPECT_EQ(query("SELECT kind || ' ' || experimenter FROM participant JOIN session USING(participant_id)"),
              "real E1");
    EXPECT_EQ(query("SELECT device_json->>'name' FROM segment"), "mouse");
    EXPECT_NE(query("SELECT device_json->>'label' FROM segment").find("moved by mouse and keyboard"),
              std::string::npos);
}

TEST_F(Asked, TheMouseAnswersTheSameInTheSessionsLanguageWhateverTheExperimentersIs) {
    // Truth: closed form; the texts are those of the file.
    open("en", false);
    begin("T001", "de");
    for (const char* clause : {"consent|data_use", "consent|photos"}) {
        waitFor([&] { return run().view().form() && run().view().form()->id == clause && app_->form().shown(); });
        waitForForm("Ihre Einwilligung");
        clickPart(0, run().view().form()->id == "consent|photos" ? "label1" : "label0");
        picture(window(), "consent_de_light");
        click(window(), "formNext");
    }
    waitFor<state::Ready>();
    app_->experimenter()->requestActivate();
    waitFor([&] { return app_->experimenter()->isActive(); });
    pressKey(Qt::Key_F5);
    window()->requestActivate();
    waitFor([&] { return window()->isActive(); });
    waitForForm("Zu Ihrer Arbeit");
    waitForFocus("row0");
    clickPart(0, "label4");
    clickPart(0, "label5");
    click(window(), "formNext");
    waitFor([&] { return !item(window(), "notice")->property("text").toString().isEmpty(); });
    EXPECT_EQ(page(), 0) << "open items are pointed out first";
    picture(window(), "form_open_de_light");
    EXPECT_EQ(item(window(), "formNext")->property("text").toString(), "Weiter");
    {  // the tick of 55: the field has a margin of 14 around the scale
        QQuickItem* field = part(1, "field");
        clickPart(1, "field", (14.0 + 0.55 * (field->width() - 28.0)) / field->width());
    }
    clickPart(2, "field", 0.999);
    clickPart(3, "label1");
    clickPart(4, "label1");
    picture(window(), "form_scales_de_light");
    click(window(), "formNext");
    waitFor([&] { return page() == 1; });
    clickPart(0, "typed");
    keys("37");
    clickPart(1, "typed");
    keys("fine, thanks");
    picture(window(), "form_typed_de_light");
    click(window(), "formNext");
    waitFor([&] { return page() == 2; });
    clickPart(0, "label1");
    picture(window(), "form_pair_de_light");
    click(window(), "formBack");
    waitFor([&] { return page() == 1; });
    EXPECT_EQ(part(0, "typed")->property("text").toString(), "37") << "what was typed is still there";
    click(window(), "formNext");
    waitFor([&] { return page() == 2; });
    click(window(), "formNext");
    waitFor<state::ReadingPage>();
    waitFor([&] { return item(window(), "picture")->property("status").toInt() == 1; });
    picture(window(), "instruction_de_light");
    EXPECT_TRUE(item(window(), "pageText")->property("text").toString().startsWith("Sie stecken"));
    click(window(), "goOn");
    waitFor([&] { return run().view().is<state::ToStart, state::Running>(); });
    finish();
    EXPECT_EQ(query(kAnswers), kExpected);
    EXPECT_EQ(query("SELECT changes FROM item_response WHERE item='likert'"), "1");
    EXPECT_EQ(query("SELECT q.language FROM questionnaire_run r JOIN questionnaire q USING(questionnaire_sha256)"),
              "de");
    EXPECT_EQ(query("SELECT kind || ' ' || language FROM participant JOIN session USING(participant_id)"), "pilot de");
    EXPECT_EQ(query("SELECT group_concat(clause || ' ' || decision || ' ' || language) FROM consent"),
              "data_use yes de,photos no de");
}

TEST_F(Asked, WhoRefusesARequiredClauseGetsNoSession) {
    // Truth: invariant (admission).
    begin("P001", "en");
    waitFor<state::Consenting>();
    waitForFocus("row0");
    key(Qt::Key_2);
    key(Qt::Key_Return);
    key(Qt::Key_Return);
    waitFor<state::Failed>();
    EXPECT_NE(run().view().failure().find("no consent to the clause data_use"), std::string::npos)
        << run().view().failure();
    EXPECT_EQ(query("SELECT count(*) FROM session"), "0");
    EXPECT_EQ(query("SELECT decision FROM consent"), "no");
    waitFor([&] { return !app_->form().shown(); });
}

TEST_F(Asked, TheSessionCanBePausedStoppedAndEndedWhileAQuestionnaireIsOpen) {
    // Truth: invariant. What was answered so far stays on the screen; closing the program asks it again at resume.
    begin("T001", "en");
    for (const char* clause : {"consent|data_use", "consent|photos"}) {
        waitFor([&] { return run().view().form() && run().view().form()->id == clause && app_->form().shown(); });
        waitForFocus("row0");
        key(Qt::Key_1);
        key(Qt::Key_Return);
        waitForFocus("formNext");
        key(Qt::Key_Return);
    }
    waitFor<state::Ready>();
    app_->desk().command({.kind = session::CommandKind::Start});
    waitFor<state::Answering>();
    waitForFocus("row0");
    key(Qt::Key_4);
    app_->desk().command({.kind = session::CommandKind::Stop});
    waitFor<state::Stopped>();
    EXPECT_FALSE(app_->form().shown());
    picture(window(), "pause");
    app_->desk().command({.kind = session::CommandKind::Continue});
    waitFor<state::Answering>();
    EXPECT_TRUE(app_->form().shown());
    EXPECT_EQ(app_->form().rows().front().toMap()["value"].toDouble(), 4.0);
    finish();
    EXPECT_EQ(query("SELECT end_state FROM session"), "aborted");
    EXPECT_EQ(query("SELECT count(*) FROM questionnaire_run"), "0");
}

}  // namespace
}  // namespace passung::test
