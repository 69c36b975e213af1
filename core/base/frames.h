#pragma once

/// Frames, the one place where they are defined. Quantity first, frames after:
/// `X_WD` is the pose of D in W, `p_WP` the position of point P in W, `v_WP_W` its velocity expressed in W,
/// `F_P_W` a wrench at P expressed in W. All frames are right-handed; SI units (m, s, N, N·m, rad, kg).
///
/// | letter | frame |
/// | --- | --- |
/// | W | world of the scene; z is up in the shipped scenes |
/// | B | base of the haptic device, as its driver reports it |
/// | D | the device's handle |
/// | H | the held part where the device asks it to be (handle pose through registration and navigation) |
/// | G | the held part's proxy (god object) |
/// | F | a part that carries the distance field of a query (an obstacle) |
/// | S | a part that carries the point shell of a query (the held part) |
///
/// Signed distance φ is positive outside a part and negative inside, in metres; its gradient points out of the part.
/// The thesis's V is -φ, and its shell normals point inward; ours point outward.
namespace passung {}
