#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/export/table.h"
#include "core/base/tick_record.h"
#include "study/store/rows.h"

namespace passung::exporter {

/// Columns of every file in samples/: tick, t_s and the recorded channels. Computing times are not among them.
std::vector<Column> sampleColumns();

/// `samples/<participant>_<session>_t<trial>_a<attempt>.csv.gz`
std::string samplesFile(const store::AttemptRow& attempt);

/// The recorded ticks as CSV.
std::string samplesCsv(std::span<const TickRecord> records);

}  // namespace passung::exporter
