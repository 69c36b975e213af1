#include "analysis/truth/force_reference.h"

#include <algorithm>
#include <cmath>

#include "analysis/truth/least_energy.h"
#include "core/scene/part_mass.h"

namespace passung::truth {

ForceReference::ForceReference(const scene::SceneSpec& scene) {
    const scene::ContactSpec& contact = scene.contact;
    stiffness_ = contact.stiffness;
    rho_ = std::sqrt(contact.rotational_stiffness / contact.stiffness);
    if (scene.handCount() > 1) {
        missing_ = "the scene has more than one hand";
        return;
    }
    const auto held = std::find_if(scene.parts.begin(), scene.parts.end(), [](const auto& part) { return part.held; });
    const auto* shape = held == scene.parts.end() ? nullptr : std::get_if<shape::Shape>(&held->geometry);
    std::vector<PlacedShape> obstacles;
    for (const scene::PartSpec& part : scene.parts) {
        if (part.held) continue;
        if (part.friction > 0.0 && held->friction > 0.0) {
            missing_ = "parts that rub have no pose of least energy";
            return;
        }
        const auto* other = std::get_if<shape::Shape>(&part.geometry);
        if (shape == nullptr || other == nullptr) {
            missing_ = "a part is a mesh";
            return;
        }
        obstacles.emplace_back(*other, part.X_WP);
    }
    if (shape == nullptr || obstacles.empty()) {
        missing_ = "the scene has no obstacle";
        return;
    }
    const bool weighs = held->density > 0.0 && !scene.effects.weight.gravity.isZero(0.0);
    if (const auto body = weighs ? scene::massOf(*shape, held->density) : std::nullopt) {
        weight_ = body->mass * scene.effects.weight.gravity;
        centre_ = body->centre;
    }
    separation_ = separationOf(*shape, obstacles);
    if (separation_ == nullptr)
        missing_ =
            "the pair is neither a ball among solids without hollows nor a round peg and its bore nor of boxes, square "
            "pegs and square pockets";
    else if (!(rho_ > 0.0) && !std::holds_alternative<shape::Sphere>(*shape))
        missing_ = "without rotational stiffness the held part's turn is not determined";
}

std::optional<Vec3> ForceReference::at(const Pose& X_WG_last, const Pose& X_WH) const {
    const double rho = rho_ > 0.0 ? rho_ : 1.0;  // a ball's turn changes nothing
    // What was shown may overlap: then from the nearest pose that does not.
    const auto free = leastEnergyFrom(*separation_, rho, X_WG_last, X_WG_last);
    if (!free) return std::nullopt;
    Pose rest{X_WH.q, X_WH.p + weight_ / stiffness_};
    if (rho_ > 0.0 && !weight_.isZero(0.0))
        rest.q = rotationFromVector((X_WH.q * centre_).cross(weight_) / (rho_ * rho_ * stiffness_)) * X_WH.q;
    const auto found = leastEnergyFrom(*separation_, rho, free->X, rest);
    if (!found || found->way > kSnap) return std::nullopt;
    return Vec3(stiffness_ * (found->X.p - X_WH.p));
}

}  // namespace passung::truth
