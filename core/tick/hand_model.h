#pragma once

#include <optional>
#include <vector>

#include "core/base/types.h"
#include "core/closed_form/solid.h"
#include "core/geometry/cluster_tree.h"
#include "core/motion/friction.h"
#include "core/scene/contact_geometry.h"
#include "core/scene/scene.h"
#include "core/tick/stage.h"

namespace passung::tick {

/// An obstacle fixed in the world, as what its geometry is: a distance field, one of HandModel::solids, or a share of
/// HandModel::obstacle_surface.
struct Obstacle {
    const field::DistanceField* field;  // Geometry::Field only
    Pose X_WF;
    const shell::SphereTree* shell = nullptr;  // two-way contact only
    const shell::EdgeCurves* edges = nullptr;  // with the shell
};

/// Overlap of a proxy [m].
struct ProxyMargins {
    double keep = 0.0;     // kept in contact: tells contact from nearness
    double relieve = 0.0;  // after a step: more is pushed out again
    double accept = 0.0;   // after a step: more, and it is taken back
};

/// Everything that does not change while a trial runs. Borrows the scene's parts.
struct HandModel {
    scene::Geometry geometry = scene::Geometry::Field;
    // Geometry::Field only
    const shell::SphereTree* shell = nullptr;
    const shell::EdgeCurves* edges = nullptr;
    const field::DistanceField* held_field = nullptr;  // two-way contact only
    std::vector<closed_form::SmoothSolid> solids;      // Geometry::ClosedForm only: the held part, the obstacles
    // Geometry::Surface only
    const geometry::ClusterTree* held_surface = nullptr;
    std::optional<geometry::ClusterTree> obstacle_surface;  // of all obstacles, in the world
    std::vector<std::uint32_t> first_triangles;             // in that, of each obstacle
    std::vector<Obstacle> obstacles;
    std::vector<motion::Friction> friction;  // of each obstacle with the held part; empty: the scene names none
    Pose X_WG_start;
    scene::ContactSpec contact;
    scene::OutputLimits limits;
    scene::Registration registration;
    scene::StartGate start_gate;
    std::vector<Stage> stages;
    double finest_cell = 0.0;    // of all fields [m]
    double reach = 0.0;          // no point of the held part is farther from its origin [m]
    double metric_radius = 0.0;  // [m]: makes a rotation comparable with a translation (god_object_heuristic.h)
    ProxyMargins margins;
    scene::Effects effects;
    bool record_hand_depth = true;
    bool display_wrench = true;

    bool hasObstacles() const noexcept { return !obstacles.empty(); }
    bool rendersAtHand() const noexcept { return hasObstacles() && contact.rendersAtHand(); }
    /// Of a god object, or a tool.
    bool hasProxy() const noexcept { return hasObstacles() && !contact.rendersAtHand(); }
    bool hasClosedForm() const noexcept { return hasProxy() && geometry == scene::Geometry::ClosedForm; }
    bool hasSurfaces() const noexcept { return hasProxy() && geometry == scene::Geometry::Surface; }
    /// A proxy or tool among distance fields.
    bool hasFieldProxy() const noexcept { return hasProxy() && geometry == scene::Geometry::Field; }
    bool hasFieldProxyOf(scene::ContactMethod method) const noexcept {
        return hasFieldProxy() && contact.method == method;
    }
    /// Its looks may stop and go on in the next tick (field_look.h).
    bool hasNodeBudget() const noexcept {
        return hasFieldProxy() && contact.method != scene::ContactMethod::Penalty && contact.budget_nodes > 0;
    }
};

/// What the scene fixes, and those of AllStages that it needs. `scene` must outlive the result.
HandModel makeModel(const scene::Scene& scene);

}  // namespace passung::tick
