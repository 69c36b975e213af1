#pragma once

#include <gtest/gtest.h>

#include <QtCore/QCoreApplication>
#include <QtCore/QElapsedTimer>
#include <QtCore/QThread>
#include <QtGui/QGuiApplication>
#include <QtGui/QImage>
#include <QtQuick/QQuickItem>
#include <QtTest/QTest>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include "tests/support/temp_folder.h"
#include "ui/window/app.h"

namespace passung::test {

inline QStringList warnings;

inline void collectWarnings(QtMsgType type, const QMessageLogContext&, const QString& text) {
    // Qt 6.4 says the latter of its own timer when a window goes; it is about nothing that a window of ours holds.
    if (type == QtDebugMsg || type == QtInfoMsg || text.startsWith("QUnifiedTimer::stopAnimationDriver")) return;
    warnings.append(text);
}

/// The real windows, in a folder of their own. Tests go through them as people do, by mouse and keyboard, and wait for
/// what happens, never for a time. With PASSUNG_SHOTS=FOLDER every picture that is looked at is kept there.
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
        app_ = std::make_unique<window::App>(window::AppOptions{.protocols = protocols_,
                                                                .data = data_,
                                                                .language = language,
                                                                .dark = dark,
                                                                .accuracy = {.repetitions = 1, .every = 100},
                                                                .quality = quality_});
        waitFor([&] { return app_->experimenter()->isExposed(); });
    }

    void TearDown() override {
        app_.reset();
        EXPECT_TRUE(warnings.isEmpty()) << warnings.join("\n").toStdString();
    }

    /// Throws if it takes minutes, so that what never happens ends this test and says so.
    template <class Condition>
    void waitFor(const Condition& condition) {
        constexpr int kLimit_ms = 300'000;
        QElapsedTimer waiting;
        waiting.start();
        while (!condition()) {
            if (waiting.hasExpired(kLimit_ms)) throw std::runtime_error("waited for minutes while " + whereItIs());
            QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
            QThread::msleep(1);  // of processor time others have use
        }
    }

    template <class State>
    void waitFor() {
        waitFor([&] { return run().view().is<State>() || run().view().isOver(); });
        ASSERT_TRUE(run().view().is<State>()) << whereItIs();
    }

    /// What the session is at, for who has waited in vain.
    std::string whereItIs() const {
        const presenter::RunView& view = run().view();
        return "the session was in state " + std::to_string(view.state.index()) + " at " +
               std::to_string(view.trial_s) + " s of trial " + std::to_string(view.number) + " of " +
               std::to_string(view.planned) + (app_->experimenter()->isActive() ? ", console active" : "") +
               (app_->participant()->isActive() ? ", participant's window active" : "") + "; " + view.failure();
    }

    const presenter::Run& run() const { return app_->desk().run(); }

    QQuickItem* item(QQuickItem* below, const char* name) const {
        if (below->objectName() == name && below->isVisible()) return below;
        for (QQuickItem* child : below->childItems())
            if (QQuickItem* found = item(child, name)) return found;
        return nullptr;
    }
    QQuickItem* item(QQuickWindow* in, const char* name) const { return item(in->contentItem(), name); }

    /// Puts everything where the next picture would have it.
    static void layOut(QQuickItem* below) {
        below->ensurePolished();
        for (QQuickItem* child : below->childItems()) layOut(child);
    }

    void click(QQuickWindow* in, const char* name) {
        QQuickItem* target = item(in, name);
        ASSERT_NE(target, nullptr) << name;
        layOut(in->contentItem());
        const QPointF centre = target->mapToScene({target->width() / 2, target->height() / 2});
        QTest::mouseClick(in, Qt::LeftButton, {}, centre.toPoint());
    }
    /// Lists make their lines with the next picture; the list of studies is scrolled to what is asked for.
    void click(const char* name) {
        waitFor([&] { return item(app_->experimenter(), name) != nullptr || scrollTo(name); });
        click(app_->experimenter(), name);
    }

    /// False: the list of studies does not hold it.
    bool scrollTo(const char* name) {
        QQuickItem* list = item(app_->experimenter(), "studies");
        if (list == nullptr) return false;
        for (int i = 0; i < list->property("count").toInt(); ++i) {
            QMetaObject::invokeMethod(list, "positionViewAtIndex", Q_ARG(int, i), Q_ARG(int, 4));  // ListView.Contain
            layOut(list);
            if (item(list, name) != nullptr) return true;
        }
        return false;
    }

    void activate(QQuickWindow* window) {
        // Asks again: a window that comes up meanwhile takes the focus.
        const auto isReady = [&] { return window->isExposed() && window->isActive(); };
        while (!isReady()) {
            window->requestActivate();
            QElapsedTimer waiting;
            waiting.start();
            waitFor([&] { return isReady() || waiting.hasExpired(2000); });
        }
    }

    void type(const char* into, const char* text) {
        click(into);
        QTest::keyClick(app_->experimenter(), Qt::Key_A, Qt::ControlModifier);
        for (const char* c = text; *c != 0; ++c) QTest::keyClick(app_->experimenter(), *c);
    }

    /// Waits for the database to be read or written.
    void settle() {
        waitFor([&] { return !app_->participants().busy() && !app_->records().busy(); });
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

    TempFolder folder_;
    std::string protocols_ = PASSUNG_SOURCE_DIR "/protocols";  // of the list of studies
    std::string data_ = folder_ / "data";
    std::optional<presenter::PictureQuality> quality_ =
        presenter::PictureQuality{true, 2, 1.0};  // none: as it is found
    std::unique_ptr<window::App> app_;
};

/// How many pixels have about this colour.
inline int pixelsLike(const QImage& image, const QColor& colour, int tolerance = 24) {
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
inline QPointF heldPart(const QImage& image) {
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

}  // namespace passung::test
