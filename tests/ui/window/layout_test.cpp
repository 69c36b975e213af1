#include <QtQuick/QQuickItem>
#include <set>

#include "tests/ui/window/windows.h"
#include "ui/window/places.h"

// The form of the windows: nothing is cut, everything is reached by keyboard, places are remembered.

namespace passung::test {
namespace {

using presenter::RunState;

void visit(QQuickItem* item, const std::function<void(QQuickItem*)>& look_at) {
    if (!item->isVisible()) return;
    look_at(item);
    for (QQuickItem* child : item->childItems()) visit(child, look_at);
}

bool isControl(const QQuickItem& item) {
    for (const char* kind : {"QQuickAbstractButton", "QQuickTextField", "QQuickTextArea", "QQuickSlider",
                             "QQuickSpinBox", "QQuickComboBox", "QQuickTextInput", "QQuickTextEdit"})
        if (item.inherits(kind)) return item.isEnabled() && item.property("readOnly") != true;
    return false;
}

/// What holds a text and may be too small for it: the nearest button or clipping item, else the window.
QRectF roomOf(const QQuickItem& text) {
    for (QQuickItem* above = text.parentItem(); above != nullptr; above = above->parentItem()) {
        if (above->inherits("QQuickFlickable")) return {};  // what does not fit is scrolled to
        if (above->clip() || above->inherits("QQuickAbstractButton") || above->parentItem() == nullptr)
            return above->mapRectToScene({0, 0, above->width(), above->height()});
    }
    return {};
}

/// The texts of a window of which something cannot be read, each with why.
QStringList cutTexts(QQuickWindow* window) {
    QStringList cut;
    QList<std::pair<QRectF, QString>> seen;
    visit(window->contentItem(), [&](QQuickItem* item) {
        if (!item->inherits("QQuickText") || item->property("text").toString().isEmpty()) return;
        const double width = item->property("contentWidth").toDouble();
        const double height = item->property("contentHeight").toDouble();
        QString why;
        if (item->property("truncated").toBool()) why = "ends in dots";
        if (width > item->width() + 1.0) why = QString("is %1 wide in %2").arg(width).arg(item->width());
        if (height > item->height() + 1.0) why = QString("is %1 high in %2").arg(height).arg(item->height());
        const QRectF room = roomOf(*item).adjusted(-1, -1, 1, 1);
        const QRectF own = item->mapRectToScene({0, 0, item->width(), item->height()});
        if (room.width() > 2.0 && !room.contains(own))
            why = QString("lies at %1 to %2, %3 to %4 in room for %5 to %6, %7 to %8")
                      .arg(own.left())
                      .arg(own.right())
                      .arg(own.top())
                      .arg(own.bottom())
                      .arg(room.left())
                      .arg(room.right())
                      .arg(room.top())
                      .arg(room.bottom());
        const QRectF ink = item->mapRectToScene({0, 0, width, height}).adjusted(1, 1, -1, -1);
        const bool scrolled = roomOf(*item).isEmpty();
        for (const auto& [other, words] : seen)
            if (!scrolled && other.intersects(ink) && item->property("horizontalAlignment").toInt() == Qt::AlignLeft)
                why = "lies upon " + words;
        if (!scrolled) seen.append({ink, item->property("text").toString()});
        if (!why.isEmpty()) cut.append(item->property("text").toString() + ": " + why);
    });
    return cut;
}

/// Controls that can be used and that Tab does not come to.
QStringList unreached(QQuickWindow* window) {
    std::set<QQuickItem*> reached;
    for (int i = 0; i < 400; ++i) {
        QTest::keyClick(window, Qt::Key_Tab);
        QQuickItem* now = window->activeFocusItem();
        if (now != nullptr && !reached.insert(now).second) break;
    }
    QStringList missing;
    visit(window->contentItem(), [&](QQuickItem* item) {
        if (isControl(*item) && !reached.contains(item))
            missing.append(item->objectName() + " " + item->property("text").toString());
    });
    return missing;
}

class Layout : public Windows {
protected:
    void expectWhole(QQuickWindow* window, const char* where) {
        QCoreApplication::processEvents();
        picture(window, where);  // which lays everything out
        EXPECT_EQ(cutTexts(window).join("\n").toStdString(), "") << where << ", " << app_->language().toStdString();
    }
};

TEST_F(Layout, NoTextIsCutAtLargeTypeInEitherLanguage) {
    // Truth: invariant. The sizes that the texts ask for, against those that they have.
    for (const char* language : {"en", "de"}) {
        open(language, true);
        app_->look().setScale(1.25);
        QQuickWindow* console = app_->experimenter();
        expectWhole(console, "large_studies");
        click("study-peg_in_hole");
        click("watch");
        waitFor(RunState::Running);
        expectWhole(console, "large_session");
        expectWhole(app_->participant(), "large_participant");
        app_->desk().command({.kind = session::CommandKind::Pause, .now = true});
        waitFor(RunState::Paused);
        expectWhole(console, "large_session_paused");
        expectWhole(app_->participant(), "large_participant_paused");
        app_->participant()->close();
        waitFor([&] { return run().view().display == presenter::Display::Closed; });
        expectWhole(console, "large_session_closed");
    }
}

TEST_F(Layout, TabComesToEveryControlOfEveryPage) {
    // Truth: invariant.
    QQuickWindow* console = app_->experimenter();
    console->requestActivate();
    waitFor([&] { return console->isActive(); });
    EXPECT_EQ(unreached(console).join("\n").toStdString(), "") << "studies";
    click("study-peg_in_hole");
    click("watch");
    waitFor(RunState::Running);
    console->requestActivate();
    waitFor([&] { return console->isActive(); });
    EXPECT_EQ(unreached(console).join("\n").toStdString(), "") << "session";
}

TEST_F(Layout, WindowsStandWhereTheyStood) {
    // Truth: invariant. What is not open has no place that could be remembered.
    const QRect place(60, 40, 1300, 820);
    window::Places places(QString::fromStdString(folder_ / "places.ini"));
    QWindow before, hidden, after;
    before.setGeometry(place);
    before.show();
    places.keep("console", before);
    hidden.setGeometry(QRect(5, 5, 100, 100));
    places.keep("console", hidden);
    places.restore("console", after);
    EXPECT_EQ(after.geometry(), place);
    EXPECT_FALSE(app_->screen().property("fullScreen").toBool()) << "there is one screen";
}

TEST(Places, TheParticipantGetsTheScreenThatTheExperimenterIsNotOn) {
    // Truth: closed form.
    const QRect left(0, 0, 1920, 1080), right(1920, 0, 1280, 1024);
    EXPECT_EQ(window::participantScreen({left, right}, QRect(100, 100, 800, 600)), 1);
    EXPECT_EQ(window::participantScreen({left, right}, QRect(2000, 0, 800, 600)), 0);
    EXPECT_EQ(window::participantScreen({left, right}, QRect(1800, 0, 800, 600)), 0) << "its middle counts";
    EXPECT_EQ(window::participantScreen({left}, QRect(0, 0, 800, 600)), std::nullopt);
}

}  // namespace
}  // namespace passung::test
