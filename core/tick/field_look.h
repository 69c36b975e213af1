#pragma once

#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// A look at all obstacles under a budget of nodes (ContactSpec::budget_nodes, of each obstacle and way), that takes as
/// many ticks as it needs: queryObstacles for a proxy, and the proof of free room where nothing is near.
///   Why: what part of a look tells of a pose is either too little, and the proxy would pass what was not looked at, or
/// too much, where spheres stand for that, and the proxy would be held where nothing is. So nothing is told before all
/// is known. What a tick cannot look at, the next ones look at, each where the last one stopped; the pose stays.
/// Limit cases: the budget is enough → a look without one. A budget of one node → one node a tick. Invariant: what a
/// look finds is the same at any budget, save the order of contacts.

/// Begins a look from `X_WG`: contacts within `reach`, and up to `search` how far the nearest is if none is [m].
/// rt-safe.
void beginLook(FieldLook& look, const Pose& X_WG, double reach, double search, geometry::NearList& near) noexcept;

/// Goes on with a look that is open, by a budget's worth; true: it has ended. rt-safe.
bool goOnLooking(const HandModel& model, const ObstaclePoses& obstacles, FieldLook& look, KnownPairs& known,
                 Report& report) noexcept;

}  // namespace passung::tick
