#pragma once

#include "study/store/read/store_reader.h"

namespace passung::cli {

/// Prints how even the orders of those are who have a slot, for each version of the protocol and kind of
/// participant; that several versions count their places apart is said too.
void printTakenPlaces(const store::StoreReader& reader);

}  // namespace passung::cli
