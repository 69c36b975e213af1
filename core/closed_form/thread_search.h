#pragma once

#include "core/closed_form/thread_samples.h"
#include "core/closed_form/touch_search.h"

namespace passung::closed_form {

/// As searchEdge(), along a spiral, or along any edge that meets a lump with a thread's flank. `samples` of `piece`.
/// Amid a ridge the function jumps. So where `reach` is below 0 a bound above it says that the function is above
/// `reach` as long as no point goes farther than the bound less `reach`, and nothing of lower reaches.
double searchAlongThread(const Curve& edge, const LinePiece& piece, const ThreadSamples& samples, const Lump& lump,
                         double reach, Touches& touches) noexcept;

bool hasFlank(const Lump& lump) noexcept;

}  // namespace passung::closed_form
