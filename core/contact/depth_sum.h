#pragma once

#include <algorithm>

#include "core/contact/contact_query.h"

namespace passung::contact {

/// Contacts' depths along the shell's inward normals, as forces and moments about a point.
struct DepthSum {
    Wrench sum;                          // Σ w_i n_i [m] or [m³], Σ r_i × w_i n_i
    double depths = 0.0, deepest = 0.0;  // of single contacts [m]
};

/// Sums over what is inside, p_i = -φ_i > 0, r_i from `p_WO`, with w_i = p_i, or a_i p_i if `weighted` by area; `each`
/// is handed every contact with its two terms. rt-safe if `each` is.
template <class Each>
DepthSum sumDepths(const ContactManifold& manifold, bool weighted, const Vec3& p_WO, Each each) noexcept {
    DepthSum all;
    for (const ContactPoint& c : manifold) {
        if (!(c.phi < 0.0)) continue;
        const double depth = -c.phi;
        const Vec3 f = (weighted ? c.area * depth : depth) * -c.normal;
        const Vec3 moment = (c.position - p_WO).cross(f);
        all.sum.force += f;
        all.sum.torque += moment;
        each(c, f, moment);
        all.depths += depth;
        all.deepest = std::max(all.deepest, depth);
    }
    return all;
}

}  // namespace passung::contact
