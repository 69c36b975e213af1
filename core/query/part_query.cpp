#include "core/query/part_query.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/contact/contact_query.h"
#include "core/contact/depth_sum.h"
#include "core/field/distance_field.h"
#include "core/query/surface_search.h"

namespace passung::query {

namespace {

constexpr double kClosedFormRounding = 1e-12;  // rounding of a closed form, per metre of its point

std::size_t nodesOf(const scene::Part& part) { return part.shell ? part.shell->nodes().size() : 0; }
std::size_t pointsOf(const scene::Part& part) { return part.shell ? part.shell->points().size() : 0; }

/// How far the triangles of a part may lie from the surface that was given [m]: chords of a shape; a mesh file is read
/// in single precision.
double surfaceError(const scene::Part& part) {
    if (part.shape) return part.chord_error;
    const geometry::Bounds bounds = geometry::boundsOf(part.mesh);
    return 0x1p-24 * bounds.low.cwiseAbs().cwiseMax(bounds.high.cwiseAbs()).norm();
}

/// Sets the error bound from the interval and the distance reported.
void boundError(PartQueryResult& result) {
    const double above = result.beyond_proximity ? 0.0 : result.upper_bound - result.signed_distance;
    result.error_bound = std::max({0.0, above, result.signed_distance - result.lower_bound});
}

/// What the field is wrong by at most at the point found [m]: of a shape the truth there is known, and the field's own
/// bound, one for many cells, is far above it at rims and in corners.
double fieldErrorAtClosest(const scene::Part& field, const contact::QueryAnswer& answer, field::FieldMode mode) {
    if (!field.shape) return field.field->errorBound(answer.closest_F, mode);
    const double truth = shape::signedDistance(*field.shape, answer.closest_F);
    return std::abs(answer.phi + field.field->sheetOffset() - truth) +
           kClosedFormRounding * (1.0 + answer.closest_F.norm());
}

/// Sets the bound of the field at the shell's points: `least` is no more than the smallest true φ there.
void boundField(const scene::Part& field, const contact::QueryAnswer& answer, field::FieldMode mode, double least,
                PartQueryResult& result) {
    result.field_error_bound = answer.phi - least;
    if (answer.found)
        result.field_error_bound = std::max(result.field_error_bound, fieldErrorAtClosest(field, answer, mode));
}

/// The interval that one direction proves, from what the traversal found; see PartQuery. `meshes`: what the meshes may
/// be off.
void proveInterval(const scene::Part& field, const scene::Part& shell, const contact::QueryAnswer& answer,
                   field::FieldMode mode, double meshes, PartQueryResult& result) {
    const double chords = meshes + shell.shell->rounding();
    const double offset = field.field->sheetOffset();
    // Branches were pruned where nothing lies below answer.phi, which another mode may have read below the points' own
    // lower bounds.
    const double least = std::min(answer.lower_bound, answer.phi);
    result.lower_bound = least + offset - shell.shell->coverRadius() - chords;
    result.upper_bound = std::numeric_limits<double>::infinity();
    if (answer.found) {
        result.upper_bound = answer.phi + fieldErrorAtClosest(field, answer, mode) + offset + chords;
    }
    boundField(field, answer, mode, least, result);
    boundError(result);
}

/// Narrows the interval by the exact geometry; see PartQuery.
void refine(const scene::Part& shell, SurfaceSearch& search, const Pose& X_FS, double tolerance, int most_steps,
            double chords, PartQueryResult& result) {
    // What the chords take of the tolerance is lost, but not all of it can be won back by searching on.
    const double left = std::max(tolerance - chords, 0.1 * tolerance);
    const SurfaceBounds found =
        search.bounds(X_FS, X_FS.inverse() * result.closest, shell.shell->rounding(), left, most_steps);
    result.nodes_visited += found.steps;
    result.signed_distance = found.upper;
    result.closest = found.point;
    if (found.normal.squaredNorm() > 0.5) result.normal = found.normal;
    result.lower_bound = std::max(result.lower_bound, found.lower - chords);
    result.upper_bound = std::min(result.upper_bound, found.upper + chords);
    boundError(result);
}

/// Merges the interval of the way back into `result`, whose distance is already the smaller of both; see PartQuery.
void mergeInterval(const PartQueryResult& back, PartQueryResult& result) {
    const bool apart = result.lower_bound + back.lower_bound > 0.0;
    result.upper_bound = std::min(result.upper_bound, back.upper_bound);
    result.lower_bound =
        apart ? std::max(result.lower_bound, back.lower_bound) : std::min(result.lower_bound, back.lower_bound);
    if (apart && !result.beyond_proximity) {
        result.signed_distance = std::clamp(result.signed_distance, result.lower_bound, result.upper_bound);
    }
    result.field_error_bound = std::max(result.field_error_bound, back.field_error_bound);
    boundError(result);
}

}  // namespace

/// Parts, request and memory.
struct PartQuery::Search {
    Search(const scene::Part& field, const scene::Part& shell, const PartQueryRequest& request);
    PartQueryResult at(const Pose& X_FS);

private:
    PartQueryResult oneWay(const scene::Part& field, const scene::Part& shell, std::optional<SurfaceSearch>& search,
                           const Pose& X_FS);

    const scene::Part& field_;
    const scene::Part& shell_;
    PartQueryRequest request_;
    double surface_error_;  // of both meshes [m]
    contact::QueryWorkspace workspace_;
    contact::ContactManifold manifold_;
    contact::ClusterFinder clusters_;
    std::optional<SurfaceSearch> search_, search_back_;  // SHELL's surface against FIELD's, and the other way round
};

PartQuery::Search::Search(const scene::Part& field, const scene::Part& shell, const PartQueryRequest& request)
    : field_(field),
      shell_(shell),
      request_(request),
      surface_error_(surfaceError(field) + surfaceError(shell)),
      workspace_(std::max(nodesOf(field), nodesOf(shell))),
      manifold_(std::max(nodesOf(field) + pointsOf(field), nodesOf(shell) + pointsOf(shell))),
      clusters_(request.patches ? pointsOf(shell) + nodesOf(shell) : 0) {
    if (!std::isfinite(request.tolerance)) return;
    if (field.field->boundProven()) search_.emplace(field, shell);
    if (request.two_way && shell.field->boundProven()) search_back_.emplace(shell, field);
}

PartQueryResult PartQuery::Search::oneWay(const scene::Part& field, const scene::Part& shell,
                                          std::optional<SurfaceSearch>& search, const Pose& X_FS) {
    const double chords = surface_error_ + shell.shell->rounding();
    // What the triangles prove is more than the points could, so that those need not prove anything before.
    const bool decided = search && request_.max_nodes == 0 && std::isinf(request_.proximity);
    contact::QueryRequest request{.search_below = request_.proximity,
                                  .max_nodes = request_.max_nodes,
                                  .quality = request_.quality,
                                  .mode = request_.mode,
                                  .prove = !decided,
                                  .gradients = false};
    manifold_.clear();
    contact::QueryAnswer answer =
        queryContacts(*field.field, Pose{}, *shell.shell, X_FS, request, workspace_, manifold_);
    PartQueryResult result;
    result.quality_overruled_budget =
        request_.quality > 0.0 && request_.max_nodes > 0 && answer.nodes_visited > request_.max_nodes;
    result.signed_distance = answer.phi;
    result.quality = answer.quality;
    result.budget_reached = answer.budget_reached;
    result.beyond_proximity = !answer.found;
    result.nodes_visited = answer.nodes_visited;
    result.points_tested = answer.points_tested;
    if (answer.found) {
        result.closest = answer.closest_F;
        result.normal = answer.normal_W;
    }
    if (decided) answer.lower_bound = -std::numeric_limits<double>::infinity();
    proveInterval(field, shell, answer, request_.mode, surface_error_, result);
    const bool free = request_.max_nodes == 0 || result.quality_overruled_budget;
    const int steps = free ? kMostRefinements : std::min(kMostRefinements, request_.max_nodes - result.nodes_visited);
    if (search && answer.found && steps >= SurfaceSearch::kLeastSteps && result.error_bound > request_.tolerance)
        refine(shell, *search, X_FS, request_.tolerance, steps, surface_error_, result);
    if (decided) {
        // No point lies farther than the chords from the surface.
        double least = result.lower_bound - field.field->sheetOffset() - chords;
        if (result.error_bound > request_.tolerance) {  // the steps ended
            request.prove = true;
            request.collect_below = -std::numeric_limits<double>::infinity();
            const contact::QueryAnswer proof =
                queryContacts(*field.field, Pose{}, *shell.shell, X_FS, request, workspace_, manifold_);
            least = std::max(least, std::min(proof.lower_bound, proof.phi));
            result.lower_bound =
                std::max(result.lower_bound, least + field.field->sheetOffset() - shell.shell->coverRadius() - chords);
            boundError(result);
        }
        boundField(field, answer, request_.mode, least, result);
    }
    result.budget_reached = result.budget_reached || (!free && result.nodes_visited >= request_.max_nodes);

    const Wrench load = contact::sumDepths(manifold_, true, X_FS.p, [](const auto&...) {}).sum;
    result.wrench = {request_.area_stiffness * load.force, request_.area_stiffness * load.torque};
    result.contacts = static_cast<int>(
        std::count_if(manifold_.begin(), manifold_.end(), [](const contact::ContactPoint& c) { return c.phi < 0.0; }));
    return result;
}

PartQueryResult PartQuery::Search::at(const Pose& X_FS) {
    PartQueryResult result = oneWay(field_, shell_, search_, X_FS);
    if (request_.patches) {
        const auto patches = clusters_.find(manifold_, 2.0 * shell_.shell->coverRadius());
        result.patches.assign(patches.begin(), patches.end());
        result.patches_found = clusters_.found();
    }
    if (!request_.two_way) return result;
    const Pose X_SF = X_FS.inverse();
    const PartQueryResult back = oneWay(shell_, field_, search_back_, X_SF);
    // `back` is the wrench on FIELD about FIELD's origin in SHELL's axes: turn, move to SHELL's origin, change the
    // sign.
    const Vec3 force = -(X_FS.q * back.wrench.force);
    const Vec3 torque = -(X_FS.q * back.wrench.torque) + (-X_FS.p).cross(force);
    result.wrench = {0.5 * (result.wrench.force + force), 0.5 * (result.wrench.torque + torque)};
    result.contacts += back.contacts;
    result.nodes_visited += back.nodes_visited;
    result.points_tested += back.points_tested;
    result.quality = std::min(result.quality, back.quality);
    result.budget_reached = result.budget_reached || back.budget_reached;
    result.quality_overruled_budget = result.quality_overruled_budget || back.quality_overruled_budget;
    if (!back.beyond_proximity && (result.beyond_proximity || back.signed_distance < result.signed_distance)) {
        result.signed_distance = back.signed_distance;
        result.beyond_proximity = false;
        // The closest point of FIELD, carried to SHELL's surface along SHELL's own normal there.
        const Vec3 out_of_shell = X_FS.q * back.normal;
        result.closest = X_FS * back.closest - back.signed_distance * out_of_shell;
        result.normal = -out_of_shell;
    }
    mergeInterval(back, result);
    return result;
}

PartQuery::PartQuery(const scene::Part& field, const scene::Part& shell, const PartQueryRequest& request)
    : search_(std::make_unique<Search>(field, shell, request)) {}

PartQuery::~PartQuery() = default;

PartQueryResult PartQuery::at(const Pose& X_FS) { return search_->at(X_FS); }

}  // namespace passung::query
