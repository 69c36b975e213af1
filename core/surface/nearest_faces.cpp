#include "core/surface/nearest_faces.h"

#include <limits>
#include <utility>

namespace passung::surface {

namespace {

struct Search {
    const ClusterTree& held;
    const ClusterTree& obstacles;
    Placement X;
    NearestHulls best;
    FacePair pair;
    int left = std::numeric_limits<int>::max();  // pairs of faces to look at

    /// No points of the two balls are nearer [m].
    double bound(std::uint32_t a, std::uint32_t b) const noexcept {
        const Cluster &of_held = held[a], &of_obstacle = obstacles[b];
        return (X * of_held.centre - of_obstacle.centre).norm() - of_held.radius - of_obstacle.radius;
    }

    void look(std::uint32_t a, std::uint32_t b) noexcept {
        --left;
        const NearestHulls now = nearestPoints({held, obstacles, held[a], obstacles[b]}, X, Vec3::Zero());
        if (!(now.distance < best.distance)) return;
        best = now;
        pair = {a, b, true};
    }

    void visit(std::uint32_t a, std::uint32_t b) noexcept {
        if (left <= 0 || bound(a, b) >= best.distance) return;
        const Cluster &of_held = held[a], &of_obstacle = obstacles[b];
        if (of_held.isFace() && of_obstacle.isFace()) {
            look(a, b);
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
    FacePair pair;
    return nearestFaces(held, obstacles, X, within, std::numeric_limits<int>::max(), pair);
}

NearestHulls nearestFaces(const ClusterTree& held, const ClusterTree& obstacles, const Pose& X, double within,
                          int most_faces, FacePair& pair) noexcept {
    Search search{held, obstacles, Placement(X), {}, {}, most_faces};
    search.best.distance = within;
    if (pair.known) search.look(pair.held, pair.obstacle);
    search.visit(0, 0);
    pair = search.pair;
    return search.best;
}

}  // namespace passung::surface
