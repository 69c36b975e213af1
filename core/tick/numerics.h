#pragma once

namespace passung::tick {

/// Which arithmetic the tick follows. Every recording carries the number, and only recordings of this number can be
/// computed again to the bit: a replay of another one says "not comparable". Recordings without it count as 0.
///   Raise it by one with every change after which any output bit of any tick may be another one: the tick itself, and
/// what is built for it (fields, shells, edges, defaults of a scene). numerics_test.cpp finds such changes.
inline constexpr int kNumerics = 12;

}  // namespace passung::tick
