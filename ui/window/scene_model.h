#pragma once

#include <QtCore/QObject>
#include <QtCore/QVariant>
#include <QtGui/QQuaternion>
#include <QtGui/QVector3D>

#include "ui/presenter/participant.h"

namespace passung::window {

/// A scene and what stands and moves in it, for QML. Millimetres.
class SceneModel : public QObject {
    Q_OBJECT
    Q_PROPERTY(bool software MEMBER software_ NOTIFY sceneChanged)  // no graphics card draws
    Q_PROPERTY(bool heavy MEMBER heavy_ NOTIFY sceneChanged)        // many triangles

    // Lists of maps, a Model for each: "mesh", "position", "rotation" and what else it needs. "hand": among the others,
    // that moves it, -1 if none does; then position and rotation are in the frame of the hand's part.
    Q_PROPERTY(QVariantList parts MEMBER parts_ NOTIFY sceneChanged)
    Q_PROPERTY(QVariantList ghosts MEMBER ghosts_ NOTIFY sceneChanged)  // pale images of the held part: one, or none
    // Of a scene whose parts are picked up, in place of `parts`: its surfaces, each "mesh", "twoSided", and where they
    // are drawn, a participant::InstanceTable.
    Q_PROPERTY(QVariantList surfaces MEMBER surfaces_ NOTIFY sceneChanged)
    Q_PROPERTY(double reach MEMBER reach_ NOTIFY sceneChanged)  // of all that is drawn, from the origin
    Q_PROPERTY(int partCount MEMBER part_count_ NOTIFY sceneChanged)
    Q_PROPERTY(QVariant placement MEMBER placement_ NOTIFY frame)
    Q_PROPERTY(QVariantList hands READ hands NOTIFY frame)                 // "position", "rotation", "closed", "empty"
    Q_PROPERTY(bool startsEmpty MEMBER starts_empty_ NOTIFY sceneChanged)  // the first hand
    Q_PROPERTY(QVariantList marks MEMBER marks_ NOTIFY sceneChanged)
    Q_PROPERTY(QVector3D groundPosition MEMBER ground_position_ NOTIFY sceneChanged)
    Q_PROPERTY(double radius MEMBER radius_ NOTIFY sceneChanged)
    Q_PROPERTY(QVector3D cameraPosition MEMBER camera_position_ NOTIFY sceneChanged)
    Q_PROPERTY(QQuaternion cameraRotation MEMBER camera_rotation_ NOTIFY sceneChanged)
    Q_PROPERTY(bool dark READ dark NOTIFY sceneChanged)
    Q_PROPERTY(bool ground READ ground NOTIFY sceneChanged)
    Q_PROPERTY(double light READ light NOTIFY sceneChanged)
    Q_PROPERTY(double fillLight READ fillLight NOTIFY sceneChanged)
    Q_PROPERTY(double ambientLight READ ambientLight NOTIFY sceneChanged)
    Q_PROPERTY(double shadow READ shadow NOTIFY sceneChanged)
    Q_PROPERTY(QQuaternion lightRotation MEMBER light_rotation_ NOTIFY sceneChanged)
    Q_PROPERTY(double cameraOpening MEMBER camera_opening_ NOTIFY sceneChanged)
    Q_PROPERTY(double cameraNear MEMBER camera_near_ NOTIFY sceneChanged)
    Q_PROPERTY(double cameraFar MEMBER camera_far_ NOTIFY sceneChanged)

    // Parts in other hands, in the order of these: "position", "rotation".
    Q_PROPERTY(QVariantList others READ others NOTIFY frame)
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
    SceneModel();
    ~SceneModel() override;

    void setSoftware(bool software);
    void show(const presenter::DrawnScene& scene);
    void show(const presenter::ParticipantView& view);
    const presenter::ParticipantView& view() const { return view_; }

    QVariantList others() const;
    QVariantList hands() const;
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

    bool dark() const { return appearance_.theme == plan::Theme::Dark; }
    bool ground() const { return appearance_.ground; }
    double light() const { return appearance_.light; }
    double fillLight() const { return appearance_.fill_light; }
    double ambientLight() const { return appearance_.ambient_light; }
    double shadow() const { return appearance_.shadow; }

signals:
    void sceneChanged();
    void frame();

private:
    void showParts(const presenter::DrawnScene& scene);
    void place();

    presenter::ParticipantView view_;
    QVariantList surfaces_;
    QVariant placement_;
    std::vector<int> surface_of_;  // each part
    std::vector<bool> pickable_;   // likewise
    double reach_ = 0.0;
    int part_count_ = 0;
    bool starts_empty_ = false;
    plan::View appearance_;
    bool software_ = false, heavy_ = false;
    QVariantList parts_, ghosts_, marks_;
    std::vector<Pose> X_WOthers_start_;
    QVector3D ground_position_, camera_position_;
    QQuaternion camera_rotation_, light_rotation_;
    double radius_ = 100.0, camera_opening_ = 30.0, camera_near_ = 1.0, camera_far_ = 1000.0;
};

}  // namespace passung::window
