#include "core/tick/pressed_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/surface/nearest_faces.h"
#include "core/tick/closed_form_proxy.h"
#include "core/tick/obstacle_query.h"
#include "core/tick/tick_model.h"
#include "core/tick/tick_state.h"

namespace passung::tick {

namespace {

constexpr double kNoDrift = 1e-12;                // share: nothing moves
constexpr double kPressed = 2e-3, kSlide = 3e-3;  // [m]

constexpr double kNearest = 1e-3, kFarthest = 10.0;  // [m] in which a contact is looked for

/// The same among closed forms.
Vec3 wayToContact(const Pose& X_WG, ClosedFormMemory& memory) {
    const closed_form::Contact* nearest = nullptr;
    closed_form::Contact best;
    closed_form::PairContacts found;
    for (double reach = kNearest; nearest == nullptr && reach < kFarthest; reach *= 2.0)
        for (closed_form::ContactSearch& search : memory.at_hand) {
            search.find(X_WG, reach, found);
            for (const closed_form::Contact& contact : found.all()) {
                if (nearest != nullptr && best.gap <= contact.gap) continue;
                best = contact;
                nearest = &best;
            }
        }
    return -(best.gap + kPressed) * best.normal.stableNormalized();
}

/// The same among triangles.
Vec3 wayToSurface(const HandModel& model) {
    double least = std::numeric_limits<double>::infinity();
    Vec3 normal = Vec3::UnitX();
    const auto look = [&](const geometry::ClusterTree& obstacle, const Pose& X_WO) {
        const auto nearest = surface::nearestFaces(*model.held_surface, obstacle, X_WO.inverse() * model.X_WG_start);
        if (nearest.distance >= least) return;
        least = nearest.distance;
        normal = X_WO.q * nearest.n;
    };
    if (model.still_surface != nullptr) look(*model.still_surface, Pose{});
    for (const std::uint32_t i : model.moving) {
        const Body& body = model.bodies[model.obstacles[i].body];
        look(*body.surface, body.X_WP_start);
    }
    return -(least + kPressed) * normal;
}

/// The motion of the held part that ends pressed into the nearest obstacle.
Vec3 wayToContact(const HandModel& model, HandState& state) {
    if (model.obstacles.empty()) return Vec3(0.02, 0.0, 0.0);
    if (model.hasClosedForm()) return wayToContact(model.X_WG_start, state);
    if (model.hasSurfaces()) return wayToSurface(model);
    state.scratch.clear();
    const contact::QueryAnswer answer = queryObstacles(model, state, model.X_WG_start, {.search_below = 1.0},
                                                       state.workspace, state.scratch, state.around_hand);
    return -(answer.phi + kPressed) * answer.normal_W;
}

/// Poses are those of the held part: the registration has nothing to do, and a drift would lead elsewhere. The stages
/// stay.
scene::Scene unregistered(scene::Scene scene) {
    scene::dropRegistrations(scene.spec);
    const auto stay = [](scene::Drift& drift) { drift.share = std::min(drift.share, kNoDrift); };
    stay(scene.spec.effects.navigation.drift);
    for (scene::HandSpec& hand : scene.spec.other_hands) stay(hand.navigation.drift);
    return scene;
}

}  // namespace

PressedRun::PressedRun(const scene::Scene& scene)
    : models_(unregistered(scene)), X_WG_start_(models_[0].hands.front().X_WG_start) {
    states_.push_back(makeState(models_[0]));
    way_ = wayToContact(models_[0].hands.front(), states_[0].hands.front());
    aside_ = way_.unitOrthogonal();
    for (HandState& hand : states_[0].hands) hand.engaged = true;
    for (const HandModel& hand : models_[0].hands) readings_.push_back({.X_BD = hand.X_WG_start});
    outputs_.resize(readings_.size());
}

PressedRun::~PressedRun() = default;

DeviceReading PressedRun::readingAt(int i) const noexcept {
    const double share = std::min(1.0, static_cast<double>(i) / kApproachTicks);
    const double slide = kSlide * std::sin(2e-3 * std::numbers::pi * std::max(0, i - kApproachTicks));
    DeviceReading reading;
    reading.X_BD = {X_WG_start_.q, X_WG_start_.p + share * way_ + slide * aside_};
    return reading;
}

TickOutput PressedRun::step(const DeviceReading& reading, const StageWatch* watch) noexcept {
    readings_.front() = reading;
    tick::step(models_[0], states_[0], readings_, outputs_, watch);
    return outputs_.front();
}

std::uint32_t PressedRun::mostWork() const noexcept {
    const HandModel& hand = models_[0].hands.front();
    const bool capped =
        hand.hasSurfaces() || (hand.hasFieldProxy() && hand.contact.method != scene::ContactMethod::Penalty);
    return capped ? tick::mostWork(hand) : 0;
}

std::uint32_t PressedRun::workDone(const TickOutput& output) const noexcept {
    return tick::workDone(models_[0].hands.front(), output.frame);
}

}  // namespace passung::tick
