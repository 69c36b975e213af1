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
    const auto vector = [](const std::array<float, 3>& v) { return QVector3D(v[0], v[1], v[2]); };
    using A = Attribute;
    clear();
    setPrimitiveType(PrimitiveType::Triangles);
    setStride(static_cast<int>(sizeof(presenter::ShadedMesh::Vertex)));
    addAttribute(A::PositionSemantic, 0, A::F32Type);
    addAttribute(A::NormalSemantic, 3 * sizeof(float), A::F32Type);
    addAttribute(A::IndexSemantic, 0, A::U32Type);
    setVertexData(bytesOf(mesh_->vertices));
    setIndexData(bytesOf(mesh_->indices));
    setBounds(vector(mesh_->low_mm), vector(mesh_->high_mm));
    update();
    emit meshChanged();
}

}  // namespace passung::participant
