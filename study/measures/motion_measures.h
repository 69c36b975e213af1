#pragma once

#include "study/measures/trial.h"

namespace passung::measures {

// Of the hand's motion through the low-pass of smooth_motion.h; empty without ticks.

Optional pathLength(const Trial& trial);         // [m], sum over the hands
Optional straightPathRatio(const Trial& trial);  // way over the distance from its beginning to its end
Optional rotationPath(const Trial& trial);       // [rad], sum over the hands
Optional work(const Trial& trial);               // [J], sum over the hands
/// Mean over the hands that move.
Optional spectralArcLength(const Trial& trial);
/// -ln(T^3 / peak speed^2 x the integral of the squared jerk) (Hogan and Sternad 2009, J Motor Behavior 41): -5.32 of
/// the smoothest reach, -ln 204.8, less of any other. Mean over the hands; empty where the jerk of one of them may be
/// the sensor's: the integral is less than 20 times what white noise of the variance that the filter took away would
/// leave in it (jerkOfNoise()).
Optional logDimensionlessJerk(const Trial& trial);

}  // namespace passung::measures
