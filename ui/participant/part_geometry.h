#pragma once

#include <QtCore/QVariant>
#include <QtQuick3D/QQuick3DGeometry>
#include <memory>

#include "ui/presenter/shaded_mesh.h"

namespace passung::participant {

using Surface = std::shared_ptr<const presenter::ShadedMesh>;  // shared_ptr: windows and scenes have surfaces in common

/// A surface for the graphics card, in millimetres. It belongs to the one Model that draws it and goes with it: Qt 6.4
/// uploads no geometry again whose last Model is gone.
class PartGeometry : public QQuick3DGeometry {
    Q_OBJECT
    Q_PROPERTY(QVariant mesh READ mesh WRITE setMesh NOTIFY meshChanged)  // holds a Surface
    // Of many images of one surface: all of them lie within so much of the origin [mm]; 0: there is one.
    Q_PROPERTY(float reach READ reach WRITE setReach NOTIFY meshChanged)

public:
    QVariant mesh() const { return QVariant::fromValue(mesh_); }
    void setMesh(const QVariant& mesh);
    float reach() const { return reach_; }
    void setReach(float reach);

signals:
    void meshChanged();

private:
    void bound();

    Surface mesh_;
    float reach_ = 0.0f;
};

}  // namespace passung::participant

Q_DECLARE_METATYPE(passung::participant::Surface)
