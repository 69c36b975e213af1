#include <filesystem>
#include <fstream>

#include "core/scene/contact_geometry.h"
#include "study/run/files/protocol_files.h"
#include "study/run/machine/front_file.h"
#include "tests/ui/cli/small_study.h"
#include "tests/ui/window/windows.h"

// What accuracy costs is measured, looked at and decided on the console's page, by mouse and by keyboard.

namespace passung::test {
namespace {

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class AccuracyPage : public Windows {
protected:
    AccuracyPage() {
        protocols_ = folder_ / "studies";
        write("other", fairStudy());
        write("small", text_);
    }

    void SetUp() override {
        Windows::SetUp();
        app_->experimenter()->resize(1280, 720);
        activate(app_->experimenter());
        waitFor([&] { return app_->experimenter()->width() == 1280; });
        click("study-small");
        openPart(3);
    }

    std::string fileOf(const char* study) const { return protocols_ + "/" + study + "/study.toml"; }
    void write(const char* study, std::string text) const {
        std::filesystem::create_directories(protocols_ + "/" + study);
        const std::string name = "name = \"small\"";
        text.replace(text.find(name), name.size(), std::string("name = \"") + study + "\"");
        std::ofstream(fileOf(study)) << text;
    }

    void openPart(int part) {
        waitFor([&] { return item(app_->experimenter(), "part") != nullptr; });
        QMetaObject::invokeMethod(item(app_->experimenter(), "part"), "picked", Q_ARG(int, part));
    }
    bool measuring() const { return app_->accuracy().work()["measuring"].toBool(); }
    void measure() {
        click("measureAccuracy");
        ASSERT_TRUE(measuring());
        waitFor([&] { return !measuring(); });
        ASSERT_EQ(textOf("accuracyTold"), "(not shown)");
        ASSERT_FALSE(points().isEmpty());
    }
    QVariantList points() const { return app_->accuracy().front()["points"].toList(); }
    QVariantMap point(int index) const { return points()[index].toMap(); }
    int findPoint(const char* method, const char* geometry) const {
        for (int i = 0; i < points().size(); ++i)
            if (point(i)["method"] == method && point(i)["geometry"] == geometry) return i;
        return -1;
    }
    /// On the mark itself.
    void clickPoint(int index) {
        waitFor([&] { return item(app_->experimenter(), ("point-" + std::to_string(index)).c_str()) != nullptr; });
        layOut(app_->experimenter()->contentItem());
        const QQuickItem* mark = item(app_->experimenter(), ("point-" + std::to_string(index)).c_str());
        QTest::mouseClick(app_->experimenter(), Qt::LeftButton, {}, mark->mapToScene({0, 0}).toPoint());
    }
    void use() {
        click("useSetting");
        waitFor([&] { return !app_->accuracy().choice()["told"].toString().isEmpty(); });
    }
    std::string textOf(const char* name) const {
        const QQuickItem* found = item(app_->experimenter(), name);
        return found != nullptr ? found->property("text").toString().toStdString() : "(not shown)";
    }
    QImage shot(const char* name) { return picture(app_->experimenter(), name); }

    std::string text_ = oneMethodStudy() + "# the end\n";
};

TEST_F(AccuracyPage, ASettingIsMeasuredChosenInThePictureAndWrittenIntoTheStudy) {
    // Truth: invariant: the file reads as the setting that was clicked on; every line but those of [scene.contact]
    // stays.
    EXPECT_NE(textOf("accuracyHint"), "(not shown)");
    shot("accuracy_before");
    click("measureAccuracy");
    ASSERT_TRUE(measuring());
    waitFor([&] { return app_->accuracy().work()["share"].toDouble() > 0.3 || !measuring(); });
    ASSERT_TRUE(measuring()) << "measured before anything could be seen of it";
    EXPECT_NE(textOf("accuracyWhat").find('%'), std::string::npos);
    shot("accuracy_measuring");
    click("page-data");  // the window is used meanwhile
    click("page-studies");
    waitFor([&] { return !measuring(); });
    shot("accuracy_front");
    const QVariantList measured = points();
    ASSERT_GE(measured.size(), 7);

    const int chosen = findPoint("god_object", "surface");
    ASSERT_GE(chosen, 0);
    clickPoint(chosen);
    // A mark that lies upon another one is the one or the other: what counts is what is said to be chosen.
    const QVariantMap setting = point(app_->accuracy().chosen());
    EXPECT_TRUE(textOf("accuracyChoice").starts_with(setting["words"].toString().toStdString()));
    app_->accuracy().choose(chosen);
    use();
    EXPECT_EQ(textOf("accuracyTold"), "Written into the study's file.");
    shot("accuracy_used");
    const auto plan = run::readProtocol(fileOf("small"));
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    for (const plan::Condition& condition : plan->conditions) {
        EXPECT_EQ(condition.scene.contact.method, scene::ContactMethod::GodObject);
        EXPECT_EQ(condition.scene.contact.geometry, scene::Geometry::Surface);
    }
    std::string expected = text_;
    const std::string last = "spacing_mm = 3.0\n";
    expected.insert(expected.find(last) + last.size(), "method = \"god_object\"\ngeometry = \"surface\"\n");
    EXPECT_EQ(contents(fileOf("small")), expected);
    EXPECT_TRUE(point(chosen)["inStudy"].toBool());

    // The same again: on the second showing, and after another study.
    const QVariantList used = points();
    openPart(0);
    openPart(3);
    EXPECT_EQ(points(), used);
    click("study-other");
    EXPECT_TRUE(points().isEmpty()) << "of another study";
    click("study-small");
    EXPECT_EQ(points(), used);
    EXPECT_EQ(app_->accuracy().chosen(), chosen);
    EXPECT_NE(item(app_->experimenter(), "frontPlot"), nullptr);
    EXPECT_EQ(used.size(), measured.size());
}

/// Beside the studies before the windows open: of one, a front with three settings from a machine that is none.
class StoredFront : public AccuracyPage {
protected:
    StoredFront() {
        writeFront("small");
        std::ofstream(run::frontPath(fileOf("other"))) << "no table";
    }

    void writeFront(const char* study) const {
        const auto plan = run::readProtocol(fileOf(study));
        if (!plan) throw std::runtime_error(toString(plan.errors().front()));
        run::FrontFile file = run::newFrontFile("0123abc");
        file.machine = "an abacus";
        file.date = "2026-01-02";
        run::TickFront front;
        front.ticks = 1500;
        for (const scene::Geometry geometry :
             {scene::Geometry::Field, scene::Geometry::Surface, scene::Geometry::ClosedForm}) {
            truth::PathCost row;
            row.setting.geometry = geometry;
            const double seconds = 1e-6 * static_cast<double>(10 + front.measured.rows.size());
            row.time = {seconds, 2 * seconds, 3 * seconds};
            row.overlap = row.overlap_bound = 1e-6 / static_cast<double>(1 + front.measured.rows.size());
            row.on_overlap_front = true;
            row.ticks = 1500;
            front.measured.rows.push_back(row);
        }
        file.fronts.push_back({plan->conditions[0].name, run::conditionMark(plan->conditions[0]), front});
        std::ofstream(run::frontPath(fileOf(study))) << run::frontFileText(file);
    }
};

TEST_F(StoredFront, IsShownWithItsOriginUntilItIsMeasuredHere) {
    // Truth: closed form: the three rows that were written.
    waitFor([&] { return !points().isEmpty(); });
    ASSERT_EQ(points().size(), 3);
    EXPECT_EQ(textOf("frontOrigin"),
              "Measured on another machine (an abacus) by passung " PASSUNG_VERSION ", 0123abc on 2026-01-02.");
    EXPECT_GE(findPoint("god_object", "closed_form"), 0);
    shot("accuracy_stored");
    measure();
    EXPECT_GT(points().size(), 3);
    EXPECT_EQ(textOf("frontOrigin"), "(not shown)");
    click("study-other");
    openPart(3);
    waitFor([&] { return textOf("accuracyTold") != "(not shown)"; });
    EXPECT_NE(textOf("accuracyTold").find("study.front.csv"), std::string::npos) << textOf("accuracyTold");
}

TEST_F(StoredFront, OfTheStudyThatTheConsoleOpensWithIsReadToo) {
    // Truth: closed form: what was written beside the first study of the folder.
    open("en", true);
    openPart(3);
    waitFor([&] { return textOf("accuracyTold") != "(not shown)"; });
    EXPECT_NE(textOf("accuracyTold").find("other/study.front.csv"), std::string::npos) << textOf("accuracyTold");
}

TEST_F(AccuracyPage, TheKeyboardGoesAlongTheFrontAndThroughTheTable) {
    // Truth: invariant: keys of the picture reach exactly what is on the front, from fast to slow; those of the table
    // every line.
    measure();
    QQuickItem* plot = item(app_->experimenter(), "frontPlot");
    ASSERT_NE(plot, nullptr);
    plot->forceActiveFocus();
    std::vector<int> seen, front;
    for (int i = 0; i < points().size(); ++i)
        if (point(i)["front"].toBool()) front.push_back(i);
    for (std::size_t i = 0; i < front.size() + 1; ++i) {
        pressKey(Qt::Key_Right);
        if (seen.empty() || seen.back() != app_->accuracy().chosen()) seen.push_back(app_->accuracy().chosen());
    }
    EXPECT_EQ(seen, front);
    item(app_->experimenter(), "accuracyTable")->forceActiveFocus();
    for (int i = 0; i < points().size(); ++i) pressKey(Qt::Key_Up);
    EXPECT_EQ(app_->accuracy().chosen(), 0);
    pressKey(Qt::Key_Down);
    EXPECT_EQ(app_->accuracy().chosen(), 1);
    click("language");
    click("theme");
    click("study-small");
    EXPECT_FALSE(points().isEmpty());
    shot("accuracy_front_de_light");
}

TEST_F(AccuracyPage, CancelledNothingIsShownAndAClosedWindowWaitsForNothing) {
    // Truth: invariant
    click("measureAccuracy");
    waitFor([&] { return app_->accuracy().work()["share"].toDouble() > 0.15; });
    click("cancelAccuracy");
    waitFor([&] { return !measuring(); });
    EXPECT_TRUE(points().isEmpty());
    EXPECT_EQ(textOf("accuracyTold"), "(not shown)");
    click("measureAccuracy");
    waitFor([&] { return app_->accuracy().work()["share"].toDouble() > 0.15; });
    bool quits = false;
    QObject::connect(qmlEngine(app_->experimenter()), &QQmlEngine::quit, app_->experimenter(), [&] { quits = true; });
    app_->experimenter()->close();
    EXPECT_TRUE(quits);
    app_.reset();
}

TEST_F(AccuracyPage, RealPartsAreNotMeasuredAndASessionHasTheMachineForItself) {
    // Truth: invariant: what is measured ends with the first news of a session, and says why.
    std::string real = oneMethodStudy();
    real.replace(real.find("\"task.timeout_s\" = 19"), 21,
                 R"("task.timed_by" = "experimenter", "feedback.kinesthetic" = false)");
    write("other", real);
    app_->studies().reload();
    ASSERT_TRUE(app_->studies().cards()[0].toMap()["sound"].toBool());
    click("study-other");
    click("measureAccuracy");
    waitFor([&] { return !measuring(); });
    EXPECT_EQ(textOf("accuracyTold"), "The trials of this condition are done with real parts: choose another one.");
    app_->accuracy().setCondition(1);
    click("measureAccuracy");
    waitFor([&] { return app_->accuracy().work()["share"].toDouble() > 0.15; });
    app_->studies().tryOut(1, true, "en");  // of the other study
    waitFor([&] { return !measuring(); });
    EXPECT_TRUE(points().isEmpty());
    app_->desk().close();
    waitFor([&] { return textOf("accuracyTold") == "Measuring was given up, since a session began."; });
}

TEST_F(AccuracyPage, WhatCannotBeWrittenIsSaidInOneSentence) {
    // Truth: closed form: the line of the factor's key; a line that somebody added meanwhile.
    measure();
    app_->accuracy().choose(findPoint("penalty", "field"));
    std::ofstream(fileOf("small"), std::ios::app) << "# a word\n";
    use();
    EXPECT_EQ(textOf("accuracyTold"),
              "Nothing was written: the file has changed since it was measured. Read it again and measure.");
    click("study-other");
    measure();
    app_->accuracy().choose(findPoint("god_object", "field"));
    const std::string text = contents(fileOf("other"));
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(text.find("\"penalty\"")), '\n');
    use();
    EXPECT_EQ(textOf("accuracyTold"), "Nothing was written: contact.method is set at study.toml:" +
                                          std::to_string(line) + ", by a factor, a block or a staircase.");
    shot("accuracy_refused");
    EXPECT_EQ(contents(fileOf("other")), text);
}

}  // namespace
}  // namespace passung::test
