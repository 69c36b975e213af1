#include <QtQuick/QQuickItem>
#include <set>

#include "tests/ui/window/tour.h"
#include "ui/window/places.h"

// The form of the windows: nothing is cut, everything is reached by keyboard, places are remembered.

namespace passung::test {
namespace {

void visit(QQuickItem* item, const std::function<void(QQuickItem*)>& look_at) {
    if (!item->isVisible()) return;
    look_at(item);
    for (QQuickItem* child : item->childItems()) visit(child, look_at);
}

bool isControl(const QQuickItem& item) {
    for (const char* kind : {"QQuickAbstractButton", "QQuickTextField", "QQuickTextArea", "QQuickSlider",
                             "QQuickSpinBox", "QQuickComboBox", "QQuickTextInput", "QQuickTextEdit"})
        if (item.inherits(kind)) return item.isEnabled() && item.property("readOnly") != true;
    if (item.objectName() == "timeOnTrace") return false;  // the slider of the same page does that by keys
    return item.inherits("QQuickMouseArea") && item.property("enabled").toBool() &&
           item.acceptedMouseButtons() != Qt::NoButton;
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

/// Controls that can be used and that Tab does not come to. An area to click on has its keys at what holds it, like a
/// line of a list. Adds to `controls` how many there are.
QStringList unreached(QQuickWindow* window, int& controls) {
    std::set<const QQuickItem*> reached;
    for (int i = 0; i < 400; ++i) {
        QTest::keyClick(window, Qt::Key_Tab);
        const QQuickItem* now = window->activeFocusItem();
        if (now != nullptr && !reached.insert(now).second) break;
        for (; now != nullptr; now = now->parentItem())  // a list gives its focus to one of its lines
            if (now->activeFocusOnTab()) reached.insert(now);
    }
    QStringList missing;
    visit(window->contentItem(), [&](QQuickItem* item) {
        if (!isControl(*item)) return;
        ++controls;
        const QQuickItem* at = item;
        if (item->inherits("QQuickMouseArea"))
            while (at != nullptr && !reached.contains(at)) at = at->parentItem();
        if (!reached.contains(at))
            missing.append(QString("%1 %2 in %3")
                               .arg(item->metaObject()->className(),
                                    item->objectName() + item->property("text").toString(),
                                    item->parentItem()->objectName()));
    });
    return missing;
}

using Layout = Windows;
using Screens = Tour;

TEST_F(Screens, CutNoTextAtLargeTypeInEitherLanguage) {
    // Truth: invariant. The sizes that the texts ask for, against those that they have.
    for (const char* language : {"en", "de"})
        takeTour(language, true, 1.25, [&](QQuickWindow* window, const QString& screen) {
            QCoreApplication::processEvents();
            picture(window, qPrintable("large_" + screen + "_" + language));  // which lays everything out
            EXPECT_EQ(cutTexts(window).join("\n").toStdString(), "") << screen.toStdString() << ", " << language;
        });
}

TEST_F(Screens, HaveNoControlThatTabDoesNotComeTo) {
    // Truth: invariant. What reacts to a click, found by walking through all items.
    int controls = 0;
    takeTour("en", true, 1.0, [&](QQuickWindow* window, const QString& screen) {
        activate(window);
        picture(window, "tab");
        const QStringList missing = unreached(window, controls);
        EXPECT_EQ(missing.join("\n").toStdString(), "") << screen.toStdString();
    });
    EXPECT_GT(controls, 300) << "of all screens";
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

}  // namespace
}  // namespace passung::test
