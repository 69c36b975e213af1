#include <filesystem>
#include <fstream>

#include "study/measures/measures.h"
#include "study/run/files/known_names.h"
#include "study/run/files/protocol_files.h"
#include "study/run/run_study.h"
#include "tests/ui/cli/small_study.h"
#include "tests/ui/window/windows.h"
#include "ui/presenter/participant_access.h"
#include "ui/window/registry_words.h"

// What the console says of a study: in the language of the window, whole on a small screen, and no more than is true.

namespace passung::test {
namespace {

class Words : public Windows {
protected:
    void SetUp() override {
        protocols_ = folder_ / "studies";
        warnings.clear();
    }

    void openWith(const std::string& study) {
        std::filesystem::create_directories(protocols_ + "/small");
        std::ofstream(protocols_ + "/small/study.toml") << study;
        open("en", true);
    }

    /// A simulated participant's session in the study's own database.
    void perform() {
        run::RunOptions options;
        options.database = presenter::studyDatabase(data_, "small");
        options.simulated = 1;
        options.backup = false;
        std::filesystem::create_directories(std::filesystem::path(options.database).parent_path());
        const auto plan = run::readProtocol(protocols_ + "/small/study.toml");
        ASSERT_TRUE(plan) << toString(plan.errors().front());
        const auto end = run::runStudy(*plan, options, {});
        ASSERT_TRUE(end) << toString(end.errors().front());
    }

    static std::string with(const std::string& what, const std::string& from) {
        std::string text = smallStudy();
        return text.replace(text.find(from), from.size(), what);
    }
};

TEST_F(Words, EveryMeasureAndDeviceHasAGermanName) {
    // Truth: invariant, over the registries of the rooms below; a name of another program stays as it is.
    openWith(smallStudy());
    app_->setLanguage("de");
    for (const auto& measure : measures::definitions())
        EXPECT_NE(window::measureWord(measure.label).toStdString(), measure.label) << measure.name;
    for (const DeviceDescription& device : run::presetDevices())
        EXPECT_NE(window::deviceWord(device.label).toStdString(), device.label) << device.name;
    EXPECT_EQ(window::deviceWord("Some arm"), "Some arm");
    EXPECT_TRUE(app_->studies().cards()[0].toMap()["device"].toString().endsWith("(simuliert)"));
}

TEST_F(Words, ADurationIsNoBoundAndHasTheRestsInIt) {
    // Truth: closed form: two blocks of 3 × (0.4 s + 20 s) and two minutes of rest between them.
    openWith(smallStudy() + "\n[[block]]\nname = \"again\"\norder = \"williams\"\nrepetitions = 3\nrest_s = 120\n");
    EXPECT_EQ(app_->studies().cards()[0].toMap()["minutes"].toInt(), 5);
    waitFor([&] { return !app_->details().design().isEmpty(); });
    const auto duration = [&] { return app_->details().design()["duration"].toString(); };
    EXPECT_TRUE(duration().startsWith("About 5 min ")) << duration().toStdString();
    app_->setLanguage("de");
    EXPECT_TRUE(duration().startsWith("Etwa 5 min ")) << duration().toStdString();
}

TEST_F(Words, WhyNoPersonTakesPartIsReadWholeOnASmallScreen) {
    // Truth: invariant: the text's own size against the room that it has.
    openWith(
        with(R"("contact.method" = "penalty", "feedback.cues" = ["vibrotactile"])", R"("contact.method" = "penalty")"));
    QQuickWindow* console = app_->experimenter();
    console->resize(1280, 720);
    waitFor([&] { return console->contentItem()->size() == QSizeF(1280, 720); });
    for (const char* language : {"en", "de"})
        for (const double scale : {1.0, 1.25}) {
            app_->setLanguage(language);
            app_->look().setScale(scale);
            layOut(console->contentItem());
            picture(console, qPrintable(QString("why_not_by_hand_%1_%2").arg(language).arg(scale)));
            const QQuickItem* why = item(console, "whyNotByHand");
            ASSERT_NE(why, nullptr);
            EXPECT_FALSE(why->property("truncated").toBool()) << language << scale;
            EXPECT_LE(why->property("contentWidth").toDouble(), why->width() + 1.0) << language << scale;
            EXPECT_LE(why->property("contentHeight").toDouble(), why->height() + 1.0) << language << scale;
            const QRectF place = why->mapRectToScene({0, 0, why->width(), why->height()});
            EXPECT_TRUE(QRectF(0, 0, 1280, 720).contains(place)) << language << scale;
        }
}

TEST_F(Words, FiguresOfAMeasureAreNeverCut) {
    // Truth: invariant: the text's own size against the room that it has. The widest figures: three digits after two
    // noughts.
    openWith(smallStudy());
    perform();
    app_->setPage("data");
    app_->records().refresh();
    settle();
    QQuickWindow* console = app_->experimenter();
    console->resize(1280, 720);
    waitFor([&] { return item(console, "look") != nullptr; });
    QQuickItem* look = item(console, "look");
    const QVariantMap row{{"condition", "all"},
                          {"n", 5},
                          {"participants", 1},
                          {"values", QVariantList{0.001, 0.002}},
                          {"box", QVariantList{0.00100, 0.00767, 0.01530, 0.02310, 0.04000}}};
    look->setProperty("model", QVariantList{row});
    waitFor([&] { return item(look, "lookNumbers") != nullptr; });
    layOut(console->contentItem());
    picture(console, "look_numbers");
    const QQuickItem* numbers = item(look, "lookNumbers");
    EXPECT_EQ(numbers->property("text").toString().toStdString(), "0.0153 (0.00767–0.0231)");
    EXPECT_FALSE(numbers->property("truncated").toBool());
    EXPECT_LE(numbers->property("contentWidth").toDouble(), numbers->width() + 1.0);
}

}  // namespace
}  // namespace passung::test
