#include "ui/window/guide.h"

#include <QtCore/QCoreApplication>
#include <algorithm>

namespace passung::window {

using presenter::ParticipantScreen;
using Kind = presenter::TrialBrief::Kind;

Guide::Guide(Desk& desk, Speech& speech) : desk_(desk), speech_(speech) {
    connect(&desk_, &Desk::happened, this, &Guide::refresh);
    connect(&desk_, &Desk::frame, this, [this] {
        const auto view = presenter::participantView(desk_.run(), !desk_.byMouse());
        if (view.screen != view_.screen || view.interval != view_.interval || view.steps != view_.steps) refresh();
    });
}

void Guide::refresh() {
    view_ = presenter::participantView(desk_.run(), !desk_.byMouse());
    if (view_.screen != ParticipantScreen::Question) pressed_ = 0;
    if (const auto* page = desk_.run().view().page(); page != nullptr && reading() && page->number != page_) {
        page_ = page->number;
        page_clock_.start();
    }
    emit changed();
}

bool Guide::handling() const {
    return desk_.byMouse() && !desk_.run().view().is<presenter::state::AwaitingPicture>() &&
           (view_.screen == ParticipantScreen::ToStart || view_.screen == ParticipantScreen::Task ||
            view_.screen == ParticipantScreen::Question || view_.screen == ParticipantScreen::Idle ||
            view_.screen == ParticipantScreen::ByHand || view_.screen == ParticipantScreen::Wait);
}

QString Guide::taskLine() const {
    switch (view_.brief.kind) {
        case Kind::Insertion:
            return speech_(QT_TRANSLATE_NOOP("participant", "Put the part into the opening"));
        case Kind::Passage:
            return speech_(QT_TRANSLATE_NOOP("participant", "Move the part through the passage"));
        case Kind::Contour:
            return speech_(QT_TRANSLATE_NOOP("participant", "Follow the line"));
        case Kind::Placement:
            return speech_(QT_TRANSLATE_NOOP("participant", "Bring the part to its place"));
        case Kind::Assembly:
            return speech_(QT_TRANSLATE_NOOP("participant", "Put the parts together"));
        case Kind::Pair:
            break;
    }
    return view_.interval == 1 ? speech_(QT_TRANSLATE_NOOP("participant", "Feel the part: first"))
                               : speech_(QT_TRANSLATE_NOOP("participant", "Feel the part: second"));
}

QString Guide::line() const {
    switch (view_.screen) {
        case ParticipantScreen::Form:
        case ParticipantScreen::Page:
            return {};
        case ParticipantScreen::Welcome:
            return speech_(QT_TRANSLATE_NOOP("participant", "Welcome"));
        case ParticipantScreen::Wait:
            return speech_(QT_TRANSLATE_NOOP("participant", "One moment"));
        case ParticipantScreen::ToStart:
            return speech_(QT_TRANSLATE_NOOP("participant", "Move to the start"));
        case ParticipantScreen::Task:
            return taskLine();
        case ParticipantScreen::Question:
            return QString::fromStdString(view_.brief.question);
        case ParticipantScreen::ByHand:
            return view_.begun ? speech_(QT_TRANSLATE_NOOP("participant", "Go"))
                               : speech_(QT_TRANSLATE_NOOP("participant", "Take the real part"));
        case ParticipantScreen::Idle:
            return speech_(QT_TRANSLATE_NOOP("participant", "Leave the device at rest"));
        case ParticipantScreen::Rest:
            return speech_(QT_TRANSLATE_NOOP("participant", "Rest"));
        case ParticipantScreen::Swap:
            return speech_(QT_TRANSLATE_NOOP("participant", "Another device"));
        case ParticipantScreen::Pause:
            return speech_(QT_TRANSLATE_NOOP("participant", "Pause"));
        case ParticipantScreen::Thanks:
            break;
    }
    return speech_(QT_TRANSLATE_NOOP("participant", "Thank you!"));
}

QString Guide::keysLine() const {
    return speech_(QT_TRANSLATE_NOOP(
        "participant", "Keys: arrows and page up, down: move · W A S D Q E: turn · with Shift: slowly · Esc: stop"));
}

/// How a hand picks parts up, by mouse and keyboard.
QString Guide::pickLine() const {
    QString line =
        view_.brief.pick_on_press
            ? speech_(QT_TRANSLATE_NOOP("participant",
                                        "Drag: move · Shift: depth · Ctrl: turn · space bar: grip, again: let go"))
            : speech_(QT_TRANSLATE_NOOP(
                  "participant", "Drag: move · Shift: depth · Ctrl: turn · hold the space bar: grip, release: let go"));
    if (view_.brief.undo_button > 0)
        line += speech_(QT_TRANSLATE_NOOP("participant", " · backspace: take the last step back"));
    return line;
}

QVariantList Guide::steps() const {
    QVariantList all;
    if (!view_.scene) return all;
    using State = presenter::StepLine::State;
    for (const presenter::StepLine& step : view_.steps)
        all.append(QVariantMap{{"name", QString::fromStdString(step.name)},
                               {"done", step.state == State::Done},
                               {"next", step.state == State::Next},
                               {"hinted", step.hinted}});
    return all;
}

QString Guide::stepsLine() const {
    const auto done = std::count_if(view_.steps.begin(), view_.steps.end(), [](const presenter::StepLine& step) {
        return step.state == presenter::StepLine::State::Done;
    });
    return speech_(QT_TRANSLATE_NOOP("participant", "Steps: %1 of %2")).arg(done).arg(view_.steps.size());
}

QString Guide::hint() const {
    switch (view_.screen) {
        case ParticipantScreen::Welcome:
            return speech_(QT_TRANSLATE_NOOP("participant", "It begins in a moment."));
        case ParticipantScreen::ToStart:
            if (!view_.hands.empty() && view_.hands.front().part < 0)
                return speech_(QT_TRANSLATE_NOOP("participant", "Hold the gripper still where its pale image is."));
            return speech_(QT_TRANSLATE_NOOP("participant", "Hold the part still where its pale image is."));
        case ParticipantScreen::Task:
            if (!desk_.byMouse()) return {};
            if (view_.brief.kind == Kind::Placement)
                return speech_(QT_TRANSLATE_NOOP("participant",
                                                 "Drag: move · Shift: depth · Ctrl: turn · space bar: it is there")) +
                       "\n" + keysLine();
            if (view_.brief.pick_button > 0) return pickLine() + "\n" + keysLine();
            return speech_(QT_TRANSLATE_NOOP(
                       "participant",
                       "Drag: move · wheel or Shift + drag: depth · right button or Ctrl + drag: turn")) +
                   "\n" + keysLine();
        case ParticipantScreen::ByHand:
            if (view_.begun) return speech_(QT_TRANSLATE_NOOP("participant", "The experimenter stops the time."));
            return speech_(QT_TRANSLATE_NOOP("participant", "The experimenter says when to begin."));
        case ParticipantScreen::Idle:
            return speech_(QT_TRANSLATE_NOOP("participant", "Answer the signals only."));
        case ParticipantScreen::Rest:
            if (restSeconds() > 0 || !view_.rest) return {};
            if (mayGoOn()) return speech_(QT_TRANSLATE_NOOP("participant", "Go on when you are ready."));
            return speech_(QT_TRANSLATE_NOOP("participant", "It goes on in a moment."));
        case ParticipantScreen::Swap:
            return speech_(
                QT_TRANSLATE_NOOP("participant", "The experimenter sets it up. Please keep your hands away from it."));
        case ParticipantScreen::Pause:
            return speech_(
                QT_TRANSLATE_NOOP("participant", "You may let go. It goes on when the experimenter says so."));
        case ParticipantScreen::Thanks:
            return speech_(QT_TRANSLATE_NOOP("participant", "That was all. Please tell the experimenter."));
        case ParticipantScreen::Form:
        case ParticipantScreen::Page:
        case ParticipantScreen::Wait:
        case ParticipantScreen::Question:
            break;
    }
    return {};
}

QString Guide::result() const {
    const bool shown = view_.screen == ParticipantScreen::Wait || view_.screen == ParticipantScreen::ToStart;
    if (!view_.result || !shown) return {};
    const QString how = view_.result->success ? speech_(QT_TRANSLATE_NOOP("participant", "Success"))
                                              : speech_(QT_TRANSLATE_NOOP("participant", "Not this time"));
    return view_.result->time_s ? how + QStringLiteral(" · %1 s").arg(speech_.number(*view_.result->time_s, 1)) : how;
}

QString Guide::pageText() const {
    const auto* page = desk_.run().view().page();
    return page ? QString::fromStdString(page->text).trimmed() : QString();
}

QUrl Guide::pagePicture() const {
    const auto* page = desk_.run().view().page();
    return page && !page->picture.empty() ? QUrl::fromLocalFile(QString::fromStdString(page->picture)) : QUrl();
}

bool Guide::mayGoOn() const {
    return resting() && view_.rest->seconds == 0 && view_.rest->ends == plan::RestEnds::ByParticipant;
}

QString Guide::goOnWord() const {
    return reading() ? speech_(QT_TRANSLATE_NOOP("participant", "Understood"))
                     : speech_(QT_TRANSLATE_NOOP("participant", "Go on"));
}

QStringList Guide::answers() const {
    if (view_.screen != ParticipantScreen::Question) return {};
    return {speech_(QT_TRANSLATE_NOOP("participant", "The first")),
            speech_(QT_TRANSLATE_NOOP("participant", "The second"))};
}

void Guide::goOn() {
    if (reading()) desk_.pageRead(page_, page_clock_.elapsed());
    if (mayGoOn()) desk_.goOn();
}

void Guide::answer(int interval, bool down) {
    if (mouse::Pointer* pointer = desk_.pointer()) pointer->press(down ? static_cast<std::uint32_t>(interval) : 0u);
    if (down) pressed_ = interval;
    emit changed();
}

}  // namespace passung::window
