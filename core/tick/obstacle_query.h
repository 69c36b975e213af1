#pragma once

#include "core/tick/tick_model.h"

namespace passung::tick {

/// queryContacts for the held part at `X_WS` against every obstacle of the scene; the model's mode and budget (per
/// obstacle) replace those of `request`. Appends to `manifold`; returns the deepest or closest answer, with nodes added
/// up and the least quality. rt-safe.
QueryAnswer queryObstacles(const TickModel& model, const Pose& X_WS, QueryRequest request, QueryWorkspace& workspace,
                           ContactManifold& manifold) noexcept;

/// Books a query's cost and completeness in the frame. rt-safe.
void account(const QueryAnswer& answer, TickFrame& frame) noexcept;

}  // namespace passung::tick
