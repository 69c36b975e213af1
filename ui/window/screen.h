#pragma once

#include <QtCore/QElapsedTimer>
#include <QtCore/QObject>
#include <QtCore/QVariant>
#include <QtGui/QColor>
#include <QtGui/QQuaternion>
#include <QtGui/QVector3D>
#include <QtQuick3D/QQuick3DGeometry>
#include <map>
#include <memory>

#include "ui/presenter/participant.h"
#include "ui/presenter/pointer_motion.h"
#include "ui/window/desk.h"

namespace passung::window {

/// The participant's view state for QML, and their mouse and keys for the device. Millimetres.
class Screen : public QObject {
    Q_OBJECT
    Q_PROPERTY(bool shown READ shown NOTIFY stateChanged)  // the window
    Q_PROPERTY(bool fullScreen MEMBER full_screen_ NOTIFY stateChanged)
    Q_PROPERTY(bool drawn READ drawn NOTIFY stateChanged)  // the scene
    Q_PROPERTY(bool byMouse READ byMouse NOTIFY stateChanged)
    Q_PROPERTY(QString line READ line NOTIFY stateChanged)
    Q_PROPERTY(QString hint READ hint NOTIFY stateChanged)
    Q_PROPERTY(double share READ share NOTIFY stateChanged)
    Q_PROPERTY(bool software MEMBER software_ NOTIFY sceneChanged)  // no graphics card draws
    Q_PROPERTY(bool heavy MEMBER heavy_ NOTIFY sceneChanged)        // many triangles

    Q_PROPERTY(QVariantList parts MEMBER parts_ NOTIFY sceneChanged)
    Q_PROPERTY(QQuick3DGeometry* heldGeometry MEMBER held_geometry_ NOTIFY sceneChanged)
    Q_PROPERTY(QVariantList marks MEMBER marks_ NOTIFY sceneChanged)
    Q_PROPERTY(QVector3D groundPosition MEMBER ground_position_ NOTIFY sceneChanged)
    Q_PROPERTY(double radius MEMBER radius_ NOTIFY sceneChanged)
    Q_PROPERTY(QVector3D cameraPosition MEMBER camera_position_ NOTIFY sceneChanged)
    Q_PROPERTY(QQuaternion cameraRotation MEMBER camera_rotation_ NOTIFY sceneChanged)
    Q_PROPERTY(QQuaternion lightRotation MEMBER light_rotation_ NOTIFY sceneChanged)
    Q_PROPERTY(double cameraOpening MEMBER camera_opening_ NOTIFY sceneChanged)
    Q_PROPERTY(double cameraNear MEMBER camera_near_ NOTIFY sceneChanged)
    Q_PROPERTY(double cameraFar MEMBER camera_far_ NOTIFY sceneChanged)

    Q_PROPERTY(QVector3D heldPosition READ heldPosition NOTIFY frame)
    Q_PROPERTY(QQuaternion heldRotation READ heldRotation NOTIFY frame)
    Q_PROPERTY(bool startMark READ startMark NOTIFY frame)
    Q_PROPERTY(QVector3D startPosition READ startPosition NOTIFY frame)
    Q_PROPERTY(QQuaternion startRotation READ startRotation NOTIFY frame)
    Q_PROPERTY(double cue READ cue NOTIFY frame)
    Q_PROPERTY(bool arrow READ arrow NOTIFY frame)
    Q_PROPERTY(QVector3D arrowPosition READ arrowPosition NOTIFY frame)
    Q_PROPERTY(QQuaternion arrowRotation READ arrowRotation NOTIFY frame)
    Q_PROPERTY(double arrowLength READ arrowLength NOTIFY frame)

public:
    /// `every`: draws a picture every so many milliseconds at most; 0: whenever there is something new.
    Screen(Desk& desk, int every);
    ~Screen() override;

    void setSoftware(bool software);
    void setFullScreen(bool full);
    const presenter::ParticipantView& view() const { return view_; }

    bool shown() const;
    bool drawn() const { return view_.scene; }
    bool byMouse() const { return desk_.byMouse(); }
    QString line() const;
    QString hint() const;
    double share() const { return view_.share; }
    QVector3D heldPosition() const;
    QQuaternion heldRotation() const;
    bool startMark() const { return view_.start_mark; }
    QVector3D startPosition() const;
    QQuaternion startRotation() const;
    double cue() const { return view_.cue; }
    bool arrow() const { return view_.arrow; }
    QVector3D arrowPosition() const;
    QQuaternion arrowRotation() const;
    double arrowLength() const;
    /// The held part's colour, towards red with the collision cue.
    Q_INVOKABLE QColor heldColor(const QColor& plain) const;

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
    void sceneChanged();
    void frame();

private:
    QQuick3DGeometry* geometryOf(const std::shared_ptr<const presenter::ShadedMesh>& mesh);
    void takeScene();
    void takeFrame();
    void move(const presenter::PartMotion& motion);

    Desk& desk_;
    int every_;
    QElapsedTimer since_frame_, since_keys_;
    presenter::ParticipantView view_;
    presenter::HeldKeys keys_;
    std::uint32_t buttons_ = 0;  // of the handle, by keys
    // A surface stays as long as this screen: QML may still draw the scene before.
    std::map<std::shared_ptr<const presenter::ShadedMesh>, std::unique_ptr<QQuick3DGeometry>> geometries_;
    bool full_screen_ = false, software_ = false, heavy_ = false;
    QVariantList parts_, marks_;
    QQuick3DGeometry* held_geometry_ = nullptr;
    QVector3D ground_position_, camera_position_;
    QQuaternion camera_rotation_, light_rotation_;
    double radius_ = 100.0, camera_opening_ = 30.0, camera_near_ = 1.0, camera_far_ = 1000.0;
};

}  // namespace passung::window
