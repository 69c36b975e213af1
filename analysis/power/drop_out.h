#pragma once

#include <cstdint>

#include "analysis/export/study_data.h"

namespace passung::power {

/// Each person leaves for good with probability `share`, before any of their trials alike: what they would have done
/// from there on is not in the data. Who leaves, and when, follows from the code and `seed`, of that virtual study.
/// @pre a person's attempts are in order
void dropOut(double share, std::uint64_t seed, exporter::StudyData& study);

}  // namespace passung::power
