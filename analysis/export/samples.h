#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"
#include "core/base/tick_record.h"
#include "study/measures/cues.h"
#include "study/store/rows/rows.h"
#include "study/store/samples/sample_codec.h"

namespace passung::exporter {

/// Columns of every file in samples/: tick, t_s, the recorded channels, and the commands of the cues that follow from
/// them; last those of `extras`, only in files of attempts whose scene calls for them. Computing times are not among
/// them.
std::vector<Column> sampleColumns(std::span<const store::Extra> extras);

/// `samples/<participant>_<session>_t<trial>_a<attempt>.csv.gz`; of another hand than the first, `hand` from 0, with
/// `_` and its name before the dot.
std::string samplesFile(const store::AttemptRow& attempt, std::size_t hand);

/// What was commanded beside the force while an attempt's ticks were recorded.
struct SampleSignals {
    measures::CueSettings cues;
    bool secondary = false;                                      // there is a secondary task
    std::vector<std::pair<std::int64_t, std::int64_t>> stimuli;  // of it: on, off [periods after tick 0], by time
};
SampleSignals sampleSignals(const StudyData& study, const store::AttemptRow& attempt);

/// The recorded ticks as CSV, with these commands; NA for what the condition does not have.
std::string samplesCsv(std::span<const TickRecord> records, const SampleSignals& commanded);

}  // namespace passung::exporter
