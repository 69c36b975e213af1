#include "core/surface/nearest_faces.h"

#include <utility>

namespace passung::surface {

namespace {

struct Search {
    const ClusterTree& held;
    const ClusterTree& obstacles;
    Placement X;
    NearestHulls best;

    /// No points of the two balls are nearer [m].
    double bound(std::uint32_t a, std::uint32_t b) const {
        const Cluster &of_held = held[a], &of_obstacle = obstacles[b];
        return (X * of_held.centre - of_obstacle.centre).norm() - of_held.radius - of_obstacle.radius;
    }

    void visit(std::uint32_t a, std::uint32_t b) {
        if (bound(a, b) >= best.distance) return;
        const Cluster &of_held = held[a], &of_obstacle = obstacles[b];
        if (of_held.isFace() && of_obstacle.isFace()) {
            const NearestHulls now = nearestPoints({held, obstacles, of_held, of_obstacle}, X, Vec3::Zero());
            if (now.distance < best.distance) best = now;
            return;
        }
        const bool part_held = of_obstacle.isFace() || (!of_held.isFace() && of_held.radius > of_obstacle.radius);
        std::pair first(part_held ? of_held.child : a, part_held ? b : of_obstacle.child);
        std::pair second(part_held ? of_held.child + 1 : a, part_held ? b : of_obstacle.child + 1);
        if (bound(second.first, second.second) < bound(first.first, first.second)) std::swap(first, second);
        visit(first.first, first.second);
        visit(second.first, second.second);
    }
};

}  // namespace

NearestHulls nearestFaces(const ClusterTree& held, const ClusterTree& obstacles, const Pose& X, double within) {
    Search search{held, obstacles, Placement(X), {}};
    search.best.distance = within;
    search.visit(0, 0);
    return search.best;
}

}  // namespace passung::surface
