#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/export/table.h"
#include "core/base/tick_record.h"
#include "study/measures/cues.h"
#include "study/store/rows.h"

namespace passung::exporter {

/// Columns of every file in samples/: tick, t_s, the recorded channels, and the commands of the cues that follow from
/// them. Computing times are not among them.
std::vector<Column> sampleColumns();

/// `samples/<participant>_<session>_t<trial>_a<attempt>.csv.gz`
std::string samplesFile(const store::AttemptRow& attempt);

/// The recorded ticks as CSV, with the commands of `cues`; NA for cues that the condition does not have.
std::string samplesCsv(std::span<const TickRecord> records, const measures::CueSettings& cues);

}  // namespace passung::exporter
