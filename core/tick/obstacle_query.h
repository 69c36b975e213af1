#pragma once

#include <span>

#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// queryContacts for the held part at `X_WS` against every obstacle of the scene, in two-way contact also for the
/// obstacles' points against the held part's field: what pokes between the held part's points is found by its own. All
/// contacts are told as the held part's: gradients away from the obstacle, normals out of the held part. The model's
/// mode and budget (per obstacle and way) replace those of `request`. Appends to `manifold`; returns the deepest or
/// closest answer, with nodes added up and the least quality. Each obstacle's own load is added to its push, if
/// `pushes` are given.
///   Obstacles that cannot have anything that is asked for are not looked at (lookReach); of the others what earlier
/// looks of `lookout` proved is made use of, if it is `known`. rt-safe.
contact::QueryAnswer queryObstacles(const HandModel& model, const ObstaclePoses& obstacles, const Pose& X_WS,
                                    contact::QueryRequest request, contact::QueryWorkspace& workspace,
                                    contact::ContactManifold& manifold, Lookout& lookout, bool known = false,
                                    FewOfMany<ObstaclePush>* pushes = nullptr) noexcept;

/// True if a point of the held part at `X_WS` lies in obstacle `i` at `X_WO` by more than `accepted` [m], or in two-way
/// contact one of the obstacle's in the held part. rt-safe.
bool overlapsObstacle(const HandModel& model, std::uint32_t i, const Pose& X_WO, const Pose& X_WS, double accepted,
                      QueryMemory& memory, Report& report) noexcept;

/// What a query took, in units of about 45 ns: nodes, points, and contacts twice. rt-safe.
std::uint32_t workOf(const contact::QueryAnswer& answer) noexcept;

/// Books a query's cost and completeness. rt-safe.
void account(const contact::QueryAnswer& answer, Report& report) noexcept;

}  // namespace passung::tick
