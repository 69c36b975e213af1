#pragma once

#include <QtCore/QElapsedTimer>
#include <QtCore/QObject>

#include "ui/presenter/pointer_motion.h"
#include "ui/window/desk.h"
#include "ui/window/scene_model.h"

namespace passung::window {

/// The participant's view state for QML, and their mouse and keys for the device. Millimetres.
class Screen : public SceneModel {
    Q_OBJECT
    Q_PROPERTY(bool shown READ shown NOTIFY stateChanged)  // the window
    Q_PROPERTY(bool fullScreen MEMBER full_screen_ NOTIFY stateChanged)
    Q_PROPERTY(bool drawn READ drawn NOTIFY stateChanged)  // the scene
    Q_PROPERTY(bool byMouse READ byMouse NOTIFY stateChanged)
    Q_PROPERTY(double share READ share NOTIFY stateChanged)

public:
    /// `every`: draws a picture every so many milliseconds at most; 0: whenever there is something new.
    Screen(Desk& desk, int every);
    ~Screen() override;

    void setFullScreen(bool full);

    bool shown() const;
    bool drawn() const { return view().scene; }
    bool byMouse() const { return desk_.byMouse(); }
    double share() const { return view().share; }

    Q_INVOKABLE void drag(double right, double down, double height, int buttons, int modifiers);
    Q_INVOKABLE void wheel(double notches, int modifiers);
    Q_INVOKABLE bool key(int key, bool down);
    /// Whatever keys are held: the window no longer learns when they are released.
    Q_INVOKABLE void letGo();
    /// The window was closed.
    Q_INVOKABLE void closed();
    /// The window has lost its graphics, or has them again.
    void setDrawing(bool draws);
    void retranslate() { emit stateChanged(); }

signals:
    void stateChanged();

private:
    void takeScene();
    void takeFrame();
    void move(const presenter::PartMotion& motion);
    void steer();
    std::uint32_t buttonOf(int key) const;

    Desk& desk_;
    int every_;
    QElapsedTimer since_frame_;
    presenter::HeldKeys keys_;
    std::uint32_t buttons_ = 0;  // of the handle, by keys
    bool full_screen_ = false;
};

}  // namespace passung::window
