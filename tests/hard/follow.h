#pragma once

#include <string>

#include "tests/hard/run.h"

namespace passung::hard {

/// What a proxy owes the device besides that it does not overlap; by dense geometry (dense_overlap.h). Every fourth
/// tick is looked at, and five looks in a row decide, that is 20 ms. With r the reach of the held part and c = r/200
/// (of an open sheet one cell more, the offset it is felt at):
///   touch  The device's pose overlaps by more than c: a force is sent; and at least once it overlaps and one is sent.
///   away   The proxy is r/1000 or more away from the device: it touches something, that is, has less room than c.
///   back   The same, the device's pose is free by c, and on the straight way to it the room grows from -tolerance on
///          at least in proportion: the proxy has gone there.
/// A virtual tool moves by its mass: of it only `touch` is asked. Ticks without a usable sample are left out. Returns
/// the first thing that does not hold; empty: all does.
std::string followFault(const Run& run);

}  // namespace passung::hard
