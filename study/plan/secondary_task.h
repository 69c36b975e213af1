#pragma once

#include <array>
#include <cstddef>

namespace passung::plan {

enum class Stimulus { None, Visual, Vibrotactile, Audio };
inline constexpr std::array kStimulusNames = {"none", "visual", "vibrotactile", "audio"};  // as stored
inline const char* stimulusName(Stimulus stimulus) { return kStimulusNames[static_cast<std::size_t>(stimulus)]; }

/// A detection-response task beside the trial's own, like that of ISO 17488: a stimulus every few seconds, to be
/// answered with a button. measures::DetectionSettings says when a press counts.
struct SecondaryTask {
    Stimulus stimulus = Stimulus::None;
    double least_interval = 3.0, most_interval = 5.0;  // [s] between onsets
    double duration = 1.0;                             // [s] that a stimulus lasts without response
    double earliest = 0.1, latest = 2.5;               // [s] after the onset: a response counts
    int button = 1;                                    // of the device, from 1
    bool any() const { return stimulus != Stimulus::None; }
};

/// Source of a trial's begin and end: the program, which feels and sees the held part; the experimenter, for real
/// parts in the hand; or the clock alone, for trials in which nothing is to be handled.
enum class TimedBy { Program, Experimenter, Clock };
inline constexpr std::array kTimedByNames = {"program", "experimenter", "clock"};  // as stored
inline const char* timedByName(TimedBy timed_by) { return kTimedByNames[static_cast<std::size_t>(timed_by)]; }

}  // namespace passung::plan
