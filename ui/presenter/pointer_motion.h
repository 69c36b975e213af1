#pragma once

#include "core/base/types.h"
#include "ui/presenter/drawn_scene.h"

namespace passung::presenter {

/// How a drag is meant, by the button or key that goes with it.
enum class DragPlane {
    Upright,  // the plane across the direction of view: right and up
    Ground,   // the horizontal plane: right and away
    Turn,     // about the picture's axes
};

/// By how much the held part shall move and turn: world axes [m], rotation vector [rad].
struct PartMotion {
    Vec3 way = Vec3::Zero();
    Vec3 turn = Vec3::Zero();
};

/// A drag by (right, down) pixels in a picture so many pixels high: the part stays under the pointer.
PartMotion dragMotion(const Camera& camera, double height_px, DragPlane plane, double right_px, double down_px);

/// A wheel turned away from the person by so many notches: the part goes away, or (Turn) rolls clockwise.
PartMotion wheelMotion(const Camera& camera, DragPlane plane, double notches);

/// Keys that are held, each axis -1, 0 or 1: right, up, away; and turns about them. For so many seconds.
struct HeldKeys {
    Vec3 move = Vec3::Zero();
    Vec3 turn = Vec3::Zero();
    bool fine = false;  // a tenth of the speed
    bool any() const { return !move.isZero(0.0) || !turn.isZero(0.0); }
};
PartMotion keyMotion(const Camera& camera, const HeldKeys& keys, double seconds);

}  // namespace passung::presenter
