#pragma once

#include <limits>

#include "core/model/part.h"
#include "core/tick/contact_query.h"

namespace passung::tick {

struct PartQueryRequest {
    double proximity = std::numeric_limits<double>::infinity();  // distances beyond are not searched [m], ≥ 0
    double area_stiffness = 1e9;                                 // κ of the wrench [N/m³]
    int max_nodes = 0;                                           // budget; 0 = none
    double quality = 0.0;                                        // floor in [0, 1]; wins over the budget
    bool two_way = false;                                        // each part's points against the other's field
    model::FieldMode mode = model::FieldMode::Trilinear;
};

/// Distance, depth and penalty wrench of two parts at one pose, with what is proven about them. FIELD's file frame.
struct PartQueryResult {
    double signed_distance = 0.0;    // [m], negative: depth of the deepest point
    double field_error_bound = 0.0;  // rigorous, of φ at the points that decided [m]
    double error_bound = 0.0;        // rigorous, of signed_distance between the two surfaces [m]
    double quality = 1.0;            // share of the shell's area pruned with proof or evaluated
    bool beyond_proximity = false;   // signed_distance is then only a lower bound; there is no closest point
    bool budget_reached = false;
    bool quality_overruled_budget = false;
    Vec3 closest = Vec3::Zero();  // on SHELL
    Vec3 normal = Vec3::Zero();   // unit, out of FIELD there
    Wrench wrench;                // area-weighted penalty on SHELL about the origin of SHELL's frame
    int contacts = 0;             // points with φ < 0
    int nodes_visited = 0;
    int points_tested = 0;
};

/// Queries `shell` against `field` again and again; memory is sized once. For libraries and the command line, not for
/// the tick. @pre field.field and shell.shell exist; for two-way queries all four.
class PartQuery {
public:
    PartQuery(const model::Part& field, const model::Part& shell, const PartQueryRequest& request);

    /// `X_FS`: pose of SHELL's file frame in FIELD's; finite.
    /// The bound: with e the field's error, c the shell's cover radius and h the chord errors of tessellated shapes,
    ///   min φ over the true surface of SHELL ∈ [min over points (φ - e) - c - h,  φ at the closest point + e + h],
    /// because φ is 1-Lipschitz; an open sheet's offset is added.
    PartQueryResult at(const Pose& X_FS);

private:
    PartQueryResult oneWay(const model::Part& field, const model::Part& shell, const Pose& X_FS);

    const model::Part& field_;
    const model::Part& shell_;
    PartQueryRequest request_;
    QueryWorkspace workspace_;
    ContactManifold manifold_;
};

}  // namespace passung::tick
