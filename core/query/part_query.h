#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "core/base/types.h"
#include "core/contact/contact_clusters.h"
#include "core/field/field_mode.h"
#include "core/scene/part.h"

namespace passung::query {

/// Steps of one refinement at most, 1 µs each: seldom more than a thousand are needed.
inline constexpr int kMostRefinements = 50000;

struct PartQueryRequest {
    double proximity = std::numeric_limits<double>::infinity();  // distances beyond are not searched [m], ≥ 0
    double area_stiffness = 1e9;                                 // κ of the wrench [N/m³]
    int max_nodes = 0;                                           // budget; 0 = none
    double quality = 0.0;                                        // floor in [0, 1]; wins over the budget
    double tolerance = 20e-6;  // the closest pair is refined until error_bound ≤ this [m]; infinite: not at all
    bool two_way = false;      // each part's points against the other's field
    bool patches = false;      // also list the patches of contact
    field::FieldMode mode = field::FieldMode::Trilinear;
};

/// Distance, depth and penalty wrench of two parts at one pose, with what is proven about them. FIELD's file frame.
/// "The truth" is m_1, or min(m_1, m_2) if two-way; see PartQuery.
struct PartQueryResult {
    double signed_distance = 0.0;  // of the closest or deepest point found [m]; negative: its depth
    double lower_bound = 0.0;      // the truth is in [lower_bound, upper_bound], proven [m]
    double upper_bound = 0.0;      // [m]; infinite beyond the proximity
    double error_bound = 0.0;      // proven: |signed_distance - truth| ≤ this; beyond the proximity, see there [m]
    double field_error_bound = 0.0;  // proven: |smallest φ read - smallest true φ| ≤ this over the shell's points, and
                                     // |φ read - true φ| ≤ this at the point of the shell where refinement begins;
                                     // two-way: both ways [m]
    double quality = 1.0;           // share of the shell's area pruned with proof or evaluated
    bool beyond_proximity = false;  // no point is nearer than the proximity, which is then `signed_distance`: the
                                    // truth is ≥ signed_distance - error_bound, and there is no closest point
    bool budget_reached = false;
    bool quality_overruled_budget = false;
    Vec3 closest = Vec3::Zero();  // on SHELL
    Vec3 normal = Vec3::Zero();   // unit, out of FIELD there
    Wrench wrench;                // area-weighted penalty on SHELL about the origin of SHELL's frame
    int contacts = 0;             // points with φ < 0
    int nodes_visited = 0;
    int points_tested = 0;
    // If asked for: of SHELL's points inside FIELD (also if two-way), the deepest first; see contact::ClusterFinder.
    std::vector<contact::ContactCluster> patches;
    std::size_t patches_found = 0;  // more than are listed if more than contact::ClusterFinder::kMostClusters
};

/// Queries `shell` against `field` again and again; memory is sized once. For libraries and the command line, not for
/// the tick. @pre field.field and shell.shell exist; for two-way queries all four.
///
/// What is sought. ∂A, ∂B: the true surfaces of FIELD and SHELL; φ_A, φ_B: their true signed distances (for an open
/// sheet the distance from it, never negative). One way seeks m_1 = min φ_A over ∂B, the other way m_2 = min φ_B over
/// ∂A. Apart, m_1 = m_2 = the distance of the surfaces. Where they meet, -m_1 is how deep B's surface reaches into A
/// and -m_2 how deep A's reaches into B, two different depths. A within B: m_1 > 0 > m_2.
///
/// What one way proves. φ_k: read from the field at point k of the shell, which is wrong by at most e_k (of a shape:
/// exactly by |φ_k - φ_A|, its closed form asked at the best point); l_k ≤ φ_A: the
/// field's lower bound there (of many points at once where a branch is pruned); c: cover radius of the shell; h: sum of
/// both parts' chord errors and of the rounding of the shell's points to floats; s: offset of an open sheet, whose
/// field holds φ_A - s.
///   A point of ∂B lies within h of the mesh, thus within c + h of some point k, and φ_A is 1-Lipschitz:
///     m_1 ≥ min(l_k) + s - c - h.
///   Every point k lies within h of ∂B, thus with any k, and with the one of the smallest φ_k best:
///     m_1 ≤ φ_k + e_k + s + h.
///   (The field of a shape is sampled from its closed form; h of FIELD enters because far away the field bounds φ_A by
///   the box of its mesh.)
///
/// Refinement. From the shell's best point on, both meshes' triangles decide (surface_search.h): that proves an
/// interval of its own for the meshes, wider by their chord errors for the surfaces, and the two intervals'
/// intersection holds. (Without a budget and a proximity it alone proves: the traversal does so only if the steps end.)
/// It ends at the tolerance, at the budget (what the traversal left of it) or after
/// kMostRefinements steps, and is left out where the field has holes, beyond the proximity, and where the budget is
/// spent.
///
/// What two ways prove. min(m_1, m_2) lies in [min(lo_1, lo_2), min(hi_1, hi_2)]; and in the smaller
/// [max(lo_1, lo_2), min(hi_1, hi_2)] if lo_1 + lo_2 > 0, because then m_1 = m_2:
///   Say lo_1 > 0 is the larger. ∂B lies outside A, m_1 = distance of ∂A and ∂B ≥ lo_1. If any point of ∂A were inside
///   B, it would be at least that deep: m_2 ≤ -m_1 ≤ -lo_1 < lo_2, a contradiction. So all of ∂A is outside B, and m_2
///   is the distance too.
/// `signed_distance` is the smallest φ_k of both ways, in the second case moved into the interval.
class PartQuery {
public:
    /// Both parts outlive this.
    PartQuery(const scene::Part& field, const scene::Part& shell, const PartQueryRequest& request);
    ~PartQuery();

    /// `X_FS`: pose of SHELL's file frame in FIELD's; finite.
    PartQueryResult at(const Pose& X_FS);

private:
    struct Search;
    std::unique_ptr<Search> search_;
};

}  // namespace passung::query
