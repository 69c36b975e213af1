#pragma once

#include <string>

#include "core/base/tick_record.h"

namespace passung::exporter {

/// What a bit of a tick's status says; nullptr for numbers that are no bit of it.
const char* statusBitMeaning(TickStatus bit);

/// All bits as the codebook explains them: "sum of: 1 = ...; 2 = ...".
std::string statusBitsText();

}  // namespace passung::exporter
