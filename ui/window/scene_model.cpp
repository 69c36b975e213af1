#include "ui/window/scene_model.h"

#include <algorithm>
#include <map>
#include <optional>

#include "ui/participant/part_geometry.h"
#include "ui/participant/part_instances.h"

namespace passung::window {

namespace {

constexpr std::size_t kHeavy = 20'000;  // triangles; of what software draws with more, edges are not smoothed
constexpr double kDegrees = 57.29577951308232;

QVector3D millimetres(const Vec3& v) {
    return {static_cast<float>(1e3 * v.x()), static_cast<float>(1e3 * v.y()), static_cast<float>(1e3 * v.z())};
}

QQuaternion rotation(const Quat& q) {
    return {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())};
}

QVariantMap mapOf(const Pose& X) { return {{"position", millimetres(X.p)}, {"rotation", rotation(X.q)}}; }

QVariantMap modelOf(const participant::Surface& mesh, const Pose& X_W) {
    QVariantMap model = mapOf(X_W);
    model.insert("mesh", QVariant::fromValue(mesh));
    model.insert("twoSided", mesh->two_sided);
    model.insert("hand", -1);
    return model;
}

/// Moved by a hand, whose part starts at X_WP.
QVariantMap modelOf(const participant::Surface& mesh, const Pose& X_W, std::optional<std::size_t> hand,
                    const std::vector<Pose>& starts) {
    if (!hand) return modelOf(mesh, X_W);
    QVariantMap model = modelOf(mesh, starts[*hand].inverse() * X_W);
    model.insert("hand", static_cast<int>(*hand));
    return model;
}

/// Colours of parts that are picked up, in the order of Scene3D's.
enum class PartLook { Fixed, Loose, Held, OtherHeld, Done, Image, Hinted };

}  // namespace

SceneModel::SceneModel() = default;
SceneModel::~SceneModel() = default;

void SceneModel::setSoftware(bool software) {
    software_ = software;
    emit sceneChanged();
}

void SceneModel::show(const presenter::DrawnScene& scene) {
    parts_.clear();
    ghosts_.clear();
    marks_.clear();
    std::size_t corners = 0;
    X_WOthers_start_.clear();
    for (const presenter::DrawnPart& part : scene.parts) {
        if (!part.other_hand) continue;
        X_WOthers_start_.resize(std::max(X_WOthers_start_.size(), *part.other_hand + 1));
        X_WOthers_start_[*part.other_hand] = part.X_W;
    }
    for (const presenter::DrawnPart& part : scene.parts) {
        QVariantMap model = modelOf(part.mesh, part.X_W, part.other_hand, X_WOthers_start_);
        if (part.held) ghosts_.append(model);
        model.insert("held", part.held);
        if (!scene.picking) parts_.append(model);
        corners += part.mesh->indices.size();
    }
    showParts(scene);
    heavy_ = software_ && corners / 3 > kHeavy;
    for (const presenter::Mark& mark : scene.marks) {
        QVariantMap model = modelOf(mark.mesh, mark.X_W, scene.target_hand, X_WOthers_start_);
        model.insert("pale", mark.pale);
        marks_.append(model);
    }
    appearance_ = scene.appearance;
    radius_ = 1e3 * scene.radius;
    const presenter::Camera& camera = scene.camera;
    ground_position_ = millimetres({camera.centre.x(), camera.centre.y(), scene.floor});
    camera_position_ = millimetres(camera.X_WC.p);
    camera_rotation_ = rotation(camera.X_WC.q);
    light_rotation_ = rotation(rotationBetween(Vec3::UnitZ(), scene.light_from));
    camera_opening_ = kDegrees * camera.opening;
    camera_near_ = 1e3 * camera.near;
    camera_far_ = 1e3 * camera.far;
    emit sceneChanged();
}

void SceneModel::show(const presenter::ParticipantView& view) {
    view_ = view;
    place();
    emit frame();
}

/// Parts of one surface are drawn together.
void SceneModel::showParts(const presenter::DrawnScene& scene) {
    surfaces_.clear();
    surface_of_.clear();
    pickable_.clear();
    placement_ = {};
    view_.X_WParts.clear();  // of the scene before
    starts_empty_ = scene.picking && scene.held >= scene.parts.size();
    if (!scene.picking) return;
    part_count_ = static_cast<int>(scene.parts.size());
    std::map<participant::Surface, int> known;
    for (const presenter::DrawnPart& part : scene.parts) {
        const auto [found, is_new] = known.try_emplace(part.mesh, static_cast<int>(surfaces_.size()));
        if (is_new)
            surfaces_.append(QVariantMap{{"mesh", QVariant::fromValue(part.mesh)}, {"twoSided", part.mesh->two_sided}});
        surface_of_.push_back(found->second);
        pickable_.push_back(part.pickable);
    }
    reach_ = 1e3 * (scene.camera.centre.norm() + 2.0 * scene.radius);
}

void SceneModel::place() {
    if (view_.X_WParts.size() != surface_of_.size() || surface_of_.empty()) return;
    auto placed = std::make_shared<participant::SceneInstances>();
    placed->parts.resize(static_cast<std::size_t>(surfaces_.size()));
    placed->images.resize(placed->parts.size());
    std::vector<PartLook> looks(surface_of_.size(), PartLook::Fixed);
    for (std::size_t part = 0; part < looks.size(); ++part) {
        if (pickable_[part]) looks[part] = PartLook::Loose;
        if (part < view_.done.size() && view_.done[part]) looks[part] = PartLook::Done;
        if (view_.hinted == part) looks[part] = PartLook::Hinted;
    }
    for (std::size_t hand = view_.hands.size(); hand-- > 0;)
        if (const std::int32_t part = view_.hands[hand].part; part >= 0)
            looks[static_cast<std::size_t>(part)] = hand == 0 ? PartLook::Held : PartLook::OtherHeld;
    const auto instance = [](std::size_t part, const Pose& X_W, PartLook look) {
        return participant::PartInstance{millimetres(X_W.p), rotation(X_W.q), static_cast<int>(part),
                                         static_cast<int>(look)};
    };
    for (std::size_t part = 0; part < looks.size(); ++part)
        placed->parts[static_cast<std::size_t>(surface_of_[part])].push_back(
            instance(part, view_.X_WParts[part], looks[part]));
    for (const presenter::StepImage& image : view_.images)
        placed->images[static_cast<std::size_t>(surface_of_[image.part])].push_back(
            instance(image.part, image.X_W, PartLook::Image));
    placement_ = QVariant::fromValue(participant::InstanceTable(std::move(placed)));
}

QVariantList SceneModel::hands() const {
    QVariantList all;
    for (const presenter::DrawnHand& hand : view_.hands) {
        QVariantMap drawn = mapOf(hand.X_W);
        drawn.insert("closed", hand.closed);
        drawn.insert("empty", hand.part < 0);
        all.append(drawn);
    }
    return all;
}

QVariantList SceneModel::others() const {
    QVariantList others;
    for (std::size_t i = 0; i < X_WOthers_start_.size(); ++i)
        others.append(
            mapOf(i < view_.X_WOthers.size() ? view_.X_WOthers[i].value_or(X_WOthers_start_[i]) : X_WOthers_start_[i]));
    return others;
}

QVector3D SceneModel::heldPosition() const { return millimetres(view_.X_WHeld.p); }
QQuaternion SceneModel::heldRotation() const { return rotation(view_.X_WHeld.q); }
QVector3D SceneModel::startPosition() const { return millimetres(view_.X_WStart.p); }
QQuaternion SceneModel::startRotation() const { return rotation(view_.X_WStart.q); }
QVector3D SceneModel::arrowPosition() const { return millimetres(view_.arrow_from); }
double SceneModel::arrowLength() const { return 1e3 * view_.arrow_way.norm(); }

QQuaternion SceneModel::arrowRotation() const {
    if (!view_.arrow) return {};
    return rotation(rotationBetween(Vec3::UnitY(), view_.arrow_way));
}

}  // namespace passung::window
