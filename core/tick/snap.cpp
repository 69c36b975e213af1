#include "core/tick/snap.h"

namespace passung::tick {

void drawIntoPlace(const HandModel& model, const HandSample& hand, const Grip& grip, const ObstaclePoses& obstacles,
                   SnapShare& added) noexcept {
    added.of_snap = Wrench{};
    if (!hand.input_usable) return;
    const scene::Snap& snap = model.effects.snap;
    const double range_squared = snap.range * snap.range;
    const double turn_squared = model.contact.rotational_stiffness / model.contact.stiffness;
    for (const SnapPlace& place : model.snap_places) {
        const Pose X_WS = place.into == kNoObstacle ? place.X_IS : obstacles.X_WO[place.into] * place.X_IS;
        const Pose goal = scene::nearestGoal(hand.X_WH, X_WS, place.folds);
        const Vec3 p_GC = place.folds == 0 ? Vec3(0.0, 0.0, grip.p_GC.z()) : grip.p_GC;
        const Vec3 away = goal * p_GC - hand.X_WH * p_GC;
        const Vec3 turn = rotationVector(goal.q * hand.X_WH.q.conjugate());
        const double left = 1.0 - (away.squaredNorm() + turn_squared * turn.squaredNorm()) / range_squared;
        if (!(left > 0.0)) continue;
        const double stiffness = snap.stiffness * left * left;
        const Vec3 force = stiffness * away;
        added.of_snap.force += force;
        added.of_snap.torque += stiffness * turn_squared * turn + (hand.X_WH.q * p_GC).cross(force);
    }
}

}  // namespace passung::tick
