#include "ui/participant/part_geometry.h"

#include <QtGui/QVector3D>

namespace passung::participant {

void PartGeometry::setMesh(const QVariant& mesh) {
    auto surface = mesh.value<Surface>();
    if (!surface || surface == mesh_) return;
    mesh_ = std::move(surface);
    const auto bytesOf = [](const auto& values) {
        return QByteArray(reinterpret_cast<const char*>(values.data()),
                          static_cast<qsizetype>(values.size() * sizeof(values[0])));
    };
    using A = Attribute;
    clear();
    setPrimitiveType(PrimitiveType::Triangles);
    setStride(static_cast<int>(sizeof(presenter::ShadedMesh::Vertex)));
    addAttribute(A::PositionSemantic, 0, A::F32Type);
    addAttribute(A::NormalSemantic, 3 * sizeof(float), A::F32Type);
    addAttribute(A::IndexSemantic, 0, A::U32Type);
    setVertexData(bytesOf(mesh_->vertices));
    setIndexData(bytesOf(mesh_->indices));
    bound();
    emit meshChanged();
}

void PartGeometry::setReach(float reach) {
    if (reach == reach_) return;
    reach_ = reach;
    if (mesh_) bound();
    emit meshChanged();
}

void PartGeometry::bound() {
    const auto vector = [](const std::array<float, 3>& v) { return QVector3D(v[0], v[1], v[2]); };
    const QVector3D corner(reach_, reach_, reach_);
    if (reach_ > 0.0f)
        setBounds(-corner, corner);
    else
        setBounds(vector(mesh_->low_mm), vector(mesh_->high_mm));
    update();
}

}  // namespace passung::participant
