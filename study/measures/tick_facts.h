#pragma once

#include <optional>

#include "core/base/tick_record.h"

namespace passung::measures {

/// How far beside the bore's axis the held part's origin may be and still count as in the bore's neighbourhood [m].
/// A pose criterion, no statement about material: inside a bore the origin cannot be farther off than the clearance,
/// and a soft penalty contact may press it a little into the wall.
inline constexpr double kBoreNeighbourhood = 0.002;

/// True if the displayed wrench is not zero or points of the held part are inside an obstacle:
/// |force| > 1e-6 N or |torque| > 1e-9 N·m or contacts > 0. The force alone would miss contact while a guard holds
/// the output at zero; the points alone would miss a proxy, which rests a hair above the surface.
bool isContact(const TickRecord& record);

/// Depth of the proxy's origin (the peg's tip) below the bore's mouth [m], negative above it; `X_TW` maps the world to
/// the target's frame, whose bore runs along -z. Empty if the origin is not within `kBoreNeighbourhood` of the axis.
std::optional<double> tipDepthInBore(const TickRecord& record, const Pose& X_TW);

Vec3 handPosition(const TickRecord& record);   // [m], world
Vec3 proxyPosition(const TickRecord& record);  // [m], world

}  // namespace passung::measures
