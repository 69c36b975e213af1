#include "core/tick/snap.h"

namespace passung::tick {

void drawIntoPlace(const HandModel& model, const HandSample& hand, const ObstaclePoses& obstacles,
                   SnapShare& added) noexcept {
    added.of_snap = Wrench{};
    if (!hand.input_usable) return;
    const scene::Snap& snap = model.effects.snap;
    const double radius_squared = model.metric_radius * model.metric_radius;
    for (const SnapPlace& place : model.snap_places) {
        const Pose X_WS = place.into == kNoObstacle ? place.X_IS : obstacles.X_WO[place.into] * place.X_IS;
        const Pose goal = scene::nearestGoal(hand.X_WH, X_WS, place.folds);
        const Vec3 away = goal.p - hand.X_WH.p;
        const Vec3 turn = rotationVector(goal.q * hand.X_WH.q.conjugate());
        const double distance_squared = away.squaredNorm() + radius_squared * turn.squaredNorm();
        const double left = 1.0 - distance_squared / (snap.range * snap.range);
        if (!(left > 0.0)) continue;
        const double stiffness = snap.stiffness * left * left;
        added.of_snap.force += stiffness * away;
        added.of_snap.torque += stiffness * radius_squared * turn;
    }
}

}  // namespace passung::tick
