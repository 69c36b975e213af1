#include "ui/window/words.h"

#include <QtCore/QCoreApplication>

namespace passung::window {

using presenter::Display;
using presenter::OneOf;
using presenter::RowState;
using presenter::RunView;
using presenter::Why;
using session::CommandKind;
namespace state = presenter::state;

namespace {

QString said(const char* text) { return QCoreApplication::translate("words", text); }

/// The largest line, of each state.
struct Line {
    const RunView& view;

    QString trial(const char* text) const { return said(text).arg(view.number).arg(view.planned); }

    QString operator()(const state::Idle&) const { return said(QT_TRANSLATE_NOOP("words", "No session")); }
    QString operator()(const state::Opening&) const { return said(QT_TRANSLATE_NOOP("words", "Opening the study")); }
    QString operator()(const OneOf<state::Preparing, state::AwaitingPicture> auto&) const {
        return trial(QT_TRANSLATE_NOOP("words", "Trial %1 of %2 is being prepared"));
    }
    QString operator()(const state::ToStart&) const {
        if (view.brief.timed_by == plan::TimedBy::Experimenter)
            return trial(QT_TRANSLATE_NOOP("words", "Trial %1 of %2 waits for Start"));
        return trial(QT_TRANSLATE_NOOP("words", "Trial %1 of %2 waits for the start pose"));
    }
    QString operator()(const state::Running&) const {
        return trial(QT_TRANSLATE_NOOP("words", "Trial %1 of %2 is running"));
    }
    QString operator()(const state::Between&) const { return said(QT_TRANSLATE_NOOP("words", "Between trials")); }
    QString operator()(const state::Consenting&) const {
        return said(QT_TRANSLATE_NOOP("words", "The participant decides on consent"));
    }
    QString operator()(const state::ReadingPage&) const {
        return said(QT_TRANSLATE_NOOP("words", "The participant reads instructions"));
    }
    QString operator()(const state::Answering&) const {
        return said(QT_TRANSLATE_NOOP("words", "The participant answers a questionnaire"));
    }
    QString operator()(const state::Resting&) const {
        return said(QT_TRANSLATE_NOOP("words", "The participant rests"));
    }
    QString operator()(const state::Ready&) const { return said(QT_TRANSLATE_NOOP("words", "Ready to start")); }
    QString operator()(const state::Paused&) const {
        if (view.display == Display::Closed)
            return said(QT_TRANSLATE_NOOP("words", "Paused: the participant's window is closed"));
        if (view.display == Display::Lost)
            return said(QT_TRANSLATE_NOOP("words", "Paused: the participant's picture is lost"));
        return said(QT_TRANSLATE_NOOP("words", "Paused"));
    }
    QString operator()(const state::Stopped&) const {
        return said(QT_TRANSLATE_NOOP("words", "Emergency stop: motors are off"));
    }
    QString operator()(const state::Complete&) const { return said(QT_TRANSLATE_NOOP("words", "Session complete")); }
    QString operator()(const state::Incomplete&) const {
        return said(QT_TRANSLATE_NOOP("words", "Session ended early"));
    }
    QString operator()(const state::Failed&) const { return said(QT_TRANSLATE_NOOP("words", "The session failed")); }
};

/// The line below it.
struct Detail {
    const RunView& view;

    QString operator()(const state::Preparing& preparing) const {
        if (!preparing.built) return condition();
        return said(QT_TRANSLATE_NOOP("words", "models of the parts are built: %1 %"))
            .arg(qRound(100 * *preparing.built));
    }
    QString operator()(const OneOf<state::ToStart, state::Running> auto&) const { return condition(); }
    QString operator()(const state::AwaitingPicture&) const {
        return said(QT_TRANSLATE_NOOP("words", "waits for the participant's picture"));
    }
    QString operator()(const state::Resting& resting) const {
        if (resting.rest.seconds > 0)
            return said(QT_TRANSLATE_NOOP("words", "at least %1 s more")).arg(resting.rest.seconds);
        return said(QT_TRANSLATE_NOOP("words", "the participant may go on"));
    }
    QString operator()(const state::Paused&) const {
        if (view.session.awaited_device.empty()) return next();
        return said(QT_TRANSLATE_NOOP("words", "change to the device %1, then continue"))
            .arg(QString::fromStdString(view.session.awaited_device));
    }
    QString operator()(const OneOf<state::Stopped, state::Between> auto&) const { return next(); }
    QString operator()(const OneOf<state::Complete, state::Incomplete> auto&) const {
        return said(QT_TRANSLATE_NOOP("words", "%1 of %2 trials are finished and stored"))
            .arg(view.finished)
            .arg(view.planned);
    }
    QString operator()(const state::Failed& failed) const { return QString::fromStdString(failed.why); }
    QString operator()(const OneOf<state::Idle, state::Opening, state::Ready, state::Answering, state::Consenting,
                                   state::ReadingPage> auto&) const {
        return {};
    }

    QString condition() const { return QString::fromStdString(view.condition); }
    QString next() const {
        if (view.number > 0) return said(QT_TRANSLATE_NOOP("words", "next: trial %1")).arg(view.number);
        return {};
    }
};

}  // namespace

QString stateLine(const RunView& view) { return std::visit(Line{view}, view.state); }

QString stateDetail(const RunView& view) {
    if (view.session.pauses_after) return said(QT_TRANSLATE_NOOP("words", "pauses after this trial"));
    return std::visit(Detail{view}, view.state);
}

QString stepWord(measures::StepState state) {
    using measures::StepState;
    switch (state) {
        case StepState::Idle:
            return said(QT_TRANSLATE_NOOP("words", "to do"));
        case StepState::Picked:
            return said(QT_TRANSLATE_NOOP("words", "picked up"));
        case StepState::Carried:
            return said(QT_TRANSLATE_NOOP("words", "carried"));
        case StepState::Near:
            return said(QT_TRANSLATE_NOOP("words", "near its place"));
        case StepState::Inserted:
            return said(QT_TRANSLATE_NOOP("words", "in place, held"));
        case StepState::Locked:
            break;
    }
    return said(QT_TRANSLATE_NOOP("words", "done"));
}

QString rowWord(RowState state) {
    switch (state) {
        case RowState::Waiting:
            return said(QT_TRANSLATE_NOOP("words", "to come"));
        case RowState::Next:
            return said(QT_TRANSLATE_NOOP("words", "next"));
        case RowState::Running:
            return said(QT_TRANSLATE_NOOP("words", "running"));
        case RowState::Success:
            return said(QT_TRANSLATE_NOOP("words", "succeeded"));
        case RowState::Timeout:
            return said(QT_TRANSLATE_NOOP("words", "timed out"));
        case RowState::Failure:
            return said(QT_TRANSLATE_NOOP("words", "failed"));
        case RowState::Aborted:
            return said(QT_TRANSLATE_NOOP("words", "aborted"));
        case RowState::Skipped:
            return said(QT_TRANSLATE_NOOP("words", "left out"));
        case RowState::Invalid:
            break;
    }
    return said(QT_TRANSLATE_NOOP("words", "does not count"));
}

QString rowSign(RowState state) {
    switch (state) {
        case RowState::Waiting:
            return QStringLiteral("·");
        case RowState::Next:
        case RowState::Running:
            return QStringLiteral("▶");
        case RowState::Success:
            return QStringLiteral("✓");
        case RowState::Timeout:
            return QStringLiteral("◷");
        case RowState::Skipped:
            return QStringLiteral("–");
        case RowState::Failure:
        case RowState::Aborted:
        case RowState::Invalid:
            break;
    }
    return QStringLiteral("✕");
}

QString whyNot(Why why) {
    switch (why) {
        case Why::Possible:
            return {};
        case Why::NoSession:
            return said(QT_TRANSLATE_NOOP("words", "No session is running."));
        case Why::BegunAlready:
            return said(QT_TRANSLATE_NOOP("words", "The session has begun already."));
        case Why::NotBegun:
            return said(QT_TRANSLATE_NOOP("words", "The session has not begun."));
        case Why::NotPaused:
            return said(QT_TRANSLATE_NOOP("words", "The session is not paused."));
        case Why::PausedAlready:
            return said(QT_TRANSLATE_NOOP("words", "The session is paused already."));
        case Why::PausesAlready:
            return said(QT_TRANSLATE_NOOP("words", "The session pauses after this trial already."));
        case Why::NothingEnded:
            return said(QT_TRANSLATE_NOOP("words", "No trial has ended yet."));
        case Why::RepeatedAlready:
            return said(QT_TRANSLATE_NOOP("words", "The trial is repeated already."));
        case Why::NothingLeft:
            return said(QT_TRANSLATE_NOOP("words", "No trial is left."));
        case Why::ClockNotStarted:
            return said(QT_TRANSLATE_NOOP("words", "The trial's clock has not been started."));
        case Why::NeedsText:
            return said(QT_TRANSLATE_NOOP("words", "It needs a text."));
        case Why::UnknownAttempt:
            return said(QT_TRANSLATE_NOOP("words", "That is not the newest attempt at a trial of this session."));
        case Why::CountsNot:
            return said(QT_TRANSLATE_NOOP("words", "The attempt does not count anyway."));
        case Why::CannotBeKept:
            return said(QT_TRANSLATE_NOOP("words", "It cannot be stored."));
        case Why::DeviceAway:
            return said(
                QT_TRANSLATE_NOOP("words", "The device is gone: plug it in, and look whether its service runs."));
        case Why::NoTrial:
            break;
    }
    return said(QT_TRANSLATE_NOOP("words", "No trial is running."));
}

QString warningLine(const std::string& warning) {
    return said(QT_TRANSLATE_NOOP("words", "Warning: %1")).arg(QString::fromStdString(warning));
}

QString answerLine(const presenter::CommandAnswered& answered) {
    if (!answered.answer.accepted)
        return said(QT_TRANSLATE_NOOP("words", "Not possible now: %1")).arg(whyNot(answered.answer.why));
    switch (answered.command.kind) {
        case CommandKind::Start:
            return said(QT_TRANSLATE_NOOP("words", "The session begins."));
        case CommandKind::Pause:
            if (answered.answer.after_trial)
                return said(QT_TRANSLATE_NOOP("words", "The session pauses after the running trial."));
            return said(QT_TRANSLATE_NOOP("words", "The session is paused."));
        case CommandKind::Continue:
            return said(QT_TRANSLATE_NOOP("words", "The session goes on."));
        case CommandKind::Repeat:
            return said(QT_TRANSLATE_NOOP("words", "The trial is repeated."));
        case CommandKind::Skip:
            return said(QT_TRANSLATE_NOOP("words", "The trial is left out."));
        case CommandKind::Invalidate:
            return said(QT_TRANSLATE_NOOP("words", "The attempt does not count."));
        case CommandKind::Back:
            return said(QT_TRANSLATE_NOOP("words", "One trial back."));
        case CommandKind::Note:
            return said(QT_TRANSLATE_NOOP("words", "The note is stored."));
        case CommandKind::Abort:
            return said(QT_TRANSLATE_NOOP("words", "The session is ended."));
        case CommandKind::Done:
            return said(QT_TRANSLATE_NOOP("words", "The trial has succeeded."));
        case CommandKind::Failed:
            return said(QT_TRANSLATE_NOOP("words", "The trial has failed."));
        case CommandKind::Stop:
            break;
    }
    return said(QT_TRANSLATE_NOOP("words", "Motors are off; the session is paused."));
}

QString qualityLine(const presenter::QualityFound& found) {
    const presenter::PictureQuality& drawn = found.quality;
    const QString text =
        drawn.shadows ? said(QT_TRANSLATE_NOOP("words", "%1 × %2 pixels, %3 samples each, shadows: %4 a second"))
                      : said(QT_TRANSLATE_NOOP("words", "%1 × %2 pixels, %3 samples each, no shadows: %4 a second"));
    return text.arg(qRound(drawn.scale * found.width_px))
        .arg(qRound(drawn.scale * found.height_px))
        .arg(drawn.samples)
        .arg(found.pictures_per_s, 0, 'f', 0);
}

QString soundLine(const std::optional<sound::SoundOutput>& output) {
    if (!output) return said(QT_TRANSLATE_NOOP("words", "No sound: this computer has no output for it"));
    return said(QT_TRANSLATE_NOOP("words", "Sound: %1, delay %2 ms"))
        .arg(QString::fromStdString(output->name))
        .arg(1e-3 * output->delay_us, 0, 'f', 0);
}

QString phaseWord(const std::string& phase) {
    if (phase == "practice") return said(QT_TRANSLATE_NOOP("words", "practice"));
    if (phase == "catch") return said(QT_TRANSLATE_NOOP("words", "catch"));
    return said(QT_TRANSLATE_NOOP("words", "main"));
}

}  // namespace passung::window
