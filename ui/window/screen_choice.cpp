#include "ui/window/screen_choice.h"

#include <QtGui/QGuiApplication>
#include <QtGui/QScreen>

namespace passung::window {

namespace {

const QString kKey = QStringLiteral("participantScreen");

}  // namespace

ScreenChoice::ScreenChoice(Desk& desk, Screen& screen, QSettings& memory)
    : desk_(desk), screen_(screen), memory_(memory) {
    connect(&desk_, &Desk::opened, this, &ScreenChoice::place);
    connect(&desk_, &Desk::displayWanted, this, &ScreenChoice::place);
}

void ScreenChoice::attach(QQuickWindow* experimenter, QQuickWindow* participant) {
    experimenter_ = experimenter;
    participant_ = participant;
    const auto* application = static_cast<const QGuiApplication*>(QGuiApplication::instance());
    connect(application, &QGuiApplication::screenAdded, this, &ScreenChoice::changed);
    connect(application, &QGuiApplication::screenRemoved, this, &ScreenChoice::lose);
    for (const auto moved : {&QWindow::xChanged, &QWindow::yChanged})
        connect(experimenter_, moved, this, &ScreenChoice::changed);
    emit changed();
}

QList<ScreenArea> ScreenChoice::screens() const {
    QList<ScreenArea> all;
    for (const QScreen* screen : QGuiApplication::screens()) all.append({screen->name(), screen->geometry()});
    return all;
}

QRect ScreenChoice::experimenterPlace() const { return experimenter_ == nullptr ? QRect() : experimenter_->geometry(); }

QStringList ScreenChoice::names() const {
    const QList<ScreenArea> all = screens();
    QStringList names;
    for (const qsizetype i : freeScreens(all, experimenterPlace())) names.append(all[i].name);
    return names;
}

int ScreenChoice::chosen() const {
    const QList<ScreenArea> all = screens();
    const auto own = participantScreen(all, experimenterPlace(), memory_.value(kKey).toString());
    return own ? static_cast<int>(names().indexOf(all[*own].name)) : -1;
}

void ScreenChoice::choose(int index) {
    if (index < 0 || index >= names().size() || index == chosen()) return;
    memory_.setValue(kKey, names().at(index));
    place();
    emit changed();
}

/// On a screen of their own, if there is one, the participant sees nothing else.
void ScreenChoice::place() {
    if (participant_ == nullptr) return;
    const QList<ScreenArea> all = screens();
    const auto own = participantScreen(all, experimenterPlace(), memory_.value(kKey).toString());
    if (own && participant_->geometry() != all[*own].area) {
        screen_.setFullScreen(false);  // a window that fills a screen is not moved
        participant_->setScreen(QGuiApplication::screens().at(*own));
        participant_->setGeometry(all[*own].area);
    }
    screen_.setFullScreen(own.has_value());
}

/// The system moves what was on a screen that is gone to one that is left: the participant's window would cover the
/// experimenter's.
void ScreenChoice::lose(const QScreen* gone) {
    if (screen_.property("fullScreen").toBool() && participant_->screen() == gone) screen_.closed();
    emit changed();
}

}  // namespace passung::window
