// Truth: closed form. A ball of 20 mm lies 1 mm deep in the top face of a block: the deepest point is 1 mm inside.

#include <cmath>
#include <cstdio>

#include "core/contact/contact_query.h"
#include "core/query/part_query.h"
#include "core/scene/part.h"

using namespace passung;

int main() {
    const double depth = 1e-3, spacing = 0.2e-3;
    scene::PartSpec block{.name = "block", .geometry = shape::Shape{shape::Box{0.06, 0.06, 0.02}}};
    scene::PartSpec ball{.name = "ball", .geometry = shape::Shape{shape::Sphere{0.02}}, .held = true};
    const auto field_part = scene::buildPart(block, {.field = true, .cell = 0.5e-3});
    const auto shell_part = scene::buildPart(ball, {.shell = true, .spacing = spacing});
    if (!field_part || !shell_part) {
        std::puts("a part could not be built");
        return 1;
    }

    const Pose X_WF, X_WS{.p = Vec3(0.003, -0.002, 0.01 + 0.01 - depth)};
    contact::QueryWorkspace workspace(shell_part->shell->nodes().size());
    contact::ContactManifold manifold(shell_part->shell->points().size());
    const contact::QueryAnswer answer =
        contact::queryContacts(*field_part->field, X_WF, *shell_part->shell, X_WS,
                               {.collect_below = 0.0, .search_below = 1.0}, workspace, manifold);

    // A shell point lies within one spacing of the lowest point of the ball: it is less than s²/2r higher.
    const double sampling = spacing * spacing / 0.02, tolerance = sampling + 10e-6;
    std::printf("%zu contacts, phi = %.1f um\n", manifold.size(), 1e6 * answer.phi);
    if (!(answer.found && std::abs(answer.phi + depth) < tolerance && manifold.size() > 0)) return 1;

    // The same as one call, with proven bounds.
    const query::PartQueryResult result = query::PartQuery(*field_part, *shell_part, {}).at(X_WF.inverse() * X_WS);
    std::printf("signed distance %.1f um, proven to %.1f um\n", 1e6 * result.signed_distance, 1e6 * result.error_bound);
    return std::abs(result.signed_distance + depth) <= result.error_bound && result.error_bound <= 30e-6 ? 0 : 1;
}
