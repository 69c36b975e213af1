#include "ui/window/scene_model.h"

#include <QtQml/QQmlEngine>

#include "ui/participant/part_geometry.h"

namespace passung::window {

namespace {

constexpr std::size_t kHeavy = 20'000;  // triangles; a part that software draws casts no shadow with more
constexpr double kDegrees = 57.29577951308232;

QVector3D millimetres(const Vec3& v) {
    return {static_cast<float>(1e3 * v.x()), static_cast<float>(1e3 * v.y()), static_cast<float>(1e3 * v.z())};
}

QQuaternion rotation(const Quat& q) {
    return {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())};
}

}  // namespace

SceneModel::SceneModel() = default;
SceneModel::~SceneModel() = default;

void SceneModel::setSoftware(bool software) {
    software_ = software;
    emit sceneChanged();
}

QQuick3DGeometry* SceneModel::geometryOf(const std::shared_ptr<const presenter::ShadedMesh>& mesh) {
    auto& geometry = geometries_[mesh];
    if (!geometry) {
        geometry = std::make_unique<participant::PartGeometry>(*mesh);
        QQmlEngine::setObjectOwnership(geometry.get(), QQmlEngine::CppOwnership);
    }
    return geometry.get();
}

void SceneModel::show(const presenter::DrawnScene& scene) {
    parts_.clear();
    std::size_t corners = 0;
    for (const presenter::DrawnPart& part : scene.parts) {
        QQuick3DGeometry* geometry = geometryOf(part.mesh);
        parts_.append(QVariantMap{{"geometry", QVariant::fromValue(geometry)},
                                  {"position", millimetres(part.X_W.p)},
                                  {"rotation", rotation(part.X_W.q)},
                                  {"held", part.held},
                                  {"casts", !(software_ && part.mesh->indices.size() / 3 > kHeavy)}});
        if (part.held) held_geometry_ = geometry;
        corners += part.mesh->indices.size();
    }
    heavy_ = software_ && corners / 3 > kHeavy;
    marks_.clear();
    for (const presenter::Mark& mark : scene.marks)
        marks_.append(QVariantMap{{"geometry", QVariant::fromValue(geometryOf(mark.mesh))},
                                  {"position", millimetres(mark.X_W.p)},
                                  {"rotation", rotation(mark.X_W.q)},
                                  {"pale", mark.pale}});
    radius_ = 1e3 * scene.radius;
    const presenter::Camera& camera = scene.camera;
    ground_position_ = millimetres({camera.centre.x(), camera.centre.y(), scene.floor});
    camera_position_ = millimetres(camera.X_WC.p);
    camera_rotation_ = rotation(camera.X_WC.q);
    const Vec3 from = (camera.X_WC.q * Vec3(-0.55, 0.5, 0.35) + 1.3 * Vec3::UnitZ()).normalized();
    light_rotation_ = rotation(Quat::FromTwoVectors(Vec3::UnitZ(), from));
    camera_opening_ = kDegrees * camera.opening;
    camera_near_ = 1e3 * camera.near;
    camera_far_ = 1e3 * camera.far;
    emit sceneChanged();
}

void SceneModel::show(const presenter::ParticipantView& view) {
    view_ = view;
    emit frame();
}

QVector3D SceneModel::heldPosition() const { return millimetres(view_.X_WHeld.p); }
QQuaternion SceneModel::heldRotation() const { return rotation(view_.X_WHeld.q); }
QVector3D SceneModel::startPosition() const { return millimetres(view_.X_WStart.p); }
QQuaternion SceneModel::startRotation() const { return rotation(view_.X_WStart.q); }
QVector3D SceneModel::arrowPosition() const { return millimetres(view_.arrow_from); }
double SceneModel::arrowLength() const { return 1e3 * view_.arrow_way.norm(); }

QQuaternion SceneModel::arrowRotation() const {
    if (!view_.arrow) return {};
    return rotation(Quat::FromTwoVectors(Vec3::UnitY(), view_.arrow_way));
}

QColor SceneModel::heldColor(const QColor& plain) const {
    const auto mixed = [this](float from, float to) { return from + static_cast<float>(view_.cue) * (to - from); };
    const QColor hit(0xd5, 0x2e, 0x00);
    return QColor::fromRgbF(mixed(plain.redF(), hit.redF()), mixed(plain.greenF(), hit.greenF()),
                            mixed(plain.blueF(), hit.blueF()));
}

}  // namespace passung::window
