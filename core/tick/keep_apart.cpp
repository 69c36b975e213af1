#include "core/tick/keep_apart.h"

namespace passung::tick {

void keepApart(const HandModel& model, const HandSample& hand, const ObstaclePoses& obstacles, NearPairs& near,
               KeepApartShare& added) noexcept {
    added.of_keep_apart = Wrench{};
    if (!hand.input_usable) return;
    const scene::KeepApart& apart = model.effects.keep_apart;
    std::size_t count = 0;
    for (const ObstaclePoses::Carried& carried : obstacles.inHands()) {
        if (carried.rests || count == near.other.size()) continue;
        NearPairs::Other& other = near.other[count++];
        const std::size_t body = model.obstacles[carried.obstacle].body;
        if (other.body != body) other = {.body = body};
        const Pose& X_WO = obstacles.X_WO[carried.obstacle];
        const surface::NearestHulls nearest =
            surface::nearestFaces(*model.bodies[model.body].clusters, *model.bodies[body].clusters,
                                  X_WO.inverse() * hand.X_WH, apart.range, kMostFacePairs, other.faces);
        if (!(nearest.distance < apart.range)) continue;
        if (!nearest.meets) other.n = X_WO.q * nearest.n;
        const Vec3 force = apart.stiffness * (apart.range - nearest.distance) * other.n;
        added.of_keep_apart.force += force;
        added.of_keep_apart.torque += (hand.X_WH.q * nearest.on_held).cross(force);
    }
}

}  // namespace passung::tick
