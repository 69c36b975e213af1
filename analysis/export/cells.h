#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/export/study_data.h"

namespace passung::exporter {

/// Attempts that count in means (countsInMeans()) of one participant in one block of a counted session, under one
/// condition.
struct Cell {
    std::string participant_id;
    std::string kind;
    std::string group;
    std::string protocol_sha256;
    std::int64_t session_ordinal = 1;
    std::int64_t block_index = 0;
    std::string block;
    const store::ConditionRow* condition = nullptr;
    std::vector<const store::AttemptRow*> attempts;
    /// [s] up to which times are compared: the shortest time-out of the block's conditions; where no plan tells any,
    /// the longest time of the block's attempts. Nothing: neither.
    std::optional<double> horizon_s;
};

/// A cell for each condition that a counted session plans in a main block, empty ones too; none for catch trials, for
/// those of staircases, or of whoever is excluded. By participant, protocol, session, block, then condition as the
/// protocol lists them. Refers to `study`.
std::vector<Cell> cellsOf(const StudyData& study);

/// Can a trial of this condition have the measure? By its trial type, by who times it, by its secondary task.
bool canHave(const store::ConditionRow& condition, const std::string& measure);

/// The values of `measure` of those attempts for which it is defined.
std::vector<double> valuesOf(const std::vector<const store::AttemptRow*>& attempts, const std::string& measure);

/// What stands for a measure in an analysis of cells: the restricted mean of time_s, the mean of all others; NaN for no
/// values.
double valueOf(const Cell& cell, const std::string& measure);

/// Is it the measure whose cells hold a restricted mean?
bool isCensored(const std::string& measure);

/// NaN for no values.
double meanOf(const std::vector<double>& values);
double medianOf(std::vector<double> values);

/// A time after which something was finished, or not yet.
struct CensoredTime {
    double time_s = 0.0;
    bool finished = false;
};

/// The mean time to finish as far as `horizon_s`: the area under the Kaplan-Meier curve from 0 to there,
///
///   S(t) = product over the times t_i <= t of (1 - finished_i / n_i),   n_i: how many are not over before t_i,
///
/// carried on level after the last time (Kaplan and Meier 1958; Irwin 1949 for the area). Limits: everything finished
/// before the horizon: the plain mean; nothing finished: the horizon; all others censored at the horizon: the mean of
/// min(time, horizon). NaN for no times.
double restrictedMean(std::vector<CensoredTime> times, double horizon_s);

}  // namespace passung::exporter
