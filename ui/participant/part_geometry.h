#pragma once

#include <QtQuick3D/QQuick3DGeometry>

#include "ui/presenter/shaded_mesh.h"

namespace passung::participant {

/// A surface for the graphics card, in millimetres.
class PartGeometry : public QQuick3DGeometry {
    Q_OBJECT

public:
    explicit PartGeometry(const presenter::ShadedMesh& mesh);
};

}  // namespace passung::participant
