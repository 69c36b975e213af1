#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/base/tick_record.h"
#include "study/measures/measures.h"
#include "study/measures/period_clock.h"

namespace passung::measures {

/// A detection-response task beside the trial's own: a stimulus every few seconds, a button is to be pressed.
struct DetectionSettings {
    double least_interval = 3.0, most_interval = 5.0;  // [s] between onsets, 0 < least ≤ most
    double duration = 1.0;                             // [s] that a stimulus lasts without response, > 0
    double earliest = 0.1, latest = 2.5;               // [s] after the onset: a response counts, earliest < latest
    int button = 1;                                    // of the device, from 1
};

/// Times at which stimuli begin: the first one interval after tick 0 of an attempt, intervals uniform between the two
/// bounds, each a whole number of ticks. They follow from the attempt's seed alone, so that whoever knows it (device,
/// session, replay) has the same ones. rt-safe.
class StimulusTimes {
public:
    StimulusTimes(const DetectionSettings& settings, std::uint64_t attempt_seed) noexcept;
    /// Tick at which the next stimulus begins.
    std::int64_t next() const noexcept { return next_; }
    void advance() noexcept;

private:
    double least_, most_;  // [ticks]
    Random random_;
    std::int64_t next_ = 0;
};

/// Follows the records of an attempt, all of them from tick 0, and notes stimuli and presses. Times are haptic periods
/// after tick 0. A press is a tick with the button down after one with it up; the first of a stimulus that comes from
/// `earliest` to `latest` after its onset is the response to it, every other press a false alarm. The command of the
/// stimulus is 1 from its onset to the response, at most `duration`.
class DetectionTask {
public:
    DetectionTask(const DetectionSettings& settings, std::uint64_t attempt_seed);

    void follow(const TickRecord& record);

    /// Tells whether a stimulus is on, as of the newest record.
    bool isOn() const { return current_ && !all_[*current_].off; }

    /// What has come of the task, by time, for a trial from `start` to `end`; without `start` it never began. A
    /// stimulus of the trial counts if it was answered before the end or could have been; what else there was is
    /// NotScored.
    std::vector<Detection> detections(std::optional<std::int64_t> start, std::int64_t end) const;

private:
    DetectionSettings settings_;
    StimulusTimes times_;
    PeriodClock clock_;
    bool known_ = false;  // a record before
    bool down_ = false;   // the button, in it
    std::vector<Detection> all_;
    std::optional<std::size_t> current_;  // the newest stimulus
};

/// Measures of the task, in column order: part of definitions().
const std::vector<MeasureDefinition>& detectionDefinitions();

/// Their values, in this order; all empty for a trial without the task (nullptr).
std::vector<Value> detectionValues(const std::vector<Detection>* detections);

}  // namespace passung::measures
