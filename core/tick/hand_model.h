#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/near_list.h"
#include "core/motion/friction.h"
#include "core/tick/guide_way.h"
#include "core/tick/stage.h"
#include "core/tick/world.h"

namespace passung::tick {

/// Another part than the held one, as what its geometry is: a distance field, a smooth solid, or triangles. Where it is
/// says ObstaclePoses (proxy_state.h).
struct Obstacle {
    std::size_t body;                                 // in World::bodies
    const field::DistanceField* field = nullptr;      // Geometry::Field only
    const shell::SphereTree* shell = nullptr;         // two-way contact only
    const shell::EdgeCurves* edges = nullptr;         // with the shell
    const closed_form::SmoothSolid* solid = nullptr;  // Geometry::ClosedForm only
};

/// Overlap of a proxy [m].
struct ProxyMargins {
    double keep = 0.0;     // kept in contact: tells contact from nearness
    double relieve = 0.0;  // after a step: more is pushed out again
    double accept = 0.0;   // after a step: more, and it is taken back
};

inline constexpr std::size_t kNoBody = ~std::size_t{0};
inline constexpr std::size_t kNoObstacle = ~std::size_t{0};

/// Where the held part belongs.
struct SnapPlace {
    std::size_t into = kNoObstacle;  // of HandModel::obstacles, in whose frame it is; kNoObstacle: the world's
    Pose X_IS;
    int folds = 1;  // as scene::AssemblyStep::folds
};

/// A hand with a part that it holds, or with none: what does not change while a trial runs. Borrows the world.
struct HandModel {
    std::span<const Body> bodies;  // World::bodies
    std::size_t body = kNoBody;    // that it holds, among them
    scene::Geometry geometry = scene::Geometry::Field;
    // Geometry::Field only
    const shell::SphereTree* shell = nullptr;
    const shell::EdgeCurves* edges = nullptr;
    const field::DistanceField* held_field = nullptr;      // two-way contact only
    const closed_form::SmoothSolid* held_solid = nullptr;  // Geometry::ClosedForm only
    // Geometry::Surface only
    const geometry::ClusterTree* held_surface = nullptr;
    const geometry::ClusterTree* still_surface = nullptr;  // of all obstacles that rest, in the world; may be null
    std::span<const std::uint32_t> first_triangles;        // in that, of each of `resting`
    std::vector<Obstacle> obstacles;                       // in the order of the scene
    std::vector<std::uint32_t> resting;                    // those of them that rest for good, ascending
    std::vector<std::uint32_t> moving;                     // those of them that hands hold or may pick up, ascending
    bool has_others = false;                               // other hands may hold some of them meanwhile
    bool follows = false;                    // another hand holds the part too, and moves it: followed_part.h
    std::vector<motion::Friction> friction;  // of each obstacle with the held part; empty: the scene names none
    Pose X_WG_start;
    scene::ContactSpec contact;
    scene::OutputLimits limits;
    scene::Registration registration;
    scene::StartGate start_gate;
    std::vector<Stage> stages;
    std::vector<SparedStage> spared;  // those that the scene does without
    double finest_cell = 0.0;         // of all fields [m]
    double reach = 0.0;               // no point of the held part is farther from its origin [m]
    double metric_radius = 0.0;       // [m]: makes a rotation comparable with a translation (god_object_heuristic.h)
    Vec3 weight = Vec3::Zero();       // of the held part, world axes; zero: none [N]
    double mass = 0.0;                // likewise; 0: it has no density, or nothing asks for it [kg]
    Vec3 centre = Vec3::Zero();       // of that, part frame [m]
    Mat3 moments = Mat3::Zero();      // of inertia about it, part axes [kg·m²]
    ProxyMargins margins;
    scene::Effects effects;
    GuideWay way;                        // of its guidance
    std::vector<SnapPlace> snap_places;  // empty: nothing draws it
    bool record_hand_depth = true;
    bool display_wrench = true;

    bool hasPart() const noexcept { return body != kNoBody; }
    bool hasObstacles() const noexcept { return !obstacles.empty(); }
    /// Where another body stands among the obstacles, which are all bodies but its own. @pre `other` != body
    std::size_t obstacleOf(std::size_t other) const noexcept { return other < body ? other : other - 1; }
    /// Parts in other hands may move while this one's does.
    bool meetsHands() const noexcept { return has_others && !moving.empty(); }
    bool rendersAtHand() const noexcept { return hasObstacles() && contact.rendersAtHand(); }
    /// Of a god object, or a tool.
    bool hasProxy() const noexcept { return hasObstacles() && !contact.rendersAtHand(); }
    bool hasClosedForm() const noexcept { return hasProxy() && !follows && geometry == scene::Geometry::ClosedForm; }
    bool hasSurfaces() const noexcept { return hasProxy() && !follows && geometry == scene::Geometry::Surface; }
    /// A proxy or tool among distance fields.
    bool hasFieldProxy() const noexcept { return hasProxy() && !follows && geometry == scene::Geometry::Field; }
    bool hasFieldProxyOf(scene::ContactMethod method) const noexcept {
        return hasFieldProxy() && contact.method == method;
    }
    bool hasWeight() const noexcept { return !weight.isZero(0.0); }
    /// The part goes on moving by itself; in two hands it is the first one's that moves it.
    bool hasMass() const noexcept {
        return effects.inertia.any() && mass > 0.0 && contact.method != scene::ContactMethod::Penalty;
    }
    bool hasInertia() const noexcept { return hasMass() && !follows; }
    /// A spring holds the part to the hand.
    bool hasCoupling() const noexcept { return hasProxy() || hasInertia(); }
    /// From parts in other hands.
    bool keepsApart() const noexcept { return effects.keep_apart.any() && meetsHands() && hasPart() && !follows; }
    bool hasTransients() const noexcept { return effects.transients.amplitude > 0.0 && hasObstacles(); }
    /// Those of WrenchEffect that it has, a bit each.
    std::uint32_t wrenchEffects() const noexcept;
    /// Its weight turns what hangs from the hand, or the hand itself.
    bool hangsTurned() const noexcept { return !hasProxy() || contact.rotational_stiffness > 0.0; }
    /// Its looks may stop and go on in the next tick (field_look.h).
    bool hasNodeBudget() const noexcept {
        return hasFieldProxy() && contact.method != scene::ContactMethod::Penalty && contact.budget_nodes > 0;
    }
};

/// What contact is computed by, for a stage that another one stands for.
const char* contactInstead(const HandModel& model) noexcept;

/// What the scene fixes for hand `hand` with part `body`, or kNoBody, which perhaps `follows` another hand, and those
/// of AllStages that it needs. `world` is the scene's and outlives the result. @pre `hand` < scene.spec.handCount()
HandModel makeHandModel(const World& world, const scene::Scene& scene, std::size_t hand, std::size_t body,
                        bool follows = false);

/// Its obstacles, with boxes that are `beyond` larger on every side, as far as sheets are felt in front of them too
/// [m].
geometry::NearList nearListOf(const HandModel& model, double beyond);

}  // namespace passung::tick
