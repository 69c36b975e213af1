#pragma once

#include <QtCore/QObject>
#include <QtCore/QTimer>
#include <memory>
#include <optional>

#include "ui/app/live_session.h"
#include "ui/presenter/run.h"
#include "ui/window/speaker.h"

namespace passung::window {

/// Between the running session and the windows: brings news and ticks to the presenter at the display's rate and tells
/// the windows to look. The session never waits for it.
class Desk : public QObject {
    Q_OBJECT

public:
    /// `data`: folder for the databases of try-outs.
    explicit Desk(std::string data);
    ~Desk() override;

    /// A session of the study: a new one, or one that goes on.
    void start(const protocol::StudyPlan& plan, app::LiveOptions options);
    /// Only the trials, into a database of its own.
    void tryOut(const protocol::StudyPlan& plan, app::LiveHand hand, const std::string& language);
    void command(session::Command command);
    /// The participant's window shows this from now on; a running trial that nobody sees is paused.
    void setDisplay(presenter::Display display);
    /// Shows the participant's window again, whatever became of it.
    void openDisplay();
    /// Ends what runs; waits for the running step only.
    void close();

    const presenter::Run& run() const { return run_; }
    /// Where the mouse wants the held part; null: nobody moves it by mouse.
    mouse::Pointer* pointer();
    bool byMouse() const { return live_ && hand_ == app::LiveHand::Mouse; }
    /// That the participant is spoken to in.
    const std::string& language() const { return language_; }

    // What the participant answers, read and wants.
    void handIn(const std::string& form, session::FilledForm filled);
    void pageRead(std::int64_t page, std::int64_t read_ms);
    void goOn();

    /// The pictures of the participant's window.
    app::FrameClock& frames() { return frames_; }
    /// Where sound comes from; none: nowhere.
    std::optional<sound::SoundOutput> soundOutput() const { return sound_.output(); }

signals:
    void opened();    // another run
    void happened();  // news
    void frame();     // time for a new picture
    void sceneChanged();

private:
    void look();

    std::string data_;
    app::FrameClock frames_;
    sound::SoundFeed sound_;
    std::unique_ptr<Speaker> speaker_;  // once something is to be heard
    std::unique_ptr<app::LiveSession> live_;
    app::LiveHand hand_ = app::LiveHand::Mouse;
    std::string language_ = "en";
    presenter::Run run_;
    const void* drawn_ = nullptr;  // scene that the windows know
    QTimer timer_;
};

}  // namespace passung::window
