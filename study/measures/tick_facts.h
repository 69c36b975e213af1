#pragma once

#include <optional>

#include "core/base/tick_record.h"

namespace passung::measures {

/// How far into the wall a peg may be and still count as in the bore [m]. An upright rigid peg stays within the
/// clearance; this covers what is no false insertion: the tip of a tilted peg (radius · tilt² / 2 + chamfer · tilt:
/// 0.1 mm for a 20 mm peg at 0.1 rad), the error of sampled fields and points, and the overlap that lets a stiff
/// penalty contact push back. A softer contact that lets the peg deeper in shows no bore there.
inline constexpr double kWallGive = 0.0002;

/// True if the displayed wrench is not zero or points of the held part are inside an obstacle:
/// |force| > 1e-6 N or |torque| > 1e-9 N·m or contacts > 0. The force alone would miss contact while a guard holds
/// the output at zero; the points alone would miss a proxy, which rests a hair above the surface. Where no wrench is
/// displayed (kWrenchWithheld) the points at the hand's pose stand in for it: hand_depth_m > 0. Where the held part's
/// weight is displayed (kWeighed), another effect that acts in the air (kAidedInAir), contacts > 0 alone tell: these
/// are forces in the air.
bool isContact(const TickRecord& record);

/// Depth of the proxy's origin (the peg's tip) below the bore's mouth [m], ≥ 0; empty if the tip is not in the bore:
/// above the mouth, or farther from the axis than `clearance` (radial, [m]) + kWallGive. `X_TW` maps the world to the
/// target's frame, whose bore runs along -z. Between chamfers a tip may be farther beside without touching; it counts
/// only once it is as near to the axis as the bore will ask.
std::optional<double> tipDepthInBore(const TickRecord& record, const Pose& X_TW, double clearance);

/// True if the held part at the proxy's pose is nowhere deeper than kWallGive in an obstacle.
bool isClearOfWalls(const TickRecord& record);

Pose handPose(const TickRecord& record);   // X_WH, as recorded
Pose proxyPose(const TickRecord& record);  // X_WG, as recorded

Vec3 handPosition(const TickRecord& record);   // [m], world
Vec3 proxyPosition(const TickRecord& record);  // [m], world

}  // namespace passung::measures
