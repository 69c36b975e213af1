#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"
#include "core/scene/part.h"

namespace passung::path {

/// A part that stands still while another one moves. The part outlives what gets it.
struct RestingPart {
    const scene::Part* part = nullptr;
    Pose X_WO;
};

/// How far the moving part is from what stands.
struct Nearness {
    double distance = 0.0;                // of closed forms beside an edge too small; of triangles no less than theirs;
                                          // ≤ 0: they meet [m]
    double bound = 0.0;                   // the true distance is no less: of triangles proven, chord errors are
                                          // taken off; of closed forms all minima that are found between samples [m]
    std::optional<std::size_t> standing;  // the nearest one; none: none is as near as was asked
    Vec3 where = Vec3::Zero();            // there, world [m]
};

/// True if the room of `moving` beside `standing` is found from the closed forms of both; else the clusters of both are
/// needed (scene::PartNeeds::clusters). Threads have none here.
bool inClosedForm(const scene::PartSpec& moving, const scene::PartSpec& standing);

/// The room that a part has among others: of shapes by their closed forms, else by triangles (which are of shapes
/// within 1 µm of the true surface, or as near as 200 000 of them get). Of triangles nothing tells inside from outside:
/// who goes from a pose without overlap on ways that are free stays outside.
class FreeRoom {
public:
    /// `closed_form`: inClosedForm() of all pairs. @pre else all parts have clusters; `moving` outlives this.
    FreeRoom(const scene::Part& moving, std::vector<RestingPart> standing, bool closed_form);
    ~FreeRoom();

    /// No point of the moving part is farther from its origin [m].
    double reach() const { return reach_; }
    const std::vector<RestingPart>& standing() const { return standing_; }
    /// Around the moving part at these poses and all that stands, world.
    geometry::Bounds boundsWith(const Pose& a, const Pose& b) const;

    /// Up to `within` [m].
    Nearness clearanceAt(const Pose& X, double within) const;

    /// True if it is proven that nothing meets from `a` to `b`, origin straight and turn even, and at no pose
    /// looked at they are nearer than `least` [m], > 0. From one of these to the next no point goes farther than the
    /// clearance lets it. False too where that takes more than kMostPoses.
    bool isFreeBetween(const Pose& a, const Pose& b, double least) const;
    static constexpr int kMostPoses = 6000;

    /// Pulls the part from `X` to `X_to`, as a hand pulls a god object: it slides along what it touches, and crosses
    /// nothing on the way (closed_form::PoseSolver, surface::SurfaceProxy). The poses that it went through, from `X`
    /// on; straight between them. Ends where it gets no farther.
    std::vector<Pose> slide(const Pose& X, const Pose& X_to) const;

    /// What finds contacts, of closed forms or of triangles.
    class Contacts;

private:
    std::vector<RestingPart> standing_;
    geometry::Bounds box_;  // of the moving part
    double reach_;
    double per_turn_;  // a turn counts as the way of a point so far from the origin [m]
    std::unique_ptr<Contacts> contacts_;
};

/// The pose at `share` of the way from `a` to `b`, origin straight and turn even.
Pose poseBetween(const Pose& a, const Pose& b, double share);

/// No point within `reach` of the origin goes farther from `a` to `b` [m].
double wayBetween(const Pose& a, const Pose& b, double reach);

}  // namespace passung::path
