#pragma once

#include <QtCore/QVariant>
#include <QtGui/QColor>
#include <QtGui/QQuaternion>
#include <QtGui/QVector3D>
#include <QtQuick3D/QQuick3DInstancing>
#include <memory>
#include <vector>

namespace passung::participant {

/// One image of a surface that many parts have. Millimetres.
struct PartInstance {
    QVector3D position;
    QQuaternion rotation;
    int part = 0;  // in the order of the scene
    int look = 0;  // place of its colour among PartInstances::colours
};

/// What a picture shows of each surface of a scene: parts, and pale images of where they belong.
struct SceneInstances {
    std::vector<std::vector<PartInstance>> parts, images;  // by surface
};
using InstanceTable =
    std::shared_ptr<const SceneInstances>;  // shared_ptr: every surface of a window looks into the same

/// Where a surface is drawn again and again, in one call of the graphics card.
class PartInstances : public QQuick3DInstancing {
    Q_OBJECT
    Q_PROPERTY(QVariant placement READ placement WRITE setPlacement NOTIFY changed)  // holds a InstanceTable
    Q_PROPERTY(int surface MEMBER surface_ NOTIFY changed)
    Q_PROPERTY(bool images MEMBER images_ NOTIFY changed)  // the pale ones, in place of the parts
    Q_PROPERTY(QVariantList colours READ colours WRITE setColours NOTIFY changed)  // by look, or where `flat` by part
    Q_PROPERTY(bool flat MEMBER flat_ NOTIFY changed)
    Q_PROPERTY(int count READ count NOTIFY changed)

public:
    PartInstances();

    QVariant placement() const { return QVariant::fromValue(placement_); }
    void setPlacement(const QVariant& placement);
    QVariantList colours() const;
    void setColours(const QVariantList& colours);
    int count() const { return static_cast<int>(placed().size()); }

signals:
    void changed();

protected:
    QByteArray getInstanceBuffer(int* count) override;

private:
    const std::vector<PartInstance>& placed() const;

    InstanceTable placement_;
    std::vector<QColor> colours_;
    int surface_ = 0;
    bool images_ = false, flat_ = false;
};

}  // namespace passung::participant

Q_DECLARE_METATYPE(passung::participant::InstanceTable)
