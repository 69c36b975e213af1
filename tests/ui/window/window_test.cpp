#include <gtest/gtest.h>

#include <QtCore/QCoreApplication>
#include <QtGui/QGuiApplication>
#include <QtGui/QImage>
#include <QtGui/QVector3D>
#include <QtQuick/QQuickItem>
#include <QtTest/QTest>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "tests/support/temp_folder.h"
#include "ui/window/app.h"

// Goes through the real windows as people do, by mouse and keyboard, and looks at the pixels. Waits for what happens,
// never for a time. With PASSUNG_SHOTS=FOLDER every picture that is looked at is kept there.

namespace passung {
namespace {

using presenter::RunState;
using window::App;

QStringList warnings;

void collectWarnings(QtMsgType type, const QMessageLogContext&, const QString& text) {
    if (type != QtDebugMsg && type != QtInfoMsg) warnings.append(text);
}

/// The windows, in a folder of their own.
class Windows : public testing::Test {
protected:
    static void SetUpTestSuite() {
        static int argc = 1;
        static char name[] = "window_test";
        static char* argv[] = {name, nullptr};
        if (qApp == nullptr) new QGuiApplication(argc, argv);
        qInstallMessageHandler(collectWarnings);
    }

    void SetUp() override {
        warnings.clear();
        open("en", true);
    }

    void open(const char* language, bool dark) {
        app_.reset();
        app_ = std::make_unique<App>(window::AppOptions{.protocols = PASSUNG_SOURCE_DIR "/protocols",
                                                        .data = folder_ / "data",
                                                        .language = language,
                                                        .dark = dark});
        waitFor([&] { return app_->experimenter()->isExposed(); });
    }

    void TearDown() override {
        app_.reset();
        EXPECT_TRUE(warnings.isEmpty()) << warnings.join("\n").toStdString();
    }

    template <class Condition>
    void waitFor(const Condition& condition) {
        while (!condition()) QCoreApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents, 5);
    }

    void waitFor(RunState state) {
        waitFor([&] {
            const RunState now = run().view().state;
            return now == state || now == RunState::Failed;
        });
        ASSERT_EQ(run().view().state, state) << run().view().told;
    }

    const presenter::Run& run() const { return app_->desk().run(); }

    QQuickItem* item(QQuickWindow* in, const char* name) const {
        std::function<QQuickItem*(QQuickItem*)> find = [&](QQuickItem* below) -> QQuickItem* {
            if (below->objectName() == name && below->isVisible()) return below;
            for (QQuickItem* child : below->childItems())
                if (QQuickItem* found = find(child)) return found;
            return nullptr;
        };
        return find(in->contentItem());
    }

    void click(const char* name) {
        QQuickItem* target = item(app_->experimenter(), name);
        ASSERT_NE(target, nullptr) << name;
        const QPointF centre = target->mapToScene({target->width() / 2, target->height() / 2});
        QTest::mouseClick(app_->experimenter(), Qt::LeftButton, {}, centre.toPoint());
    }

    /// Drags by `step` again and again; a trial that ends meanwhile takes the part back to its start.
    template <class Condition>
    void dragUntil(Qt::MouseButton button, const QPoint& from, const QPoint& step, const Condition& condition) {
        QWindow* window = app_->participant();
        while (!condition()) {
            QTest::mousePress(window, button, {}, from);
            for (int i = 1; i <= 6; ++i) QTest::mouseMove(window, from + i * step);
            QTest::mouseRelease(window, button, {}, from + 6 * step);
            const std::int64_t tick = run().last() ? run().last()->tick : 0;
            waitFor([&] { return run().last() && (run().last()->tick > tick + 300 || run().last()->tick < tick); });
        }
    }

    void pressKey(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
        QTest::keyClick(app_->experimenter(), key, modifiers);
    }

    QImage picture(QQuickWindow* of, const char* name) {
        const QImage image = of->grabWindow().convertToFormat(QImage::Format_RGB32);
        if (const char* folder = std::getenv("PASSUNG_SHOTS")) image.save(QString("%1/%2.png").arg(folder, name));
        return image;
    }

    test::TempFolder folder_;
    std::unique_ptr<App> app_;
};

/// How many pixels have about this colour.
int pixelsLike(const QImage& image, const QColor& colour, int tolerance = 24) {
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
        const auto* line = reinterpret_cast<const QRgb*>(image.constScanLine(y));
        for (int x = 0; x < image.width(); ++x)
            if (std::abs(qRed(line[x]) - colour.red()) <= tolerance &&
                std::abs(qGreen(line[x]) - colour.green()) <= tolerance &&
                std::abs(qBlue(line[x]) - colour.blue()) <= tolerance)
                ++count;
    }
    return count;
}

/// The middle of all pixels of the held part's hue.
QPointF heldPart(const QImage& image) {
    double x_sum = 0.0, y_sum = 0.0, count = 0.0;
    for (int y = 0; y < image.height(); ++y) {
        const auto* line = reinterpret_cast<const QRgb*>(image.constScanLine(y));
        for (int x = 0; x < image.width(); ++x) {
            const int r = qRed(line[x]), g = qGreen(line[x]), b = qBlue(line[x]);
            if (r < 90 || r - b < 60 || r - g < 15) continue;
            x_sum += x, y_sum += y, ++count;
        }
    }
    return count < 50.0 ? QPointF(-1, -1) : QPointF(x_sum / count, y_sum / count);
}

TEST_F(Windows, TwoClicksLeadToARunningTrialThatTheMouseMoves) {
    // Truth: invariant. The part on the participant's screen goes where it is dragged, and the stored attempts follow
    // the experimenter's commands.
    picture(app_->experimenter(), "studies");
    click("study-peg_in_hole");
    click("tryOut");
    waitFor(RunState::Running);
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
    waitFor(RunState::Running);
    app_->experimenter()->requestActivate();
    waitFor([&] { return app_->experimenter()->isActive(); });
    waitFor([&] { return run().view().force_N > 0.5; });
    picture(app_->experimenter(), "session_watched");
    pressKey(Qt::Key_Escape);
    waitFor(RunState::Stopped);
    const QImage stopped = picture(app_->experimenter(), "session_stopped");
    EXPECT_GT(pixelsLike(stopped.copy(20, 60, 12, 120), app_->look().bad()), 300) << "the state line is not marked";
    EXPECT_EQ(run().view().rows[0].state, presenter::RowState::Next);
    EXPECT_EQ(run().view().rows[0].attempts, 1);

    click("language");
    EXPECT_EQ(item(app_->experimenter(), "stateLine")->property("text").toString(), "Not-Halt: Motoren sind aus");
    click("theme");
    EXPECT_GT(pixelsLike(picture(app_->experimenter(), "session_stopped_de_light"), app_->look().panel(), 4), 200'000);

    pressKey(Qt::Key_K, Qt::ControlModifier);
    waitFor([&] { return run().view().rows[0].state == presenter::RowState::Skipped; });
    pressKey(Qt::Key_P, Qt::ControlModifier);
    waitFor(RunState::Running);
    EXPECT_EQ(run().view().number, 2);
    picture(app_->participant(), "participant_de_light");
    click("page0");
    picture(app_->experimenter(), "studies_de_light");
}

}  // namespace
}  // namespace passung

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
