#include <QtCore/QThread>
#include <chrono>
#include <thread>

#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/ui/window/windows.h"
#include "tests/ui/window/x_person.h"

// An emergency stop while the thread that draws hangs, and who means one. Keys and mouse come from the X server.

namespace passung::test {
namespace {

namespace state = presenter::state;

class Stop : public Windows {
protected:
    /// A trial of somebody who is watched has just begun, and the console has the keyboard.
    void begin() {
        click("study-peg_in_hole");
        click("watch");
        waitFor<state::Running>();
        activate(app_->experimenter());
        waitFor([&] { return run().last()->tick > 300; });
    }

    /// The middle of the stop button on the screen.
    QPoint buttonPlace() {
        QQuickItem* button = item(app_->experimenter(), "stop");
        return button->mapToGlobal(QPointF(button->width() / 2, button->height() / 2)).toPoint();
    }

    /// Lets `act` happen after this time, while this thread, the windows', does nothing for `hangs` ms from then on.
    /// Returns when it had happened [ms]: a busy machine takes its time for it.
    template <class Act>
    int hang(int hangs, int after, const Act& act) {
        const auto start = std::chrono::steady_clock::now();
        std::thread person([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(after));
            act();
        });
        person.join();
        const auto acted = std::chrono::steady_clock::now() - start;
        QThread::msleep(static_cast<unsigned long>(hangs));
        return static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(acted).count());
    }

    std::vector<store::AttemptRow> attempts() {
        auto stored = store::StoreReader::open(folder_ / "data/peg_in_hole.db");
        if (!stored) throw std::runtime_error("no database");
        auto rows = stored->attempts();
        if (!rows) throw std::runtime_error("no attempts");
        return *rows;
    }

    std::int64_t stopsInTheData() {
        return store::Database(folder_ / "data/peg_in_hole.db", store::OpenMode::ReadOnly)
            .integer("SELECT count(*) FROM event WHERE event='command_stop'");
    }

    /// The first attempt is over, although no window has looked since: of the ticks of the time that the windows have
    /// hung most did not happen. How soon it was over is printed; it depends on what else the machine does.
    void expectStopped(std::int64_t tick_before, int after_ms, int hangs_ms) {
        const auto rows = attempts();
        ASSERT_EQ(rows.size(), 1u) << "nothing was stored while the windows hung";
        const std::int64_t ticks = rows[0].timing->ticks;
        EXPECT_EQ(rows[0].invalid_reason, "emergency stop");
        EXPECT_GE(ticks, tick_before);
        EXPECT_LT(ticks, tick_before + after_ms + hangs_ms / 2) << "as if the windows had to live again for it";
        std::printf("    stopped %lld ticks after the windows began to hang, asked for after %d ms\n",
                    static_cast<long long>(ticks - tick_before), after_ms);
    }

    XPerson person_;
};

TEST_F(Stop, EscTurnsTheMotorsOffWhileTheThreadThatDrawsHangsForTenSeconds) {
    // Truth: invariant. What the database holds before the windows live again; that one press is one stop.
    begin();
    const std::int64_t tick = run().last()->tick;
    const int after = hang(10'000, 1000, [&] { person_.pressEscape(); });
    expectStopped(tick, after, 10'000);
    waitFor<state::Stopped>();
    for (int i = 0; i < 20; ++i) QCoreApplication::processEvents(QEventLoop::AllEvents, 5);  // the window hears it now
    click("pause");                                                                          // goes on
    waitFor<state::Running>();
    EXPECT_EQ(stopsInTheData(), 1) << "the window's own press of the same key came as a second stop";
}

TEST_F(Stop, TheButtonTurnsTheMotorsOffWhereverTheWindowIsMoved) {
    // Truth: invariant. Beside the button, and where another program's window covers it, a press is none.
    begin();
    app_->experimenter()->setPosition(90, 60);
    waitFor([&] { return app_->experimenter()->position() == QPoint(90, 60) && buttonPlace().x() > 1000; });
    QCoreApplication::processEvents(QEventLoop::AllEvents, 50);
    const QPoint place = buttonPlace();
    const QQuickItem* button = item(app_->experimenter(), "stop");
    const int below = static_cast<int>(button->height() / 2) + 6;
    const std::int64_t earlier = run().last()->tick;
    hang(500, 500, [&] {
        person_.click(place.x(), place.y() + below);
        person_.openWindow(place.x() - 40, place.y() - 40, 80, 80);
        person_.click(place.x(), place.y());
    });
    person_.closeWindow();
    waitFor([&] { return run().last()->tick > earlier + 1000; });
    ASSERT_TRUE(run().view().is<state::Running>()) << "a press beside the button, or above it, has stopped";
    const std::int64_t tick = run().last()->tick;
    const int after = hang(2000, 500, [&] { person_.click(place.x(), place.y()); });
    expectStopped(tick, after, 2000);
    waitFor<state::Stopped>();
}

TEST_F(Stop, EscInAnotherProgramsWindowIsThatProgramsBusiness) {
    // Truth: invariant. The same key, once with the keyboard elsewhere, once in the participant's window.
    begin();
    person_.openWindow(0, 0, 50, 50);
    person_.pressEscape();
    const std::int64_t tick = run().last()->tick;
    waitFor([&] { return run().last()->tick > tick + 300; });
    EXPECT_TRUE(run().view().is<state::Running>());
    person_.closeWindow();
    person_.giveKeyboard(static_cast<std::uint32_t>(app_->participant()->winId()));
    const std::int64_t later = run().last()->tick;
    const int after = hang(2000, 200, [&] { person_.pressEscape(); });
    expectStopped(later, after, 2000);
    waitFor<state::Stopped>();
}

TEST(StopPath, WindowsRunOnXWhereverItIsAtHand) {
    // Truth: closed form. What the user asks for goes first.
    EXPECT_EQ(window::platformFor(":0", ""), "xcb;wayland");
    EXPECT_EQ(window::platformFor("", ""), "");
    EXPECT_EQ(window::platformFor(":0", "offscreen"), "offscreen");
}

/// Also run on a screen of 1280 × 720.
class SmallScreen : public Stop {
protected:
    void expectAtHand(const QString& where) {
        QQuickWindow* console = app_->experimenter();
        layOut(console->contentItem());
        const QRectF window(0, 0, console->width(), console->height());
        for (const char* name : {"stop", "pause", "start"}) {
            QQuickItem* button = item(console, name);
            ASSERT_NE(button, nullptr) << name;
            const QRectF place = button->mapRectToScene({0, 0, button->width(), button->height()});
            EXPECT_TRUE(window.contains(place))
                << name << " " << where.toStdString() << " bottom " << place.bottom() << " right " << place.right();
            EXPECT_GT(place.height(), 20.0);
            for (QQuickItem* above = button->parentItem(); above != nullptr; above = above->parentItem())
                if (above->clip()) {
                    EXPECT_TRUE(above->mapRectToScene({0, 0, above->width(), above->height()}).contains(place))
                        << name << " is scrolled away " << where.toStdString();
                }
            EXPECT_LE(wordWidth(button), button->width() - 4.0) << name << " is cut " << where.toStdString();
        }
    }
    /// Of the widest text in a button that is shown.
    static double wordWidth(QQuickItem* below) {
        double widest = 0.0;
        for (QQuickItem* child : below->childItems()) {
            if (!child->isVisible()) continue;
            widest = std::max({widest, wordWidth(child),
                               child->inherits("QQuickText") ? child->property("contentWidth").toDouble() : 0.0});
        }
        return widest;
    }
};

TEST_F(SmallScreen, StopPauseAndStartAreOnTheScreenAtAnyTextSizeInEitherLanguage) {
    // Truth: invariant. The items' rectangles against the window's, and the window's against the screen's.
    begin();
    QQuickWindow* console = app_->experimenter();
    const QRect screen = console->screen()->geometry();
    EXPECT_TRUE(screen.contains(console->geometry())) << "the window is larger than its screen";
    std::vector<QSize> sizes{console->size()};
    for (const QSize size : {QSize(1280, 720), QSize(1366, 768), QSize(1366, 720)})
        if (screen.width() >= size.width() && screen.height() >= size.height()) sizes.push_back(size);
    for (const char* language : {"de", "en"}) {
        app_->setLanguage(language);
        for (const double scale : {1.0, 1.5, 2.0}) {
            app_->look().setScale(scale);
            for (const QSize size : sizes) {
                console->setGeometry(QRect(screen.topLeft(), size));
                waitFor([&] { return QSizeF(console->contentItem()->size()).toSize() == size; });
                picture(console, qPrintable(QString("small_%1_%2_%3").arg(language).arg(scale).arg(size.height())));
                ASSERT_EQ(console->size(), size);
                expectAtHand(
                    QString("%1 x %2, text %3, %4").arg(size.width()).arg(size.height()).arg(scale).arg(language));
            }
        }
    }
}

}  // namespace
}  // namespace passung::test
