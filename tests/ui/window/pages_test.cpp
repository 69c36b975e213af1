#include <fstream>

#include "study/protocol/protocol_reader.h"
#include "study/store/store_reader.h"
#include "tests/ui/cli/small_study.h"
#include "tests/ui/window/windows.h"
#include "ui/app/study_desk.h"

namespace passung {
namespace {

using test::pixelsLike;

/// The experimenter's pages, about a small study of its own.
class Pages : public test::Windows {
protected:
    Pages() {
        std::filesystem::create_directories(folder_ / "protocols/small");
        protocols_ = folder_ / "protocols";
        std::ofstream(protocols_ + "/small/study.toml") << test::smallStudy() << kConsent;
    }

    static constexpr const char* kConsent = R"(
[[consent]]
clause = "taking_part"
text.en = "You take part."
text.de = "Sie nehmen teil."
)";

    std::string database() const { return app::studyDatabase(folder_ / "data", "small"); }

    store::StoreReader reader() const {
        auto opened = store::StoreReader::open(database());
        if (!opened) throw std::runtime_error(toString(opened.errors().front()));
        return *std::move(opened);
    }

    /// Whole simulated sessions in the study's own database.
    void perform(int participants) {
        std::filesystem::create_directories(std::filesystem::path(database()).parent_path());
        const auto plan =
            protocol::readProtocol(protocols_ + "/small/study.toml", app::knownDevices(), app::knownMeasures());
        ASSERT_TRUE(plan) << toString(plan.errors().front());
        app::RunOptions options;
        options.database = database();
        options.simulated = participants;
        options.backup = false;
        const auto end = app::runStudy(*plan, options, {});
        ASSERT_TRUE(end) << toString(end.errors().front());
    }

    void type(const char* into, const char* text) {
        click(into);
        QTest::keyClick(app_->experimenter(), Qt::Key_A, Qt::ControlModifier);
        for (const char* c = text; *c != 0; ++c) QTest::keyClick(app_->experimenter(), *c);
    }

    /// Waits for the database to be read or written.
    void settle() {
        waitFor([&] { return !app_->roster().busy() && !app_->records().busy(); });
    }

    QString textOf(const char* name) const {
        const QQuickItem* found = item(app_->experimenter(), name);
        return found != nullptr ? found->property("text").toString() : QString("(not shown)");
    }
    bool enabled(const char* name) const {
        const QQuickItem* found = item(app_->experimenter(), name);
        return found != nullptr && found->isEnabled();
    }
    QImage shot(const char* name) { return picture(app_->experimenter(), name); }
};

TEST_F(Pages, SomebodyIsEnrolledOnceConsentsIsExcludedReadmittedAndErased) {
    // Truth: invariant. What the page says is what the database holds.
    pressKey(Qt::Key_2, Qt::ControlModifier);
    settle();
    EXPECT_EQ(textOf("nobody"), "Nobody is enrolled yet.");
    EXPECT_EQ(textOf("code"), "P001");
    type("experimenter", "AB");
    click("enrol");
    settle();
    EXPECT_EQ(textOf("code"), "P002") << "the next code";
    EXPECT_EQ(textOf("personCode"), "P001");
    type("code", "P001");
    EXPECT_FALSE(enabled("enrol"));
    EXPECT_EQ(textOf("whyNotEnrol"), "This code is enrolled already.");
    type("code", "P002");
    EXPECT_EQ(textOf("whyNotEnrol"), "");
    pressKey(Qt::Key_Return);
    settle();
    auto people = reader().participants();
    ASSERT_TRUE(people);
    ASSERT_EQ(people->size(), 2u);
    EXPECT_EQ((*people)[1].kind, "real");

    click("person-P001");
    click("consent-0-yes");
    settle();
    const auto consents = reader().consents();
    ASSERT_TRUE(consents && consents->size() == 1);
    EXPECT_EQ(consents->front().decision, "yes");
    shot("participants");

    click("leave");
    click("scope3");
    EXPECT_FALSE(enabled("leavingNext")) << "without a reason";
    type("leavingReason", "was late");
    click("leavingNext");
    shot("participants_exclude");
    click("leavingConfirm");
    settle();
    people = reader().participants();
    EXPECT_EQ(people->front().status, "excluded");
    EXPECT_EQ(people->front().status_reason, "was late");
    EXPECT_FALSE(enabled("startSession"));
    EXPECT_FALSE(enabled("readmit"));
    type("readmitReason", "was not");
    click("readmit");
    settle();
    EXPECT_NE(reader().participants()->front().status, "excluded");

    click("language");
    click("leave");
    click("scope2");
    click("leavingNext");
    type("typedCode", "P002");
    EXPECT_FALSE(enabled("leavingConfirm")) << "the wrong code";
    type("typedCode", "P001");
    click("theme");
    shot("participants_erase_de_light");
    click("leavingConfirm");
    settle();
    people = reader().participants();
    ASSERT_EQ(people->size(), 1u);
    EXPECT_EQ(people->front().participant_id, "P002");
    const auto audit = reader().audit();
    EXPECT_TRUE(audit && audit->faults.empty());
    EXPECT_EQ(textOf("personCode"), "(not shown)");
    shot("participants_de_light");
}

TEST_F(Pages, RecordedSessionsAreLookedAtAndExported) {
    // Truth: independent program: the export of the page and that of the command line are the same bytes.
    perform(2);
    click("page-data");
    app_->records().refresh();
    settle();
    EXPECT_EQ(textOf("noData"), "(not shown)");
    const QImage look = shot("data");
    EXPECT_GT(pixelsLike(look.copy(410, 150, 860, 400), app_->look().accent(), 60), 200) << "no strips are drawn";
    type("exportFolder", (folder_ / "out").c_str());
    click("export");
    waitFor([&] { return !app_->records().exporting(); });
    EXPECT_FALSE(app_->records().failed()) << app_->records().told().toStdString();
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/SHA256SUMS"));
    click("language");
    click("theme");
    shot("data_de_light");
}

}  // namespace
}  // namespace passung
